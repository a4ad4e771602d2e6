//! One exact step of the linear part: forces of elements constant, measured forces linear within it.
//!
//! ```text
//! z(h) = e^(lambda h) z_0 + h phi_1 (beta f + beta_u u_0) + h phi_2 beta_u (u_1 - u_0)
//! ```
//!
//! States are flat: the real parts of all damped modes, behind them the imaginary parts.

use super::exponentials::integrals;
use super::system::LinearSystem;
use dashpot_numerics::{dot, turn};
use faer::c64;

/// Factors of one length of step.
#[derive(Debug, Clone)]
pub(super) struct Step {
    /// Length, s.
    pub length: f64,
    decay: Vec<f64>,
    /// `h phi_1`.
    pub constant: Vec<c64>,
    /// `h phi_2`: of a force that rises to 1.
    pub rising: Vec<c64>,
    /// `h phi_1 beta` and `h phi_2 beta` of every input, flat, one behind the other.
    constants: Vec<f64>,
    rises: Vec<f64>,
}

impl Step {
    /// Of `length` s.
    pub(super) fn new(system: &LinearSystem, length: f64) -> Self {
        let count = system.lambda.len();
        let (mut decay, mut constant, mut rising) = (vec![0.0; 2 * count], Vec::new(), Vec::new());
        for (k, lambda) in system.lambda.iter().enumerate() {
            let [e, phi1, phi2] = integrals(lambda * length);
            (decay[k], decay[count + k]) = (e.re, e.im);
            constant.push(phi1 * length);
            rising.push(phi2 * length);
        }
        let along = |factors: &[c64]| {
            let mut all = Vec::with_capacity(2 * count * system.beta.len());
            for beta in &system.beta {
                all.extend(factors.iter().zip(beta).map(|(f, b)| (f * b).re));
                all.extend(factors.iter().zip(beta).map(|(f, b)| (f * b).im));
            }
            all
        };
        let (constants, rises) = (along(&constant), along(&rising));
        Self { length, decay, constant, rising, constants, rises }
    }

    /// One that is no step, to stand in for another.
    pub(super) fn empty() -> Self {
        let none = Vec::new;
        Self { length: 0.0, decay: none(), constant: Vec::new(), rising: Vec::new(), constants: none(), rises: none() }
    }

    fn of<'a>(&self, list: &'a [f64], input: usize) -> &'a [f64] {
        let width = self.decay.len();
        &list[input * width..(input + 1) * width]
    }

    /// `z <- e^(lambda h) z` of one state or of many.
    pub(super) fn decay(&self, z: &mut [f64]) {
        turn(&self.decay, z);
    }

    /// Adds what a constant `force` does at an input.
    pub(super) fn push(&self, input: usize, force: f64, z: &mut [f64]) {
        if force != 0.0 {
            z.iter_mut().zip(self.of(&self.constants, input)).for_each(|(z, p)| *z += p * force);
        }
    }

    /// Adds what a drive does that goes from `start` to `end`.
    pub(super) fn drive(&self, input: usize, start: f64, end: f64, z: &mut [f64]) {
        let rise = end - start;
        let both = self.of(&self.constants, input).iter().zip(self.of(&self.rises, input));
        z.iter_mut().zip(both).for_each(|(z, (c, r))| *z += c * start + r * rise);
    }

    /// What a constant unit force at an input has done at the end, along a functional.
    pub(super) fn receptance(&self, input: usize, functional: &[f64]) -> f64 {
        dot(functional, self.of(&self.constants, input))
    }
}
