//! Under construction.
use super::viscous::Viscous;
use crate::effects::{Law, Parameter, WholeLaw, law::Basis};
use faer::c64;

/// MassProportional.
#[derive(Debug)]
pub struct MassProportional;

impl WholeLaw for MassProportional {
    fn parameter(&self) -> &'static Parameter {
        &Viscous.parameters()[0]
    }
    fn basis(&self) -> Basis {
        Basis::Mass
    }
    fn factor(&self, value: f64, omega: f64) -> c64 {
        c64::new(0.0, omega * value)
    }
}
