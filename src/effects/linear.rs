//! Laws that are linear in the motion, harmonic by harmonic: `F_h = Z(h omega) D_h`. Written as their dynamic stiffness,
//! lifted to samples of a period here. Energy per cycle of `d = X cos(omega t)`: `pi Im Z(omega) X^2`.

use super::description::Description;
use super::law::{Law, Manner};
use super::memory::Memory;
use super::motion::Motion;
use faer::c64;
use std::f64::consts::PI;

/// A dynamic stiffness.
pub trait LinearLaw: Sync {
    /// As [`Law::description`].
    fn description(&self) -> &'static Description;

    /// Dynamic stiffness, N/m, at circular frequency `omega` (rad/s); real at 0.
    fn stiffness(&self, p: &[f64], omega: f64) -> c64;

    /// Its derivative by parameter `k`.
    fn stiffness_by(&self, p: &[f64], k: usize, omega: f64) -> c64;

    /// As [`Law::memory`].
    fn memory(&self, p: &[f64]) -> Option<Box<dyn Memory>> {
        let _ = p;
        None
    }
}

/// A linear law as a [`Law`].
#[derive(Debug)]
pub(crate) struct Linear<T>(pub T);

impl<T: LinearLaw> Law for Linear<T> {
    fn description(&self) -> &'static Description {
        self.0.description()
    }

    fn manner(&self, _p: &[f64]) -> Manner {
        Manner::Linear
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn dynamic_stiffness(&self, p: &[f64], omega: f64) -> Option<c64> {
        Some(self.0.stiffness(p, omega))
    }

    fn dynamic_stiffness_by(&self, p: &[f64], k: usize, omega: f64) -> Option<c64> {
        Some(self.0.stiffness_by(p, k, omega))
    }

    fn force(&self, p: &[f64], motion: &Motion, force: &mut [f64]) {
        motion.apply_linear(|w| self.0.stiffness(p, w), force);
    }

    fn tangent(&self, p: &[f64], _motion: &Motion, direction: &Motion, tangent: &mut [f64]) {
        self.force(p, direction, tangent);
    }

    fn parameter_tangent(&self, p: &[f64], k: usize, motion: &Motion, tangent: &mut [f64]) {
        motion.apply_linear(|w| self.0.stiffness_by(p, k, w), tangent);
    }

    fn memory(&self, p: &[f64]) -> Option<Box<dyn Memory>> {
        self.0.memory(p)
    }

    fn energy_per_cycle(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64> {
        Some(PI * self.0.stiffness(p, omega).im * amplitude * amplitude)
    }

    fn energy(&self, p: &[f64], motion: &Motion) -> f64 {
        if self.description().dissipates { motion.linear_energy(|w| self.0.stiffness(p, w)) } else { 0.0 }
    }
}
