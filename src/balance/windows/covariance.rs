//! Covariance of the rows of one record: each row's residual is a linear functional of the noise of the channels.
//!
//! ```text
//! delta row_k = sum_t sum_r  gx_kr(t) delta q_r(t) + gv_kr(t) delta v_r(t)
//! gv = phi_r^T B u dt - 2 kappa v_r dt  within the window,  -+ v_r at its ends;     gx = -+ omega_r^2 q_r at its ends
//! cov(k, l) = (2 / N) Re sum_f sum_s sigma_s^2 U_ks conj(U_ls),
//!     U_ks(f) = W omega^-k_s sum_r P_rs (Gx_kr - i omega Gv_kr)
//! ```
//!
//! `kappa` (1/s) stands for the sources that are looked for: the damping that balances the record as a whole. Windows share
//! ends and the memory of the filter, so that neighbours are correlated, overlapping ones or not. The noise of a force channel
//! acts through the velocity of its DOF, `delta row = sum v delta u dt`.

use super::band::line_omega;
use super::motion::Motion;
use crate::control::Control;
use dashpot_numerics::RealTransform;
use faer::{Mat, c64};
use std::f64::consts::TAU;

/// Error of the filters and of the integrals over a window, relative to the energy at its ends.
const NUMERICAL: f64 = 1e-4;

/// Covariance of the rows of windows `[ends[k].0, ends[k].1]` (samples), J^2.
pub(super) fn covariance(motion: &Motion, ends: &[(usize, usize)], kappa: f64, control: &Control) -> Mat<f64> {
    let count = ends.len();
    let memory = motion.band.memory(motion.step);
    let longest = ends.iter().map(|(a, b)| b - a).max().unwrap_or(1);
    let length = (longest + 2 * memory + 2).next_power_of_two();
    let lines = Lines::new(motion, length);
    let rows: Vec<Vec<c64>> = control.map(count, |k| lines.row(motion, ends[k], kappa));
    let reach = longest + memory;
    let mut covariance = Mat::<f64>::zeros(count, count);
    for k in 0..count {
        for l in k..count {
            let apart = ends[l].0 - ends[k].0;
            if apart > reach {
                break;
            }
            let value = lines.product(&rows[k], &rows[l], apart) + force_noise(motion, ends[k], ends[l]);
            covariance[(k, l)] += value;
            if l > k {
                covariance[(l, k)] += value;
            }
        }
    }
    add_numerical(motion, ends, &mut covariance);
    covariance
}

/// Ends whose energies are wrong by a small share each, the same end alike in all windows that have it.
fn add_numerical(motion: &Motion, ends: &[(usize, usize)], covariance: &mut Mat<f64>) {
    let share = |n: usize| (NUMERICAL * motion.energy(n)).powi(2);
    for (k, &(a, b)) in ends.iter().enumerate() {
        for (l, &(c, d)) in ends.iter().enumerate() {
            let mut sum = 0.0;
            for (n, sign) in [(a, 1.0), (b, -1.0)] {
                for (m, other) in [(c, 1.0), (d, -1.0)] {
                    if n == m {
                        sum += sign * other * share(n);
                    }
                }
            }
            covariance[(k, l)] += sum;
        }
    }
}

/// What the noise of the force channels does to two rows, J^2.
fn force_noise(motion: &Motion, first: (usize, usize), second: (usize, usize)) -> f64 {
    let common = first.0.max(second.0)..first.1.min(second.1);
    let shapes = &motion.band.shapes;
    let noise_of_force = |(j, (dof, _)): (usize, &(usize, Vec<f64>))| {
        let velocity = |n: usize| (0..motion.v.len()).map(|r| shapes[(*dof, r)] * motion.v[r][n]).sum::<f64>();
        motion.force_variance[j] * motion.step.powi(2) * common.clone().map(|n| velocity(n).powi(2)).sum::<f64>()
    };
    motion.forces.iter().enumerate().map(noise_of_force).sum()
}

/// Lines of the transforms of windows that lie in the band.
struct Lines {
    transform: RealTransform,
    length: usize,
    band: Vec<usize>,
    resolution: f64,
    /// `W omega^-k_s sigma_s`, sensor by sensor on the lines of the band.
    weights: Vec<Vec<f64>>,
}

impl Lines {
    fn new(motion: &Motion, length: usize) -> Self {
        let resolution = line_omega(length, motion.step);
        let gain = |k: usize| motion.band.gain(k as f64 * resolution / TAU);
        let band: Vec<usize> = (1..length / 2).filter(|&k| gain(k) > 0.0).collect();
        let weights_of_sensor = |&(order, variance): &(i32, f64)| {
            band.iter().map(|&k| gain(k) * (k as f64 * resolution).powi(-order) * variance.sqrt()).collect()
        };
        let weights = motion.sensors.iter().map(weights_of_sensor).collect();
        Self { transform: RealTransform::new(length), length, band, resolution, weights }
    }

    /// `U_ks` of a window, sensor by sensor.
    fn row(&self, motion: &Motion, (a, b): (usize, usize), kappa: f64) -> Vec<c64> {
        let modal: Vec<Vec<c64>> = (0..motion.q.len()).map(|r| self.mode(motion, (a, b), r, kappa)).collect();
        let mut row = Vec::with_capacity(self.weights.len() * self.band.len());
        for (s, weights) in self.weights.iter().enumerate() {
            for (i, weight) in weights.iter().enumerate() {
                let sum: c64 = modal.iter().enumerate().map(|(r, z)| z[i] * motion.band.expansion[(r, s)]).sum();
                row.push(sum * *weight);
            }
        }
        row
    }

    /// `Gx - i omega Gv` of a mode on the lines of the band.
    fn mode(&self, motion: &Motion, (a, b): (usize, usize), r: usize, kappa: f64) -> Vec<c64> {
        let (q, v, step) = (&motion.q[r], &motion.v[r], motion.step);
        let mut by_velocity = vec![0.0; self.length];
        for n in a..=b {
            let whole = if n == a || n == b { 0.5 } else { 1.0 };
            let force: f64 = motion.forces.iter().map(|(dof, u)| motion.band.shapes[(*dof, r)] * u[n]).sum();
            by_velocity[n - a] = whole * step * (force - 2.0 * kappa * v[n]);
        }
        by_velocity[0] += v[a];
        by_velocity[b - a] -= v[b];
        let spectrum = self.transform.forward(&mut by_velocity);
        let square = motion.band.omega[r].powi(2);
        let line = |&k: &usize| {
            let omega = k as f64 * self.resolution;
            let (sin, cos) = (omega * step * (b - a) as f64).sin_cos();
            let ends = c64::new(q[a] - q[b] * cos, q[b] * sin) * square;
            ends - c64::new(0.0, omega) * spectrum[k]
        };
        self.band.iter().map(line).collect()
    }

    /// Covariance of two rows, the second `apart` samples later.
    fn product(&self, first: &[c64], second: &[c64], apart: usize) -> f64 {
        let count = self.band.len();
        let mut sum = 0.0;
        for (i, &k) in self.band.iter().enumerate() {
            let turns = (k * apart) % self.length;
            let (sin, cos) = (TAU * turns as f64 / self.length as f64).sin_cos();
            let pairs = first.iter().skip(i).step_by(count).zip(second.iter().skip(i).step_by(count));
            let line: c64 = pairs.map(|(x, y)| x * y.conj()).sum();
            sum += line.re * cos - line.im * sin;
        }
        2.0 * sum / self.length as f64
    }
}
