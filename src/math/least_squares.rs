//! Linear least squares `min |A x - b|` with its covariance, rank and condition, for small dense problems.
//!
//! `A D = Q R` (Householder, columns scaled to unit norm by `D`), `R = U S V^T`. Then `x = D V S^+ U^T Q^T b` and the
//! inverse normal matrix is `(A^T A)^-1 = D V S^-2 V^T D`. Directions with `S` below `RANK_TOLERANCE` times the largest
//! are left out: the solution is then that of least norm in scaled units, and the rank says so.

use super::nnls::norm;
use dashpot_numerics::{Cholesky, product, product_transposed, solve_indefinite, thin_qr, transposed_product};
use faer::{Mat, MatRef};

/// Singular values below this part of the largest count as zero.
const RANK_TOLERANCE: f64 = 1e-12;

/// Why a dense problem could not be solved.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum LinearError {
    #[error("row {row} of column {column} of the matrix is {value}: every entry must be a finite number")]
    NotFinite { row: usize, column: usize, value: f64 },
    #[error("the right-hand side has {values} rows but the matrix has {rows}: give one value a row")]
    Sizes { rows: usize, values: usize },
    #[error("a square matrix is needed, not one of {rows} x {columns}")]
    NotSquare { rows: usize, columns: usize },
    #[error("the singular values of a {rows} x {columns} matrix did not converge")]
    NoConvergence { rows: usize, columns: usize },
    #[error("the {size} x {size} matrix is singular")]
    Singular { size: usize },
}

/// A factorised least squares problem; solves for any number of right-hand sides.
#[derive(Debug, Clone)]
pub struct LeastSquares {
    a: Mat<f64>,
    /// D V S^+, n x r.
    backward: Mat<f64>,
    /// U^T Q^T, r x m.
    forward: Mat<f64>,
    singular_values: Vec<f64>,
    rank: usize,
}

impl LeastSquares {
    /// Factorises `A`, m x n, of any shape.
    ///
    /// # Errors
    /// [`LinearError::NotFinite`] for NaN or infinite entries.
    pub fn new(a: MatRef<'_, f64>) -> Result<Self, LinearError> {
        check_finite(a)?;
        let (m, n) = a.shape();
        let scale: Vec<f64> = (0..n).map(|j| column_scale(a, j)).collect();
        let scaled = Mat::from_fn(m, n, |i, j| a[(i, j)] / scale[j]);
        let (q, r) = if m > n { thin_qr(scaled.as_ref()) } else { (Mat::identity(m, m), scaled) };
        let (u, singular_values, v) = thin_svd(r.as_ref())?;
        let largest = singular_values.first().copied().unwrap_or(0.0);
        let rank = singular_values.iter().filter(|&&s| s > RANK_TOLERANCE * largest).count();
        let backward = Mat::from_fn(n, rank, |i, k| v[(i, k)] / singular_values[k] / scale[i]);
        let forward = transposed_product(u.subcols(0, rank), q.transpose());
        Ok(Self { a: a.to_owned(), backward, forward, singular_values, rank })
    }

    /// Number of independent columns.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Largest over least singular value of the matrix with unit columns; infinite when columns are dependent.
    pub fn condition(&self) -> f64 {
        if self.rank < self.a.ncols() {
            return f64::INFINITY;
        }
        match (self.singular_values.first(), self.singular_values.last()) {
            (Some(first), Some(last)) => first / last,
            _ => 1.0,
        }
    }

    /// The solution for one right-hand side of m values.
    ///
    /// # Errors
    /// [`LinearError::Sizes`] when `b` has another length.
    pub fn solve(&self, b: &[f64]) -> Result<Solution, LinearError> {
        if b.len() != self.a.nrows() {
            return Err(LinearError::Sizes { rows: self.a.nrows(), values: b.len() });
        }
        let rhs = Mat::from_fn(b.len(), 1, |i, _| b[i]);
        let x = product(self.backward.as_ref(), product(self.forward.as_ref(), rhs.as_ref()).as_ref());
        let model = product(self.a.as_ref(), x.as_ref());
        let residual: Vec<f64> = b.iter().zip(model.col_as_slice(0)).map(|(b, y)| b - y).collect();
        let freedom = b.len().saturating_sub(self.rank);
        let residual_norm = norm(&residual);
        let variance = if freedom == 0 { 0.0 } else { residual_norm.powi(2) / freedom as f64 };
        Ok(Solution { x: x.col_as_slice(0).to_vec(), residual, residual_norm, freedom, variance })
    }

    /// Moore-Penrose inverse, n x m (of the matrix with unit columns, scaled back).
    pub fn pseudo_inverse(&self) -> Mat<f64> {
        product(self.backward.as_ref(), self.forward.as_ref())
    }

    /// Standard deviation of every unknown for independent rows of the given variance.
    pub fn standard_deviations(&self, variance: f64) -> Vec<f64> {
        (0..self.a.ncols())
            .map(|i| (variance * (0..self.rank).map(|k| self.backward[(i, k)].powi(2)).sum::<f64>()).sqrt())
            .collect()
    }
}

/// The solution for one right-hand side.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// Unknowns, n values.
    pub x: Vec<f64>,
    /// `b - A x`, m values.
    pub residual: Vec<f64>,
    /// `|b - A x|`.
    pub residual_norm: f64,
    /// Degrees of freedom, rows less rank.
    pub freedom: usize,
    /// `|b - A x|^2 / freedom`: estimated variance of one row; 0 without a degree of freedom.
    pub variance: f64,
}

/// Largest entry times the norm of what is left, so that neither overflows; 1 for a zero column.
fn column_scale(a: MatRef<'_, f64>, j: usize) -> f64 {
    let column: Vec<f64> = (0..a.nrows()).map(|i| a[(i, j)]).collect();
    let length = norm(&column);
    if length > 0.0 { length } else { 1.0 }
}

/// Fails at the first entry that is NaN or infinite.
pub fn check_finite(a: MatRef<'_, f64>) -> Result<(), LinearError> {
    for column in 0..a.ncols() {
        for row in 0..a.nrows() {
            if !a[(row, column)].is_finite() {
                return Err(LinearError::NotFinite { row, column, value: a[(row, column)] });
            }
        }
    }
    Ok(())
}

/// Solves `A X = B` for symmetric `A` (n x n): Cholesky where it is positive definite, Bunch-Kaufman otherwise.
///
/// # Errors
/// [`LinearError`] when shapes disagree, an entry is not finite, or `A` is singular.
pub fn solve_symmetric(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Result<Mat<f64>, LinearError> {
    let n = a.nrows();
    if a.ncols() != n {
        return Err(LinearError::NotSquare { rows: n, columns: a.ncols() });
    }
    if b.nrows() != n {
        return Err(LinearError::Sizes { rows: n, values: b.nrows() });
    }
    check_finite(a)?;
    let x = Cholesky::new(a).map_or_else(|| solve_indefinite(a, b), |factor| factor.solve(b));
    check_finite(x.as_ref()).map_err(|_| LinearError::Singular { size: n })?;
    Ok(x)
}

/// Moore-Penrose inverse by singular values; those below `tolerance` times the largest count as zero.
///
/// # Errors
/// [`LinearError`] when an entry is not finite or the singular values do not converge.
pub fn pseudo_inverse(a: MatRef<'_, f64>, tolerance: f64) -> Result<Mat<f64>, LinearError> {
    let (u, s, v) = thin_svd(a)?;
    let rank = s.iter().filter(|&&value| value > tolerance * s[0]).count();
    let scaled = Mat::from_fn(a.ncols(), rank, |i, k| v[(i, k)] / s[k]);
    Ok(product_transposed(scaled.as_ref(), u.subcols(0, rank)))
}

/// `A = U S V^T` with singular values in descending order: `U` is m x k, `V` n x k, k the smaller of m and n.
///
/// # Errors
/// [`LinearError`] when an entry is not finite or the iteration does not converge.
pub fn thin_svd(a: MatRef<'_, f64>) -> Result<(Mat<f64>, Vec<f64>, Mat<f64>), LinearError> {
    check_finite(a)?;
    let (rows, columns) = a.shape();
    dashpot_numerics::thin_svd(a).ok_or(LinearError::NoConvergence { rows, columns })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use faer::mat;

    #[test]
    fn straight_line_with_known_deviations() {
        // y = p + q t at t = -1, 0, 1: variances are s^2 / 3 and s^2 / 2.
        let a = mat![[1.0, -1.0], [1.0, 0.0], [1.0, 1.0]];
        let problem = LeastSquares::new(a.as_ref()).unwrap();
        let fit = problem.solve(&[0.0, 4.0, 2.0]).unwrap();
        assert!((fit.x[0] - 2.0).abs() < 1e-14 && (fit.x[1] - 1.0).abs() < 1e-14);
        assert!((fit.variance - 6.0).abs() < 1e-12 && fit.freedom == 1);
        let deviations = problem.standard_deviations(fit.variance);
        assert!((deviations[0] - 2f64.sqrt()).abs() < 1e-13 && (deviations[1] - 3f64.sqrt()).abs() < 1e-13);
    }

    #[test]
    fn dependent_columns_are_counted() {
        let a = mat![[1.0, 2.0, 0.0], [1.0, 2.0, 1.0], [0.0, 0.0, 3.0], [1.0, 2.0, 0.0]];
        let problem = LeastSquares::new(a.as_ref()).unwrap();
        assert_eq!(problem.rank(), 2);
        assert!(problem.condition().is_infinite());
        let fit = problem.solve(&[3.0, 4.0, 3.0, 3.0]).unwrap();
        assert!(fit.residual_norm < 1e-13);
    }

    #[test]
    fn wide_matrices_and_wild_scales() {
        let a = mat![[1e-200, 0.0, 1e150], [0.0, 1e200, 1e150]];
        let fit = LeastSquares::new(a.as_ref()).unwrap().solve(&[1.0, 2.0]).unwrap();
        assert!(fit.residual_norm < 1e-12, "{fit:?}");
    }

    #[test]
    fn pseudo_inverse_meets_the_penrose_conditions() {
        let a = mat![[1.0, 2.0], [2.0, 4.0], [0.5, 1.0]];
        let p = pseudo_inverse(a.as_ref(), 1e-12).unwrap();
        assert!((&a * &p * &a - &a).norm_max() < 1e-13);
        assert!((&p * &a * &p - &p).norm_max() < 1e-13);
        let ap = &a * &p;
        assert!((&ap - ap.transpose()).norm_max() < 1e-13);
    }

    #[test]
    fn symmetric_solves_definite_and_indefinite() {
        for a in [mat![[4.0, 1.0], [1.0, 3.0]], mat![[1.0, 2.0], [2.0, 1.0]]] {
            let x = solve_symmetric(a.as_ref(), mat![[1.0], [2.0]].as_ref()).unwrap();
            assert!((&a * &x - mat![[1.0], [2.0]]).norm_max() < 1e-14);
        }
        let singular = solve_symmetric(mat![[1.0, 1.0], [1.0, 1.0]].as_ref(), mat![[1.0], [2.0]].as_ref());
        assert_eq!(singular, Err(LinearError::Singular { size: 2 }));
    }
}
