//! Hysteretic (structural) damping: `F_h = i loss_stiffness D_h` at each harmonic, in quadrature with the displacement.
//! Energy per cycle of `d = X cos(omega t)`: `pi loss_stiffness X^2`, whatever the frequency.

use crate::effects::{Law, Motion, Parameter};
use faer::c64;
use std::f64::consts::PI;

/// Hysteretic damper.
#[derive(Debug)]
pub struct Hysteretic;

const PARAMETERS: [Parameter; 1] = [Parameter::coefficient("loss_stiffness", "N/m", "h")];

/// Dynamic stiffness, N/m: none at rest.
fn stiffness(p: &[f64], omega: f64) -> c64 {
    c64::new(0.0, if omega > 0.0 { p[0] } else { 0.0 })
}

/// Derivative of the dynamic stiffness by the only parameter.
fn by_parameter(_p: &[f64], _k: usize, omega: f64) -> c64 {
    stiffness(&[1.0], omega)
}

impl Law for Hysteretic {
    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn dynamic_stiffness(&self, p: &[f64], omega: f64) -> Option<c64> {
        Some(stiffness(p, omega))
    }

    fn force(&self, p: &[f64], motion: &Motion, force: &mut [f64]) {
        motion.apply_linear(|w| stiffness(p, w), force);
    }

    fn tangent(&self, p: &[f64], _motion: &Motion, direction: &Motion, tangent: &mut [f64]) {
        self.force(p, direction, tangent);
    }

    fn parameter_tangent(&self, p: &[f64], k: usize, motion: &Motion, tangent: &mut [f64]) {
        motion.apply_linear(|w| by_parameter(p, k, w), tangent);
    }

    fn energy_per_cycle(&self, p: &[f64], amplitude: f64, _omega: f64) -> Option<f64> {
        Some(PI * p[0] * amplitude * amplitude)
    }

    fn energy(&self, p: &[f64], motion: &Motion) -> f64 {
        motion.linear_energy(|w| stiffness(p, w))
    }
}
