//! Eigenvalue problems: symmetric generalised `K x = omega^2 M x`, and general real or complex matrices.
//!
//! The generalised problem is reduced by the Cholesky factor `M = L L^T` to `L^-1 K L^-T y = omega^2 y`, `x = L^-T y`, so
//! that `X^T M X = I` to rounding.

use dashpot_numerics::Cholesky;
use faer::{Mat, MatRef, c64};

/// Why an eigenvalue problem has no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum EigenError {
    #[error("the second matrix is not positive definite (its least eigenvalue is {least:.3e})")]
    NotPositiveDefinite { least: f64 },
    #[error("the matrices are {first} x {first} and {second} x {second}: they must have one size")]
    Sizes { first: usize, second: usize },
    #[error("entry ({row}, {column}) is {value}: every entry must be a finite number")]
    NotFinite { row: usize, column: usize, value: f64 },
    #[error("the eigenvalues of a {size} x {size} matrix did not converge")]
    NoConvergence { size: usize },
}

/// Eigenvalues in ascending order and vectors with `X^T M X = I`.
#[derive(Debug, Clone, PartialEq)]
pub struct SymmetricEigen {
    /// `omega^2`, ascending.
    pub values: Vec<f64>,
    /// One column an eigenvalue, n x n.
    pub vectors: Mat<f64>,
}

/// Solves `K x = lambda M x` for symmetric `K` and symmetric positive definite `M` (lower triangles are read).
///
/// # Errors
/// [`EigenError`] when sizes disagree, an entry is not finite, or `M` is not positive definite.
pub fn generalised_symmetric(k: MatRef<'_, f64>, m: MatRef<'_, f64>) -> Result<SymmetricEigen, EigenError> {
    let n = m.nrows();
    if k.shape() != (n, n) || m.ncols() != n {
        return Err(EigenError::Sizes { first: k.nrows(), second: n });
    }
    check_finite(k)?;
    check_finite(m)?;
    let factor = Cholesky::new(m).ok_or_else(|| EigenError::NotPositiveDefinite { least: least_eigenvalue(m) })?;
    let (values, vectors) =
        dashpot_numerics::generalised_symmetric(k, &factor).ok_or(EigenError::NoConvergence { size: n })?;
    Ok(SymmetricEigen { values, vectors })
}

/// Eigenvalues in ascending order and orthonormal vectors of a symmetric matrix (lower triangle), by QR iteration.
///
/// # Errors
/// [`EigenError`] when an entry is not finite or the iteration does not converge.
pub fn symmetric(a: MatRef<'_, f64>) -> Result<SymmetricEigen, EigenError> {
    check_finite(a)?;
    let (values, vectors) = dashpot_numerics::symmetric(a).ok_or(EigenError::NoConvergence { size: a.nrows() })?;
    Ok(SymmetricEigen { values, vectors })
}

/// Least eigenvalue of a symmetric matrix; NaN when it does not converge.
pub fn least_eigenvalue(a: MatRef<'_, f64>) -> f64 {
    match dashpot_numerics::symmetric_values(a) {
        Some(values) => values.into_iter().fold(f64::INFINITY, f64::min),
        None => f64::NAN,
    }
}

/// Eigenvalues and right eigenvectors (columns, unit norm) of a general real matrix; complex ones come in conjugate pairs.
///
/// # Errors
/// [`EigenError`] when an entry is not finite or the iteration does not converge.
pub fn real_general(a: MatRef<'_, f64>) -> Result<(Vec<c64>, Mat<c64>), EigenError> {
    check_finite(a)?;
    dashpot_numerics::real_general(a).ok_or(EigenError::NoConvergence { size: a.nrows() })
}

/// Eigenvalues of a general real matrix.
///
/// # Errors
/// [`EigenError`] when an entry is not finite or the iteration does not converge.
pub fn general_values(a: MatRef<'_, f64>) -> Result<Vec<c64>, EigenError> {
    check_finite(a)?;
    dashpot_numerics::eigenvalues(a).ok_or(EigenError::NoConvergence { size: a.nrows() })
}

/// `(A + A^T) / 2`.
pub fn symmetrised(a: MatRef<'_, f64>) -> Mat<f64> {
    Mat::from_fn(a.nrows(), a.ncols(), |i, j| 0.5 * (a[(i, j)] + a[(j, i)]))
}

fn check_finite(a: MatRef<'_, f64>) -> Result<(), EigenError> {
    super::least_squares::check_finite(a).map_err(|error| match error {
        super::least_squares::LinearError::NotFinite { row, column, value } => {
            EigenError::NotFinite { row, column, value }
        }
        _ => EigenError::NoConvergence { size: a.nrows() },
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use faer::mat;

    #[test]
    fn two_masses_in_closed_form() {
        // m = 1, 1; k = 1 to the ground each, 1 between: omega^2 = 1, 3.
        let k = mat![[2.0, -1.0], [-1.0, 2.0]];
        let eigen = generalised_symmetric(k.as_ref(), Mat::<f64>::identity(2, 2).as_ref()).unwrap();
        assert!((eigen.values[0] - 1.0).abs() < 1e-14 && (eigen.values[1] - 3.0).abs() < 1e-14);
    }

    #[test]
    fn indefinite_mass_is_an_error_with_its_eigenvalue() {
        let error = generalised_symmetric(Mat::<f64>::identity(2, 2).as_ref(), mat![[1.0, 2.0], [2.0, 1.0]].as_ref());
        let Err(EigenError::NotPositiveDefinite { least }) = error else { panic!("{error:?}") };
        assert!((least + 1.0).abs() < 1e-14);
    }

    #[test]
    fn rotation_has_imaginary_pair() {
        let (values, _) = real_general(mat![[0.0, 2.0], [-2.0, 0.0]].as_ref()).unwrap();
        assert!(values.iter().any(|v| (v - c64::new(0.0, 2.0)).norm() < 1e-14));
        assert!(values.iter().any(|v| (v - c64::new(0.0, -2.0)).norm() < 1e-14));
    }
}
