//! Viscous dashpot: `F = c d'`, `c` in N s/m. Energy per cycle of `d = X cos(omega t)`: `pi c omega X^2`.

use crate::effects::{Law, Motion, Parameter};
use faer::c64;
use std::f64::consts::PI;

/// Viscous dashpot.
#[derive(Debug)]
pub struct Viscous;

const PARAMETERS: [Parameter; 1] = [Parameter::coefficient("c", "N s/m", "c")];

impl Law for Viscous {
    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn dynamic_stiffness(&self, p: &[f64], omega: f64) -> Option<c64> {
        Some(c64::new(0.0, omega * p[0]))
    }

    fn force(&self, p: &[f64], motion: &Motion, force: &mut [f64]) {
        for (f, v) in force.iter_mut().zip(&motion.velocity) {
            *f = p[0] * v;
        }
    }

    fn tangent(&self, p: &[f64], _motion: &Motion, direction: &Motion, tangent: &mut [f64]) {
        self.force(p, direction, tangent);
    }

    fn parameter_tangent(&self, _p: &[f64], _k: usize, motion: &Motion, tangent: &mut [f64]) {
        tangent.copy_from_slice(&motion.velocity);
    }

    fn energy_per_cycle(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64> {
        Some(PI * p[0] * omega * amplitude * amplitude)
    }
}
