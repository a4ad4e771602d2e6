//! What differs from run to run and is of no interest: a joint that re-seats shifts all stiffness of a run by `s_r`, the
//! level of the force or a discrepancy in proportion to the response multiplies it by `1 + d_r` (`d_r` complex). With the
//! whitened columns `V = [s_s dY/ds, s_d Y, i s_d Y]` of a run their marginal covariance is `1 + V V^T`, and
//!
//! ```text
//! (1 + V V^T)^(-1/2) = 1 - Q [1 - (1 + D)^(-1/2)] Q^T,      V V^T = Q D Q^T
//! ```
//!
//! so that no parameter a run is left in a fit (elimination of local parameters; Harville 1977).

use dashpot_numerics::{dot, symmetric};
use faer::Mat;

/// Local nuisance parameters of one run, eliminated.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct RunNuisance {
    /// `V`, one column a parameter, in units of its prior deviation.
    columns: Vec<Vec<f64>>,
    /// `Q`.
    basis: Vec<Vec<f64>>,
    /// `1 - (1 + D)^(-1/2)`.
    shrinkage: Vec<f64>,
    /// What is in the model already, in the same units; none: nothing.
    reference: Vec<f64>,
}

/// What the data say of the local parameters of one run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RunNuisanceEstimate {
    /// Values in units of the prior deviations.
    pub values: Vec<f64>,
    /// Variances in the same units, 1 where the data say nothing.
    pub variances: Vec<f64>,
}

impl RunNuisance {
    /// Of the whitened columns `V`.
    pub(crate) fn new(columns: Vec<Vec<f64>>) -> Self {
        let q = columns.len();
        let gram = Mat::from_fn(q, q, |i, j| dot(&columns[i], &columns[j]));
        let (mut basis, mut shrinkage) = (Vec::new(), Vec::new());
        if let Some((values, vectors)) = symmetric(gram.as_ref()) {
            let largest = values.iter().fold(0.0_f64, |m, v| m.max(*v));
            for (k, &value) in values.iter().enumerate().filter(|(_, v)| **v > 1e-12 * largest) {
                let mut direction = vec![0.0; columns[0].len()];
                for (i, column) in columns.iter().enumerate() {
                    let share = vectors[(i, k)] / value.sqrt();
                    direction.iter_mut().zip(column).for_each(|(d, c)| *d += share * c);
                }
                basis.push(direction);
                shrinkage.push(1.0 - (1.0 + value).sqrt().recip());
            }
        }
        Self { columns, basis, shrinkage, reference: Vec::new() }
    }

    /// The same where the model has the parameters at `reference` already, in units of their prior deviations.
    #[must_use]
    pub(crate) fn at(self, reference: Vec<f64>) -> Self {
        Self { reference, ..self }
    }

    /// Turns a whitened residual of the run, with the parameters at the reference, into one with none of them.
    pub(crate) fn without_reference(&self, rows: &mut [f64]) {
        for (column, u) in self.columns.iter().zip(&self.reference).filter(|(_, u)| **u != 0.0) {
            rows.iter_mut().zip(column).for_each(|(r, c)| *r += u * c);
        }
    }

    /// Multiplies the whitened rows of the run by `(1 + V V^T)^(-1/2)`.
    pub(crate) fn project(&self, rows: &mut [f64]) {
        for (direction, shrink) in self.basis.iter().zip(&self.shrinkage) {
            let share = shrink * dot(direction, rows);
            rows.iter_mut().zip(direction).for_each(|(r, d)| *r -= share * d);
        }
    }

    /// `ln det (1 + V V^T)`.
    pub(crate) fn log_determinant(&self) -> f64 {
        self.shrinkage.iter().map(|s| -2.0 * (1.0 - s).ln()).sum()
    }

    /// The parameters given the whitened residual `rows` after it was projected: `(1 + V^T V)^-1 V^T r`, which is
    /// `V^T (1 + V V^T)^-1 r`.
    pub(crate) fn estimate(&self, rows: &[f64]) -> RunNuisanceEstimate {
        let q = self.columns.len();
        let unit = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
        let normal = Mat::from_fn(q, q, |i, j| unit(i, j) + dot(&self.columns[i], &self.columns[j]));
        let mut twice = rows.to_vec();
        self.project(&mut twice);
        let values = (0..q).map(|i| dot(&self.columns[i], &twice)).collect();
        let identity = Mat::<f64>::identity(q, q);
        let variances = match crate::math::least_squares::solve_symmetric(normal.as_ref(), identity.as_ref()) {
            Ok(inverse) => (0..q).map(|i| inverse[(i, i)]).collect(),
            Err(_) => vec![1.0; q],
        };
        RunNuisanceEstimate { values, variances }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_projection_is_the_inverse_root_of_the_marginal_covariance() {
        let v = vec![vec![1.0, 2.0, -0.5, 0.3], vec![0.4, -1.0, 2.0, 0.0]];
        let nuisance = RunNuisance::new(v.clone());
        let covariance = |i: usize, j: usize| v.iter().map(|c| c[i] * c[j]).sum::<f64>() + f64::from(u8::from(i == j));
        // W S W = 1.
        let column = |j: usize| {
            let mut unit = vec![0.0; 4];
            unit[j] = 1.0;
            nuisance.project(&mut unit);
            let mut image: Vec<f64> = (0..4).map(|i| (0..4).map(|k| covariance(i, k) * unit[k]).sum()).collect();
            nuisance.project(&mut image);
            image
        };
        for j in 0..4 {
            let image = column(j);
            (0..4).for_each(|i| assert!((image[i] - f64::from(u8::from(i == j))).abs() < 1e-12, "{i} {j}"));
        }
        let plain = Mat::from_fn(2, 2, |i, j| dot(&v[i], &v[j]) + f64::from(u8::from(i == j)));
        let determinant = plain[(0, 0)] * plain[(1, 1)] - plain[(0, 1)].powi(2);
        assert!((nuisance.log_determinant() - determinant.ln()).abs() < 1e-12);
    }

    #[test]
    fn a_shift_that_the_data_show_is_estimated() {
        let nuisance = RunNuisance::new(vec![vec![100.0, 50.0, 0.0]]);
        let mut rows = [150.0, 75.0, 0.1];
        nuisance.project(&mut rows);
        let estimate = nuisance.estimate(&rows);
        assert!((estimate.values[0] - 1.5).abs() < 1e-3 && estimate.variances[0] < 1e-3);
    }
}
