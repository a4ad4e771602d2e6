//! Loss factor of the material: `F_h = i loss_factor K X_h` at each harmonic; no force at rest.

use crate::effects::law::Basis;
use crate::effects::{Parameter, WholeLaw};
use faer::c64;

/// Complex stiffness of the whole structure.
#[derive(Debug)]
pub struct LossFactor;

const PARAMETER: Parameter = Parameter::coefficient("loss_factor", "", "eta");

impl WholeLaw for LossFactor {
    fn parameter(&self) -> &'static Parameter {
        &PARAMETER
    }

    fn basis(&self) -> Basis {
        Basis::Stiffness
    }

    fn factor(&self, value: f64, omega: f64) -> c64 {
        c64::new(0.0, if omega > 0.0 { value } else { 0.0 })
    }
}
