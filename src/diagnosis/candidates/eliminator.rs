//! Parameters that were free beside a free force, eliminated from the regression of laws on it: the force `g` would change
//! by `Gamma du` with the common parameters, of which `N` is known without it, and each harmonic has the covariance
//! `1/w + Sigma_own` by what is the run's own:
//!
//! ```text
//! J = min_du sum | L^-1 (g + Gamma du - F) |^2 + du^T N du,      L L^T = 1/w + Sigma_own
//! ```
//!
//! which is what the law leaves of the response itself, all else linear.

use crate::diagnosis::localisation::cell::FreeForce;
use crate::diagnosis::localisation::free_force::ForceFreedom;
use crate::diagnosis::updating::marginalisation::marginal;
use dashpot_numerics::{Cholesky, thin_qr};
use faer::Mat;

/// The elimination for the free forces of one place.
#[derive(Debug, Clone)]
pub(crate) struct Eliminator {
    /// By run and harmonic: lower triangle that turns the weighted force into one of unit covariance, `[a, b, c]` of
    /// `[[a, 0], [b, c]]`, and where its two rows stand.
    turns: Vec<(usize, [f64; 3])>,
    /// Orthonormal columns that span what the common parameters may do, data rows first.
    basis: Vec<Vec<f64>>,
}

impl Eliminator {
    /// For the `forces` of a place, `[run][harmonic]`, in the order of their rows: run by run, harmonic by harmonic, real
    /// part first.
    pub(super) fn new(forces: &[Vec<FreeForce>], freedom: &ForceFreedom) -> Self {
        let q = freedom.information.nrows();
        let count: usize = forces.iter().map(|run| 2 * run.len()).sum();
        let mut stacked = Mat::<f64>::zeros(count + q, q);
        let (mut turns, mut at) = (Vec::new(), 0);
        for (run, free) in forces.iter().zip(&freedom.runs) {
            for (h, force) in run.iter().enumerate().filter(|(_, f)| f.weight > 0.0) {
                let Some(Some(free)) = free.get(h) else { continue };
                let lower = root(force.weight, free.own);
                let row = at + 2 * h;
                turns.push((row, lower));
                for (k, by) in free.common.iter().enumerate() {
                    let turned = turn(lower, [by.re, by.im].map(|x| x * force.weight.sqrt()));
                    (stacked[(row, k)], stacked[(row + 1, k)]) = (turned[0], turned[1]);
                }
            }
            at += 2 * run.len();
        }
        let mut basis = Vec::new();
        if let Some(factor) = Cholesky::new(freedom.information.as_ref()).filter(|_| q > 0) {
            let l = factor.factor();
            for i in 0..q {
                (0..=i).for_each(|j| stacked[(count + j, i)] = l[(i, j)]);
            }
            let (orthonormal, _) = thin_qr(stacked.as_ref());
            basis = (0..q).map(|k| orthonormal.col_as_slice(k).to_vec()).collect();
        }
        Self { turns, basis }
    }

    /// Weighted differences of free force and law with everything eliminated; the sum of their squares is `J`.
    pub(super) fn eliminated(&self, mut rows: Vec<f64>) -> Vec<f64> {
        for &(at, lower) in &self.turns {
            let turned = turn(lower, [rows[at], rows[at + 1]]);
            (rows[at], rows[at + 1]) = (turned[0], turned[1]);
        }
        marginal(&self.basis, rows)
    }
}

/// Inverse of the lower Cholesky factor of `1 + w Sigma`.
fn root(weight: f64, [a, b, c]: [f64; 3]) -> [f64; 3] {
    let (a, b, c) = (1.0 + weight * a, weight * b, 1.0 + weight * c);
    let first = a.sqrt();
    let mixed = b / first;
    let second = (c - mixed * mixed).max(f64::MIN_POSITIVE).sqrt();
    [first.recip(), -mixed / (first * second), second.recip()]
}

fn turn([a, b, c]: [f64; 3], [x, y]: [f64; 2]) -> [f64; 2] {
    [a * x, b * x + c * y]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::localisation::free_force::HarmonicForceFreedom;
    use faer::c64;

    #[test]
    fn what_is_eliminated_is_the_least_over_the_common_parameters() {
        let forces = vec![vec![FreeForce { value: c64::new(1.0, 2.0), weight: 4.0 }]; 3];
        let runs = (0..3)
            .map(|r| {
                let common = vec![c64::new(1.0 + f64::from(r), -0.5), c64::new(0.2, f64::from(r))];
                vec![Some(HarmonicForceFreedom { common, own: [0.0; 3] })]
            })
            .collect::<Vec<_>>();
        let information = Mat::from_fn(2, 2, |i, j| if i == j { 3.0 } else { 0.5 });
        let freedom = ForceFreedom { runs: runs.clone(), information: information.clone() };
        let rows: Vec<f64> = (0..6).map(|k| f64::from(k) - 2.0).collect();
        let left: f64 = Eliminator::new(&forces, &freedom).eliminated(rows.clone()).iter().map(|x| x * x).sum();
        let cost = |u: [f64; 2]| {
            let mut sum = 0.0;
            for (r, run) in runs.iter().flatten().flatten().enumerate() {
                let by = (run.common[0] * u[0] + run.common[1] * u[1]) * 2.0;
                sum += (rows[2 * r] + by.re).powi(2) + (rows[2 * r + 1] + by.im).powi(2);
            }
            sum + (0..2).map(|i| (0..2).map(|j| u[i] * information[(i, j)] * u[j]).sum::<f64>()).sum::<f64>()
        };
        let mut least = f64::INFINITY;
        for i in -200..=200 {
            for j in -200..=200 {
                least = least.min(cost([f64::from(i) * 0.005, f64::from(j) * 0.005]));
            }
        }
        assert!((left - least).abs() < 1e-3 * least, "{left} {least}");
    }

    #[test]
    fn the_covariance_of_a_run_is_whitened() {
        let (weight, own) = (2.0, [0.5, 0.3, 1.5]);
        let lower = root(weight, own);
        let covariance = [[1.0 + weight * own[0], weight * own[1]], [weight * own[1], 1.0 + weight * own[2]]];
        let rows = [[lower[0], 0.0], [lower[1], lower[2]]];
        for i in 0..2 {
            for j in 0..2 {
                let mut sum = 0.0;
                for k in 0..2 {
                    for l in 0..2 {
                        sum += rows[i][k] * covariance[k][l] * rows[j][l];
                    }
                }
                assert!((sum - f64::from(u8::from(i == j))).abs() < 1e-12);
            }
        }
    }
}
