//! Fractional derivative (viscoelastic) damping: `F_h = c (i w)^order D_h` at `w = h omega`, 0 < order < 1.
//! Energy per cycle of `d = X cos(omega t)`: `pi c omega^order X^2 sin(order pi / 2)`.

use crate::effects::law::Ends;
use crate::effects::{Law, Motion, Parameter};
use faer::c64;
use std::f64::consts::{FRAC_PI_2, PI};

/// Element between a spring (order 0) and a dashpot (order 1).
#[derive(Debug)]
pub struct Fractional;

const PARAMETERS: [Parameter; 2] = [
    Parameter::coefficient("c", "N s^a/m", "c_a"),
    Parameter::shape("order", "", "a", 0.5).within(0.0, 1.0, Ends::Open),
];

/// Dynamic stiffness, N/m: none at rest.
fn stiffness(p: &[f64], omega: f64) -> c64 {
    if omega <= 0.0 {
        return c64::new(0.0, 0.0);
    }
    let (sin, cos) = (p[1] * FRAC_PI_2).sin_cos();
    let magnitude = p[0] * omega.powf(p[1]);
    c64::new(magnitude * cos, magnitude * sin)
}

/// Derivative of the dynamic stiffness: by the order, the stiffness times `ln(i w)`.
fn by_parameter(p: &[f64], k: usize, omega: f64) -> c64 {
    if k == 0 {
        stiffness(&[1.0, p[1]], omega)
    } else if omega > 0.0 {
        stiffness(p, omega) * c64::new(omega.ln(), FRAC_PI_2)
    } else {
        c64::new(0.0, 0.0)
    }
}

impl Law for Fractional {
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

    fn energy_per_cycle(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64> {
        Some(PI * p[0] * omega.powf(p[1]) * amplitude * amplitude * (p[1] * FRAC_PI_2).sin())
    }

    fn energy(&self, p: &[f64], motion: &Motion) -> f64 {
        motion.linear_energy(|w| stiffness(p, w))
    }
}
