//! Asymmetric Coulomb friction: `F = offset + force sgn(d')`: `offset + force` while the displacement grows,
//! `offset - force` while it falls, any force between them at rest. The offset does no work over a period; energy per
//! cycle of `d = X cos(omega t)`: `4 force X`; of any periodic motion: `force` times the way travelled.

use super::coulomb::Coulomb;
use crate::effects::description::{Description, Exponents};
use crate::effects::effect::Effect;
use crate::effects::law::{Point, Variable};
use crate::effects::limits::{CLOSE, Limit};
use crate::effects::memoryless::{MemorylessLaw, sign};
use crate::effects::motion::Motion;
use crate::effects::parameter::Parameter;
use crate::effects::set_valued::SetValued;
use crate::effects::symbol::{Mark, Tone};

/// Friction of different size to either side.
#[derive(Debug)]
pub(crate) struct AsymmetricCoulomb;

const DESCRIPTION: Description = Description {
    scaled: &[0, 1],
    odd: false,
    shapes: |_| [-0.9, -0.6, -0.3, 0.3, 0.6, 0.9].map(|offset| vec![1.0, offset]).to_vec(),
    exponents: |_| Exponents::damping(-1.0, -1.0),
    limits: &[Limit { law: Effect::Coulomb, holds: |p, _| p[1].abs() < CLOSE * p[0], parameters: |p| vec![p[0]] }],
    symbol: &[
        Mark::Pads(-0.5, 0.5, Tone::Full),
        Mark::Line(&[(-0.35, 13.0), (0.3, 13.0)]),
        Mark::Line(&[(0.16, 10.5), (0.3, 13.0), (0.16, 15.5)]),
    ],
    example: &[0.4, 0.2],
    ..Description::new(
        "asymmetric Coulomb friction",
        "F_0 + F_c sgn(d')",
        "Dry friction that resists one direction more than the other: lip seals, worm drives, inclined guides.",
        &[Parameter::coefficient("force", "N", "F_c"), Parameter::shape("offset", "N", "F_0", 0.0).of_any_sign()],
    )
};

impl MemorylessLaw for AsymmetricCoulomb {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn variable(&self) -> Variable {
        Variable::Velocity
    }

    fn at(&self, p: &[f64], _d: f64, v: f64) -> Point {
        Point { force: p[1] + p[0] * sign(v), ..Point::default() }
    }

    fn by_parameter(&self, _p: &[f64], k: usize, _d: f64, v: f64) -> f64 {
        if k == 0 { sign(v) } else { 1.0 }
    }

    // The offset does no work over a cycle.
    fn cycle_energy(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64> {
        Coulomb.cycle_energy(&p[..1], amplitude, omega)
    }

    fn exact_energy(&self, p: &[f64], motion: &Motion) -> Option<f64> {
        Coulomb.exact_energy(&p[..1], motion)
    }

    fn set_valued(&self) -> Option<&dyn SetValued> {
        Some(self)
    }
}

impl SetValued for AsymmetricCoulomb {
    fn bounds(&self, p: &[f64]) -> [f64; 2] {
        let bound = p[0].max(0.0);
        [p[1] - bound, p[1] + bound]
    }

    fn bounds_by(&self, _p: &[f64], k: usize) -> [f64; 2] {
        if k == 0 { [-1.0, 1.0] } else { [1.0, 1.0] }
    }
}
