//! Coulomb friction: `F = force sgn(d')`, 0 at rest. Energy per cycle of `d = X cos(omega t)`: `4 force X`; of any
//! periodic motion: `force` times the way travelled.
//!
//! The force is set-valued at rest: solvers take any force within `+-force` there, exactly ([`SetValued`]).

use crate::effects::description::{Description, Exponents};
use crate::effects::law::{Point, Variable};
use crate::effects::memoryless::{MemorylessLaw, sign};
use crate::effects::motion::Motion;
use crate::effects::parameter::Parameter;
use crate::effects::set_valued::SetValued;
use crate::effects::symbol::{Mark, Tone};
use crate::effects::turning::total_variation;

/// Coulomb friction.
#[derive(Debug)]
pub(crate) struct Coulomb;

const DESCRIPTION: Description = Description {
    exponents: |_| Exponents::damping(-1.0, -1.0),
    symbol: &[Mark::Pads(-0.5, 0.5, Tone::Full)],
    example: &[0.4],
    usual: true,
    ..Description::new(
        "Coulomb friction",
        "F_c sgn(d')",
        "A constant force against the motion: dry friction between sliding surfaces.",
        &[Parameter::coefficient("force", "N", "F_c")],
    )
};

impl MemorylessLaw for Coulomb {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn variable(&self) -> Variable {
        Variable::Velocity
    }

    fn at(&self, p: &[f64], _d: f64, v: f64) -> Point {
        Point { force: p[0] * sign(v), ..Point::default() }
    }

    fn by_parameter(&self, _p: &[f64], _k: usize, _d: f64, v: f64) -> f64 {
        sign(v)
    }

    fn cycle_energy(&self, p: &[f64], amplitude: f64, _omega: f64) -> Option<f64> {
        Some(4.0 * p[0] * amplitude)
    }

    fn exact_energy(&self, p: &[f64], motion: &Motion) -> Option<f64> {
        Some(p[0] * total_variation(motion))
    }

    fn set_valued(&self) -> Option<&dyn SetValued> {
        Some(self)
    }
}

impl SetValued for Coulomb {
    fn bounds(&self, p: &[f64]) -> [f64; 2] {
        let bound = p[0].max(0.0);
        [-bound, bound]
    }

    fn bounds_by(&self, _p: &[f64], _k: usize) -> [f64; 2] {
        [-1.0, 1.0]
    }
}
