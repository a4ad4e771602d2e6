//! Asymmetric dashpot: `F = c_pull d'` while the displacement grows, `F = c_push d'` while it falls. Energy per cycle of
//! `d = X cos(omega t)`: `pi omega X^2 (c_pull + c_push) / 2`; mean force: `(c_pull - c_push) omega X / pi`.

use crate::effects::description::{Description, Exponents};
use crate::effects::effect::Effect;
use crate::effects::law::{Point, Variable};
use crate::effects::limits::{CLOSE, Limit};
use crate::effects::memoryless::MemorylessLaw;
use crate::effects::parameter::Parameter;
use crate::effects::symbol::Mark;
use std::f64::consts::FRAC_PI_2;

/// Dashpot that resists pull and push differently.
#[derive(Debug)]
pub(crate) struct AsymmetricViscous;

const DESCRIPTION: Description = Description {
    scaled: &[0, 1],
    odd: false,
    shapes: |_| [0.05, 0.2, 0.5, 2.0, 5.0, 20.0].map(|push| vec![1.0, push]).to_vec(),
    exponents: |_| Exponents::damping(0.0, 0.0),
    limits: &[Limit {
        law: Effect::Viscous,
        // Of a force of the mean of both the difference is half of theirs.
        holds: |p, _| (p[0] - p[1]).abs() < CLOSE * (p[0] + p[1]),
        parameters: |p| vec![0.5 * (p[0] + p[1])],
    }],
    symbol: &[
        Mark::Dashpot(-0.5, 0.5),
        Mark::Line(&[(-0.35, 10.0), (0.3, 10.0)]),
        Mark::Line(&[(0.16, 7.5), (0.3, 10.0), (0.16, 12.5)]),
    ],
    example: &[7.0, 2.0],
    ..Description::new(
        "asymmetric dashpot",
        "c+ d' or c- d'",
        "A damper with a valve for each direction: shock absorbers, screws, squeezed films.",
        &[Parameter::shape("c_pull", "N s/m", "c+", 1.0), Parameter::shape("c_push", "N s/m", "c-", 1.0)],
    )
};

impl MemorylessLaw for AsymmetricViscous {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn variable(&self) -> Variable {
        Variable::Velocity
    }

    fn at(&self, p: &[f64], _d: f64, v: f64) -> Point {
        let c = if v >= 0.0 { p[0] } else { p[1] };
        Point { force: c * v, by_displacement: 0.0, by_velocity: c }
    }

    fn by_parameter(&self, _p: &[f64], k: usize, _d: f64, v: f64) -> f64 {
        if (k == 0) == (v >= 0.0) { v } else { 0.0 }
    }

    fn cycle_energy(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64> {
        Some(FRAC_PI_2 * omega * amplitude * amplitude * (p[0] + p[1]))
    }
}
