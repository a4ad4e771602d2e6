//! Exact motion of the linear rest over one time step under forces that are constant in it.
//!
//! ```text
//! M x'' + C x' + K x = f - sum_l L_l F_l,     y = [s x; x'],     y_1 = exp(A h) y_0 + sum_i b_i p_i
//! ```
//!
//! `b_i = integral exp(A t) dt [0; M^-1 l_i]` for a unit force of pattern `l_i`. The propagator is exact for every
//! natural frequency, however stiff, and dissipates as the structure does: with the mean force of a step working along
//! the displacement of that step, the energy balance holds to rounding. `s` (rad/s) brings displacement and velocity to
//! one unit.

use dashpot_numerics::{Cholesky, product};
use faer::Mat;

/// The propagator of one step.
#[derive(Debug, Clone)]
pub(crate) struct Propagator {
    /// Degrees of freedom.
    pub size: usize,
    /// Scale `s` of displacements in the state, rad/s.
    pub scale: f64,
    /// `exp(A h)`, 2n x 2n.
    transition: Mat<f64>,
    /// `b_i`, 2n x inputs.
    inputs: Mat<f64>,
    /// `[-M^-1 K, -M^-1 C, M^-1 l_i]`, n x (2n + inputs).
    rates: Mat<f64>,
}

impl Propagator {
    /// Of `mass`, `damping`, `stiffness` (n x n) and force patterns (n x inputs) for a step in s; `None` if the mass is
    /// not positive definite.
    pub(crate) fn new(
        mass: &Mat<f64>,
        damping: &Mat<f64>,
        stiffness: &Mat<f64>,
        patterns: &Mat<f64>,
        step: f64,
    ) -> Option<Self> {
        let (n, inputs) = (mass.nrows(), patterns.ncols());
        let llt = Cholesky::new(mass.as_ref())?;
        let (k, c, b) = (llt.solve(stiffness.as_ref()), llt.solve(damping.as_ref()), llt.solve(patterns.as_ref()));
        let scale = (0..n).fold(0.0_f64, |m, i| m.max(k[(i, i)].abs())).sqrt().max(1.0 / step);
        let size = 2 * n + inputs;
        let a = Mat::from_fn(size, size, |i, j| {
            let value = match (i < n, i < 2 * n) {
                (true, _) if j == i + n => scale,
                (false, true) if j < n => -k[(i - n, j)] / scale,
                (false, true) if j < 2 * n => -c[(i - n, j - n)],
                (false, true) => b[(i - n, j - 2 * n)],
                _ => 0.0,
            };
            value * step
        });
        let rates = Mat::from_fn(n, size, |i, j| match j {
            j if j < n => -k[(i, j)],
            j if j < 2 * n => -c[(i, j - n)],
            j => b[(i, j - 2 * n)],
        });
        let exponential = exponential(&a);
        let transition = exponential.submatrix(0, 0, 2 * n, 2 * n).to_owned();
        let inputs = exponential.submatrix(0, 2 * n, 2 * n, inputs).to_owned();
        Some(Self { size: n, scale, transition, inputs, rates })
    }

    /// `next = exp(A h) state`.
    pub(crate) fn advance(&self, state: &[f64], next: &mut [f64]) {
        next.fill(0.0);
        for (j, &value) in state.iter().enumerate() {
            for (x, a) in next.iter_mut().zip(self.transition.col_as_slice(j)) {
                *x += a * value;
            }
        }
    }

    /// Adds what a force of pattern `input` does that is constant over the step.
    pub(crate) fn push(&self, input: usize, force: f64, next: &mut [f64]) {
        if force != 0.0 {
            for (x, b) in next.iter_mut().zip(self.inputs.col_as_slice(input)) {
                *x += b * force;
            }
        }
    }

    /// Accelerations (m/s^2) of all DOFs in `state` under forces of all patterns.
    pub(crate) fn acceleration(&self, state: &[f64], forces: impl Iterator<Item = f64>) -> Vec<f64> {
        let n = self.size;
        let displacements = state[..n].iter().map(|x| x / self.scale);
        let all = displacements.chain(state[n..].iter().copied()).chain(forces);
        let mut result = vec![0.0; n];
        for (j, value) in all.enumerate() {
            for (x, r) in result.iter_mut().zip(self.rates.col_as_slice(j)) {
                *x += r * value;
            }
        }
        result
    }

    /// Displacement (m) of DOF `i` at the end of a step under a unit force of pattern `input` from rest.
    pub(crate) fn displacement(&self, i: usize, input: usize) -> f64 {
        self.inputs[(i, input)] / self.scale
    }
}

/// `exp(a)` by scaling, Taylor's series and squaring.
fn exponential(a: &Mat<f64>) -> Mat<f64> {
    let n = a.nrows();
    let norm = (0..n).map(|j| a.col_as_slice(j).iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max);
    let halvings = if norm > 0.25 { (norm / 0.25).log2().ceil() as i32 } else { 0 };
    let scaled = Mat::from_fn(n, n, |i, j| a[(i, j)] * 0.5_f64.powi(halvings));
    let mut sum = Mat::<f64>::identity(n, n);
    let mut term = Mat::<f64>::identity(n, n);
    for k in 1..=14 {
        term = product(term.as_ref(), scaled.as_ref());
        term *= faer::Scale(1.0 / f64::from(k));
        sum += &term;
    }
    for _ in 0..halvings {
        sum = product(sum.as_ref(), sum.as_ref());
    }
    sum
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    /// A damped oscillator under a constant force against the textbook's formula.
    #[test]
    fn one_step_of_an_oscillator_is_exact() {
        let (m, c, k, f, t) = (2.0, 0.7, 50.0, 3.0, 0.4);
        let scalar = |x: f64| Mat::from_fn(1, 1, |_, _| x);
        let propagator = Propagator::new(&scalar(m), &scalar(c), &scalar(k), &scalar(1.0), t).unwrap();
        let (x0, v0) = (0.3, -1.0);
        let mut next = [0.0; 2];
        propagator.advance(&[propagator.scale * x0, v0], &mut next);
        propagator.push(0, f, &mut next);
        let (decay, wn) = (c / (2.0 * m), f64::sqrt(k / m));
        let wd = (wn * wn - decay * decay).sqrt();
        let (a, e) = (x0 - f / k, (-decay * t).exp());
        let b = (v0 + decay * a) / wd;
        let expected = f / k + e * (a * (wd * t).cos() + b * (wd * t).sin());
        assert!((next[0] / propagator.scale - expected).abs() < 1e-13);
        let acceleration = propagator.acceleration(&[propagator.scale * x0, v0], std::iter::once(f))[0];
        assert!((acceleration - (f - k * x0 - c * v0) / m).abs() < 1e-12);
        let rate = e * ((b * wd - decay * a) * (wd * t).cos() - (a * wd + decay * b) * (wd * t).sin());
        assert!((next[1] - rate).abs() < 1e-12);
    }
}
