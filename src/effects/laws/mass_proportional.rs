//! Mass-proportional viscous damping: `F = alpha M x'`.

use crate::effects::law::Basis;
use crate::effects::{Parameter, WholeLaw};
use faer::c64;

/// Viscous damping in proportion to the mass matrix.
#[derive(Debug)]
pub struct MassProportional;

const PARAMETER: Parameter = Parameter::coefficient("alpha", "1/s", "alpha");

impl WholeLaw for MassProportional {
    fn parameter(&self) -> &'static Parameter {
        &PARAMETER
    }

    fn basis(&self) -> Basis {
        Basis::Mass
    }

    fn factor(&self, value: f64, omega: f64) -> c64 {
        c64::new(0.0, omega * value)
    }
}
