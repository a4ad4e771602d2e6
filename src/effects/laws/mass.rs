//! Under construction.
use super::viscous::Viscous;
use crate::effects::{Law, Motion, Parameter};

/// Mass.
#[derive(Debug)]
pub struct Mass;

impl Law for Mass {
    fn parameters(&self) -> &'static [Parameter] {
        Viscous.parameters()
    }
    fn force(&self, p: &[f64], motion: &Motion, force: &mut [f64]) {
        Viscous.force(p, motion, force);
    }
    fn tangent(&self, p: &[f64], motion: &Motion, direction: &Motion, tangent: &mut [f64]) {
        Viscous.tangent(p, motion, direction, tangent);
    }
    fn parameter_tangent(&self, p: &[f64], k: usize, motion: &Motion, tangent: &mut [f64]) {
        Viscous.parameter_tangent(p, k, motion, tangent);
    }
    fn energy_per_cycle(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64> {
        Viscous.energy_per_cycle(p, amplitude, omega)
    }
}
