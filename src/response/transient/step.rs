//! One exact step of the linear part: forces of elements constant, measured forces polynomials of time within it.
//!
//! ```text
//! z(h) = e^(lambda h) z_0 + h phi_1 beta f + sum_k h (h / T)^k k! phi_k+1 beta_u c_k,    u(t) = sum_k c_k (t / T)^k
//! ```
//!
//! States are flat: the real parts of all damped modes, behind them the imaginary parts. `T` is the time between samples.

use super::exponentials::phi;
use super::hold::{ORDERS, Polynomial};
use super::system::LinearSystem;
use dashpot_numerics::{add_product, dot, turn, turn_rows};
use faer::c64;

/// Factors of one length of step.
#[derive(Debug, Clone)]
pub(super) struct Step {
    /// Length, s.
    pub length: f64,
    /// Time between samples, s.
    pub sample: f64,
    decay: Vec<f64>,
    /// `h (h / T)^k k! phi_k+1` of every mode, one list a power of time.
    pub powers: [Vec<c64>; ORDERS],
    /// The same times `beta` of every input, flat, powers of an input one behind the other.
    pushes: Vec<f64>,
}

impl Step {
    /// Of `length` s, where samples are `sample` s apart.
    pub(super) fn new(system: &LinearSystem, length: f64, sample: f64) -> Self {
        let count = system.lambda.len();
        let mut decay = vec![0.0; 2 * count];
        let mut powers: [Vec<c64>; ORDERS] = std::array::from_fn(|_| Vec::with_capacity(count));
        for (k, lambda) in system.lambda.iter().enumerate() {
            let phi = phi(lambda * length);
            (decay[k], decay[count + k]) = (phi[0].re, phi[0].im);
            let mut factor = length;
            for (power, list) in powers.iter_mut().enumerate() {
                list.push(phi[power + 1] * factor);
                factor *= (power + 1) as f64 * length / sample;
            }
        }
        let mut pushes = Vec::with_capacity(2 * count * ORDERS * system.beta.len());
        for beta in &system.beta {
            for list in &powers {
                pushes.extend(list.iter().zip(beta).map(|(f, b)| (f * b).re));
                pushes.extend(list.iter().zip(beta).map(|(f, b)| (f * b).im));
            }
        }
        Self { length, sample, decay, powers, pushes }
    }

    /// One that is no step, to stand in for another.
    pub(super) fn empty() -> Self {
        Self { length: 0.0, sample: 0.0, decay: Vec::new(), powers: Default::default(), pushes: Vec::new() }
    }

    /// Its length over the time between samples.
    pub(super) fn share(&self) -> f64 {
        self.length / self.sample
    }

    /// What a unit force at an input does that grows with a power of time.
    fn of(&self, input: usize, power: usize) -> &[f64] {
        let width = self.decay.len();
        let at = (input * ORDERS + power) * width;
        &self.pushes[at..at + width]
    }

    /// `z <- e^(lambda h) z`.
    pub(super) fn decay(&self, z: &mut [f64]) {
        turn(&self.decay, z);
    }

    /// The same of many states, a row of each entry, `stride` long.
    pub(super) fn decay_rows(&self, rows: &mut [f64], stride: usize) {
        turn_rows(&self.decay, rows, stride);
    }

    /// What a constant unit force at an input does to a state.
    pub(super) fn unit(&self, input: usize) -> &[f64] {
        self.of(input, 0)
    }

    /// Adds what a constant `force` does at an input.
    pub(super) fn push(&self, input: usize, force: f64, z: &mut [f64]) {
        if force != 0.0 {
            z.iter_mut().zip(self.of(input, 0)).for_each(|(z, p)| *z += p * force);
        }
    }

    /// Adds what a drive does.
    pub(super) fn drive(&self, input: usize, force: &Polynomial, z: &mut [f64]) {
        let width = self.decay.len();
        let at = input * ORDERS * width;
        add_product(&self.pushes[at..at + ORDERS * width], force, z);
    }

    /// What a force at an input that rises about zero, to 1 at the end, has done there, along a functional.
    pub(super) fn ramp(&self, input: usize, functional: &[f64]) -> f64 {
        2.0 * dot(functional, self.of(input, 1)) / self.share() - self.receptance(input, functional)
    }

    /// What a constant unit force at an input has done at the end, along a functional.
    pub(super) fn receptance(&self, input: usize, functional: &[f64]) -> f64 {
        dot(functional, self.of(input, 0))
    }
}
