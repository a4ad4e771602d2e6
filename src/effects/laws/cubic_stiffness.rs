//! Cubic spring: `F = stiffness d^3`, hardening if positive. It takes out no energy.

use crate::effects::description::{Description, Exponents};
use crate::effects::law::{Point, Variable};
use crate::effects::memoryless::MemorylessLaw;
use crate::effects::parameter::Parameter;
use crate::effects::symbol::Mark;

/// Symmetric hardening or softening spring.
#[derive(Debug)]
pub(crate) struct CubicStiffness;

const DESCRIPTION: Description = Description {
    folds: true,
    dissipates: false,
    exponents: |_| Exponents::stiffness(2.0, 0.0),
    symbol: &[Mark::spring(-0.5, 0.5, 5), Mark::Arrow],
    example: &[3e5],
    ..Description::new(
        "cubic spring",
        "k_3 d^3",
        "A spring that stiffens, or softens if negative, alike in both directions.",
        &[Parameter::coefficient("stiffness", "N/m^3", "k_3").of_any_sign()],
    )
};

impl MemorylessLaw for CubicStiffness {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn variable(&self) -> Variable {
        Variable::Displacement
    }

    fn at(&self, p: &[f64], d: f64, _v: f64) -> Point {
        Point { force: p[0] * d * d * d, by_displacement: 3.0 * p[0] * d * d, by_velocity: 0.0 }
    }

    fn by_parameter(&self, _p: &[f64], _k: usize, d: f64, _v: f64) -> f64 {
        d * d * d
    }
}
