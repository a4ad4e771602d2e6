//! Quadratic spring: `F = stiffness d^2`, an asymmetry. It takes out no energy.

use crate::effects::description::Description;
use crate::effects::law::{Point, Variable};
use crate::effects::memoryless::MemorylessLaw;
use crate::effects::parameter::Parameter;
use crate::effects::symbol::Mark;

/// Asymmetric spring.
#[derive(Debug)]
pub(crate) struct QuadraticStiffness;

const DESCRIPTION: Description = Description {
    odd: false,
    folds: true,
    dissipates: false,
    symbol: &[Mark::spring(-0.5, 0.5, 5), Mark::Line(&[(-0.4, 9.0), (0.4, 9.0)])],
    example: &[1e4],
    ..Description::new(
        "quadratic spring",
        "k_2 d^2",
        "A spring that is stiffer in one direction than in the other.",
        &[Parameter::coefficient("stiffness", "N/m^2", "k_2").of_any_sign()],
    )
};

impl MemorylessLaw for QuadraticStiffness {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn variable(&self) -> Variable {
        Variable::Displacement
    }

    fn at(&self, p: &[f64], d: f64, _v: f64) -> Point {
        Point { force: p[0] * d * d, by_displacement: 2.0 * p[0] * d, by_velocity: 0.0 }
    }

    fn by_parameter(&self, _p: &[f64], _k: usize, d: f64, _v: f64) -> f64 {
        d * d
    }
}
