//! Non-negative least squares on some columns, with standard deviations and condition.

use super::error::IdentifyError;
use super::promising::{non_negative, promising};
use super::system::System;
use crate::math::least_squares::LeastSquares;
use crate::math::nnls::nnls;
use faer::Mat;

/// The coefficients of a set.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fit {
    pub coefficients: Vec<f64>,
    /// Standard deviations; infinite where the data do not determine a coefficient.
    pub deviations: Vec<f64>,
    /// Covariance of the coefficients.
    pub covariance: Mat<f64>,
    /// Sum of squares, each row over its deviation where that is known.
    pub chi_square: f64,
    /// Condition of the columns, each scaled to unit norm.
    pub condition: f64,
}

/// Coefficients of every column at once (of very many, of the most promising); not sparse.
pub(crate) fn all_columns(system: &System) -> Result<Vec<f64>, IdentifyError> {
    let chosen = promising(system, &[])?;
    let solution = non_negative(system, &chosen)?;
    Ok(scattered(system.a.ncols(), &chosen, &solution))
}

/// Coefficients of a set alone.
pub(crate) fn coefficients(system: &System, set: &[usize]) -> Result<Vec<f64>, IdentifyError> {
    let (a, b) = system.part(set, None);
    Ok(nnls(a.as_ref(), &b)?.solution)
}

/// A vector over all columns that holds the coefficients of a set and is zero elsewhere.
pub(crate) fn scattered(n: usize, set: &[usize], coefficients: &[f64]) -> Vec<f64> {
    let mut all = vec![0.0; n];
    for (&j, &c) in set.iter().zip(coefficients) {
        all[j] = c;
    }
    all
}

/// Rows less unknowns, at least 1.
pub(crate) fn freedom(rows: usize, unknowns: usize) -> usize {
    rows.saturating_sub(unknowns).max(1)
}

/// Solves for the coefficients of a set.
pub(crate) fn fit(system: &System, set: &[usize]) -> Result<Fit, IdentifyError> {
    let (a, b) = system.part(set, None);
    let coefficients = nnls(a.as_ref(), &b)?.solution;
    let chi_square = system.chi_square(set, &coefficients);
    let scale: Vec<f64> = (0..set.len())
        .map(|j| crate::math::nnls::norm(a.col(j).iter().copied().collect::<Vec<f64>>().as_slice()))
        .collect();
    let unit = Mat::from_fn(a.nrows(), a.ncols(), |i, j| if scale[j] > 0.0 { a[(i, j)] / scale[j] } else { 0.0 });
    let (covariance, condition) = covariance(system, &unit, &scale, chi_square);
    let deviations = (0..set.len()).map(|j| covariance[(j, j)].sqrt()).collect();
    Ok(Fit { coefficients, deviations, covariance, chi_square, condition })
}

/// Covariance of the coefficients and the condition of the unit columns. `A^+ diag(d^2) A^+T` with the rows' deviations `d`,
/// larger in proportion where the residual is larger than they allow; with unknown noise the residual stands for it.
fn covariance(system: &System, unit: &Mat<f64>, scale: &[f64], chi_square: f64) -> (Mat<f64>, f64) {
    let n = unit.ncols();
    let unknown = Mat::from_fn(n, n, |i, j| if i == j { f64::INFINITY } else { 0.0 });
    let rows = unit.nrows();
    let Ok(least_squares) = LeastSquares::new(unit.as_ref()) else { return (unknown, f64::INFINITY) };
    if rows < n || least_squares.rank() < n {
        return (unknown, f64::INFINITY);
    }
    let inverse = least_squares.pseudo_inverse();
    let ratio = chi_square / freedom(rows, n) as f64;
    let excess = match &system.deviation {
        Some(_) if rows > n => ratio.max(1.0),
        Some(_) => 1.0,
        None if rows > n => ratio,
        None => 0.0,
    };
    let variance = |i: usize| excess * system.deviation.as_ref().map_or(1.0, |d| d[i] * d[i]);
    let covariance = Mat::from_fn(n, n, |p, q| {
        (0..rows).map(|i| inverse[(p, i)] * variance(i) * inverse[(q, i)]).sum::<f64>() / (scale[p] * scale[q])
    });
    (covariance, least_squares.condition())
}

/// Mean square of the prediction error of each run by the coefficients of all other runs, over the rows; `None` where the
/// other runs do not determine them.
pub(crate) fn held_out(system: &System, set: &[usize]) -> Option<f64> {
    let runs = system.run.last().map_or(0, |r| r + 1);
    let mut sum = 0.0;
    for run in 0..runs {
        let (a, b) = system.part(set, Some(run));
        if a.nrows() < set.len() {
            return None;
        }
        let coefficients = nnls(a.as_ref(), &b).ok()?.solution;
        for i in (0..system.rows()).filter(|&i| system.run[i] == run) {
            let model: f64 = set.iter().zip(&coefficients).map(|(&j, c)| system.a[(i, j)] * c).sum();
            let deviation = system.deviation.as_ref().map_or(1.0, |d| d[i]);
            sum += ((model - system.b[i]) / deviation).powi(2);
        }
    }
    Some(sum / system.rows() as f64)
}
