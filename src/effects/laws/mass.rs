//! Mass: `F = mass d''`. It stores energy and takes out none. Negative: the model is too heavy there.

use crate::effects::{Law, Motion, Parameter};
use faer::c64;

/// Lumped mass, missing or too much.
#[derive(Debug)]
pub struct Mass;

const PARAMETERS: [Parameter; 1] = [Parameter::coefficient("mass", "kg", "m").of_any_sign()];

impl Law for Mass {
    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn dynamic_stiffness(&self, p: &[f64], omega: f64) -> Option<c64> {
        Some(c64::new(-omega * omega * p[0], 0.0))
    }

    fn force(&self, p: &[f64], motion: &Motion, force: &mut [f64]) {
        for (f, a) in force.iter_mut().zip(&motion.acceleration) {
            *f = p[0] * a;
        }
    }

    fn tangent(&self, p: &[f64], _motion: &Motion, direction: &Motion, tangent: &mut [f64]) {
        self.force(p, direction, tangent);
    }

    fn parameter_tangent(&self, _p: &[f64], _k: usize, motion: &Motion, tangent: &mut [f64]) {
        tangent.copy_from_slice(&motion.acceleration);
    }

    fn energy_per_cycle(&self, _p: &[f64], _amplitude: f64, _omega: f64) -> Option<f64> {
        Some(0.0)
    }

    fn dissipates(&self) -> bool {
        false
    }

    fn energy(&self, _p: &[f64], _motion: &Motion) -> f64 {
        0.0
    }
}
