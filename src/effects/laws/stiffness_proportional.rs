//! Stiffness-proportional viscous damping: `F = beta K x'`.

use crate::effects::law::Basis;
use crate::effects::{Parameter, WholeLaw};
use faer::c64;

/// Viscous damping in proportion to the stiffness matrix.
#[derive(Debug)]
pub struct StiffnessProportional;

const PARAMETER: Parameter = Parameter::coefficient("beta", "s", "beta");

impl WholeLaw for StiffnessProportional {
    fn parameter(&self) -> &'static Parameter {
        &PARAMETER
    }

    fn basis(&self) -> Basis {
        Basis::Stiffness
    }

    fn factor(&self, value: f64, omega: f64) -> c64 {
        c64::new(0.0, omega * value)
    }
}
