//! Candidate models scored by the prediction of runs that were left out of their fit, and their probabilities.
//!
//! Near the optimum the whitened residual is linear in the variables of the effects and in the updating parameters,
//! `r = X z + e`, `e ~ N(0, 1)`, `z ~ N(0, P^-1)`. With group `g` of the runs left out
//!
//! ```text
//! N_-g = P + sum_{h != g} X_h^T X_h,   m = N_-g^-1 sum_{h != g} X_h^T r_h
//! ln p(r_g | others) = -1/2 [ |e_g|^2 - e_g^T X_g N^-1 X_g^T e_g + ln det N - ln det N_-g + ln det C_g ],
//! e_g = r_g - X_g m,   N = N_-g + X_g^T X_g
//! ```
//!
//! (Woodbury; `C_g` is the covariance of what is each run's own). Differences of the sums over groups are known no better than
//! they scatter from group to group, so that probabilities are means over the Bayesian bootstrap of the groups (pseudo-BMA+,
//! Yao, Vehtari, Simpson and Gelman 2018, Bayesian Analysis 13, 917).

use crate::diagnosis::residual::data::{Data, DiagnosisError};
use crate::diagnosis::residual::prediction::FINAL;
use crate::diagnosis::selection::fit_problem::OnResponse;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::levenberg_marquardt::variables::Variables;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::math::bootstrap::{DRAWS, shares};
use dashpot_numerics::{Cholesky, dot};
use faer::Mat;

/// About as many groups as runs are left out in.
const GROUPS: usize = 12;
/// Precision of the prior of the variables of effects, which are of order one about the fit: what a left-out group alone knows
/// of a parameter is unknown by a factor of `e`.
const PRECISION: f64 = 1.0;
/// Share of the draws in which a model must predict better: that within two standard deviations.
const SURE: f64 = 0.975;

/// The group of every run: neighbours in frequency of one session (or level).
pub(super) fn groups(data: &Data) -> Vec<usize> {
    let session = |r: usize| data.sessions.get(r).copied().unwrap_or(0);
    let sessions = data.sessions.iter().max().map_or(1, |last| last + 1);
    let blocks = (GROUPS / sessions).max(1);
    let mut groups = vec![0; data.runs.len()];
    for s in 0..sessions {
        let mut own: Vec<usize> = (0..data.runs.len()).filter(|&r| session(r) == s).collect();
        own.sort_by(|&a, &b| data.runs[a].omega.total_cmp(&data.runs[b].omega));
        let count = own.len().max(1);
        for (k, r) in own.into_iter().enumerate() {
            groups[r] = s * blocks + k * blocks / count;
        }
    }
    groups
}

impl ReferenceModel<'_> {
    /// Logarithm of the predictive density of each group of runs, left out of the fit of `fit` (none: corrections
    /// alone).
    pub(super) fn cross_validated(
        &self,
        fit: Option<&FittedModel>,
        groups: &[usize],
    ) -> Result<Vec<f64>, DiagnosisError> {
        let (variables, theta) = Variables::new(fit.map_or(&[], |fit| &fit.effects));
        let (estimator, starts) = (self.estimator(), fit.map_or_else(Vec::new, |fit| fit.starts.clone()));
        let mut problem = OnResponse { estimator, variables: &variables, settings: FINAL, starts, last: None };
        let (rows, own) = problem.at_reference(&theta)?;
        let rows = self.noise.updating.without_reference(rows);
        let mut columns: Vec<Vec<f64>> = own.into_iter().map(|c| c.into_iter().map(|x| -x).collect()).collect();
        columns.extend(self.noise.updating.slopes().iter().cloned());
        let precisions: Vec<f64> = (0..columns.len()).map(|k| if k < theta.len() { PRECISION } else { 1.0 }).collect();
        let count = groups.iter().max().map_or(0, |last| last + 1);
        let (mut of_row, mut own_costs) = (Vec::with_capacity(rows.len()), vec![0.0; count]);
        for (noise, &group) in self.noise.runs.iter().zip(groups) {
            of_row.extend(std::iter::repeat_n(group, noise.len()));
            own_costs[group] += noise.nuisance().log_determinant();
        }
        let problem = LinearModel { rows: &rows, columns: &columns, precisions: &precisions, of_row: &of_row };
        let densities = problem.left_out_densities(count);
        Ok(densities.iter().zip(own_costs).map(|(density, cost)| density - 0.5 * cost).collect())
    }
}

/// A linear model of unit noise with normal priors about zero.
struct LinearModel<'a> {
    rows: &'a [f64],
    /// `X`, one column a parameter.
    columns: &'a [Vec<f64>],
    /// Diagonal of `P`.
    precisions: &'a [f64],
    /// Group of every row.
    of_row: &'a [usize],
}

impl LinearModel<'_> {
    /// Logarithm of the predictive density of every group (without `ln 2 pi`), given all others.
    fn left_out_densities(&self, groups: usize) -> Vec<f64> {
        let parts: Vec<(Mat<f64>, Mat<f64>)> = (0..groups).map(|g| self.normal(g)).collect();
        (0..groups).map(|g| self.density(g, &parts)).collect()
    }

    /// `P + sum X_h^T X_h` and `sum X_h^T r_h` over the groups but one.
    fn without(&self, group: usize, parts: &[(Mat<f64>, Mat<f64>)]) -> (Mat<f64>, Mat<f64>) {
        let p = self.columns.len();
        let mut normal = Mat::from_fn(p, p, |i, j| if i == j { self.precisions[i] } else { 0.0 });
        let mut right = Mat::zeros(p, 1);
        for (product, part) in parts.iter().enumerate().filter(|(h, _)| *h != group).map(|(_, part)| part) {
            normal += product;
            right += part;
        }
        (normal, right)
    }

    /// `X_g^T X_g` and `X_g^T r_g`.
    fn normal(&self, group: usize) -> (Mat<f64>, Mat<f64>) {
        let own = |values: &[f64]| -> Vec<f64> {
            values.iter().zip(self.of_row).filter(|(_, g)| **g == group).map(|(x, _)| *x).collect()
        };
        let (rows, columns) = (own(self.rows), self.columns.iter().map(|c| own(c)).collect::<Vec<_>>());
        let p = columns.len();
        let product = Mat::from_fn(p, p, |i, j| dot(&columns[i], &columns[j]));
        (product, Mat::from_fn(p, 1, |i, _| dot(&columns[i], &rows)))
    }

    fn density(&self, group: usize, parts: &[(Mat<f64>, Mat<f64>)]) -> f64 {
        let p = self.columns.len();
        let (normal, sum) = self.without(group, parts);
        let (product, right) = &parts[group];
        let full = Cholesky::new((&normal + product).as_ref());
        let (Some(full), Some(rest)) = (full, Cholesky::new(normal.as_ref())) else { return f64::NEG_INFINITY };
        let mean = rest.solve(sum.as_ref());
        let own = |(row, g): (usize, &usize)| (*g == group).then_some(row);
        let left = self
            .of_row
            .iter()
            .enumerate()
            .filter_map(own)
            .map(|row| self.rows[row] - (0..p).map(|k| self.columns[k][row] * mean[(k, 0)]).sum::<f64>());
        let square: f64 = left.map(|e| e * e).sum();
        // X_g^T e_g = X_g^T r_g - X_g^T X_g m.
        let seen = right - product * &mean;
        let solved = full.solve(seen.as_ref());
        let explained: f64 = (0..p).map(|i| seen[(i, 0)] * solved[(i, 0)]).sum();
        -0.5 * (square - explained + full.log_determinant() - rest.log_determinant())
    }
}

/// Whether a model predicts the groups better than another, whichever groups there had been: in all but few draws of the
/// Bayesian bootstrap.
pub(super) fn exceeds(densities: &[f64], others: &[f64]) -> bool {
    let differences: Vec<f64> = densities.iter().zip(others).map(|(a, b)| a - b).collect();
    let better = shares(differences.len()).filter(|shares| dot(&differences, shares) > 0.0).count();
    better as f64 >= SURE * DRAWS as f64
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::math::bootstrap::probabilities;

    const ROWS: [f64; 7] = [0.4, -1.3, 2.0, 0.7, -0.2, 1.1, 0.3];
    const OF_ROW: [usize; 7] = [0, 0, 1, 1, 1, 2, 2];

    fn columns() -> Vec<Vec<f64>> {
        vec![vec![1.0, -2.0, 0.5, 0.0, 3.0, 1.0, 0.2], vec![0.0, 1.0, 1.5, -1.0, 0.4, 2.0, -0.7]]
    }

    /// Logarithm of the density (without `ln 2 pi`) of the rows whose group passes, of covariance `1 + X P^-1 X^T`.
    fn marginal(columns: &[Vec<f64>], precisions: &[f64], keep: impl Fn(usize) -> bool) -> f64 {
        let kept: Vec<usize> = (0..ROWS.len()).filter(|&i| keep(OF_ROW[i])).collect();
        let covariance = Mat::from_fn(kept.len(), kept.len(), |a, b| {
            let (i, j) = (kept[a], kept[b]);
            let shared: f64 = columns.iter().zip(precisions).map(|(c, p)| c[i] * c[j] / p).sum();
            shared + f64::from(u8::from(a == b))
        });
        let factor = Cholesky::new(covariance.as_ref()).unwrap();
        let rows = Mat::from_fn(kept.len(), 1, |a, _| ROWS[kept[a]]);
        let solved = factor.solve(rows.as_ref());
        let square: f64 = (0..kept.len()).map(|a| rows[(a, 0)] * solved[(a, 0)]).sum();
        -0.5 * (square + factor.log_determinant())
    }

    #[test]
    fn the_density_of_a_group_is_that_of_all_over_that_of_the_others() {
        let (columns, precisions) = (columns(), [1.0, 0.25]);
        let model = LinearModel { rows: &ROWS, columns: &columns, precisions: &precisions, of_row: &OF_ROW };
        let all = marginal(&columns, &precisions, |_| true);
        for (g, density) in model.left_out_densities(3).into_iter().enumerate() {
            let others = marginal(&columns, &precisions, |group| group != g);
            assert!((density - (all - others)).abs() < 1e-10, "{g}: {density} {}", all - others);
        }
    }

    #[test]
    fn what_is_better_in_every_group_is_sure_and_what_is_better_in_one_is_not() {
        let zero = vec![0.0; 8];
        let everywhere = vec![3.0, 40.0, 2.0, 5.0, 1.0, 900.0, 2.0, 4.0];
        let mixed = vec![-9.0, 40.0, -8.0, -5.0, -11.0, 2.0, -6.0, -4.0];
        assert!(exceeds(&everywhere, &zero) && !exceeds(&zero, &everywhere));
        assert!(!exceeds(&mixed, &zero) && !exceeds(&zero, &mixed));
        let sure = probabilities(&[zero.clone(), everywhere], &[0.0, 0.0]);
        assert!(sure[1] > 0.999, "{sure:?}");
        let open = probabilities(&[zero.clone(), mixed], &[0.0, 0.0]);
        assert!(open[0] > 0.2 && open[1] > 0.2 && (open[0] + open[1] - 1.0).abs() < 1e-12, "{open:?}");
        let alike = probabilities(&[zero.clone(), zero], &[0.0, -4.0]);
        assert!((alike[1] - (-4.0_f64).exp() / (1.0 + (-4.0_f64).exp())).abs() < 1e-12);
    }
}
