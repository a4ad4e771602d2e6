//! Maxwell element, a spring in series with a dashpot: `F_h = k i w c / (k + i w c) D_h` at `w = h omega`.
//! Energy per cycle of `d = X cos(omega t)`: `pi X^2 k^2 omega c / (k^2 + (omega c)^2)`.

use crate::effects::memory::MaxwellMemory;
use crate::effects::{Law, Memory, Motion, Parameter};
use faer::c64;
use std::f64::consts::PI;

/// Spring in series with a dashpot.
#[derive(Debug)]
pub struct Maxwell;

const PARAMETERS: [Parameter; 2] =
    [Parameter::shape("stiffness", "N/m", "k", 1e4), Parameter::shape("c", "N s/m", "c", 1.0)];

/// Dynamic stiffness, N/m; none if either part is missing.
fn stiffness(p: &[f64], omega: f64) -> c64 {
    let dashpot = c64::new(0.0, omega * p[1]);
    let sum = p[0] + dashpot;
    if sum.norm() == 0.0 { c64::new(0.0, 0.0) } else { p[0] * dashpot / sum }
}

/// Derivative of the dynamic stiffness: by `k` `(i w c / (k + i w c))^2`, by `c` `i w (k / (k + i w c))^2`.
fn by_parameter(p: &[f64], k: usize, omega: f64) -> c64 {
    let dashpot = c64::new(0.0, omega * p[1]);
    let sum = p[0] + dashpot;
    if sum.norm() == 0.0 {
        return c64::new(0.0, 0.0);
    }
    if k == 0 {
        let share = dashpot / sum;
        share * share
    } else {
        let share = p[0] / sum;
        c64::new(0.0, omega) * share * share
    }
}

impl Law for Maxwell {
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

    fn memory(&self, p: &[f64]) -> Option<Box<dyn Memory>> {
        Some(Box::new(MaxwellMemory::new(p[0], p[1])))
    }

    fn energy_per_cycle(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64> {
        Some(PI * stiffness(p, omega).im * amplitude * amplitude)
    }

    fn energy(&self, p: &[f64], motion: &Motion) -> f64 {
        motion.linear_energy(|w| stiffness(p, w))
    }
}
