//! Eigenvalues and eigenvectors. All functions return `None` where the iteration does not converge.

use crate::Cholesky;
use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, SelfAdjointEvdParams, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Auto, Mat, MatRef, Par, Side, c64};

/// Eigenvalues of `K x = lambda M x`, ascending, and vectors with `X^T M X = I`, for symmetric `K` and `M = L L^T`.
pub fn generalised_symmetric(k: MatRef<'_, f64>, m: &Cholesky) -> Option<(Vec<f64>, Mat<f64>)> {
    let l = m.factor();
    let mut half = symmetrised(k);
    solve_lower_triangular_in_place(l, half.as_mut(), Par::Seq);
    let mut reduced = half.transpose().to_owned();
    solve_lower_triangular_in_place(l, reduced.as_mut(), Par::Seq);
    let (values, mut vectors) = symmetric(symmetrised(reduced.as_ref()).as_ref())?;
    solve_upper_triangular_in_place(l.transpose(), vectors.as_mut(), Par::Seq);
    Some((values, vectors))
}

/// Eigenvalues, ascending, and orthonormal vectors of a symmetric matrix (lower triangle), by QR iteration.
///
/// `faer`'s own `self_adjoint_eigen` divides and conquers from 128 rows on; on matrices whose eigenvalues span many orders
/// of magnitude, such as the stiffness of a beam, version 0.24 then gives vectors with residuals of 1e-4 of the largest
/// eigenvalue.
pub fn symmetric(a: MatRef<'_, f64>) -> Option<(Vec<f64>, Mat<f64>)> {
    let n = a.nrows();
    let iteration = SelfAdjointEvdParams { recursion_threshold: usize::MAX, ..Auto::<f64>::auto() };
    let scratch = self_adjoint_evd_scratch::<f64>(n, ComputeEigenvectors::Yes, Par::Seq, iteration.into());
    let (mut vectors, mut values) = (Mat::zeros(n, n), Diag::zeros(n));
    let memory = &mut MemBuffer::new(scratch);
    self_adjoint_evd(a, values.as_mut(), Some(vectors.as_mut()), Par::Seq, MemStack::new(memory), iteration.into())
        .ok()?;
    Some((values.column_vector().iter().copied().collect(), vectors))
}

/// Eigenvalues of a symmetric matrix (lower triangle), ascending.
pub fn symmetric_values(a: MatRef<'_, f64>) -> Option<Vec<f64>> {
    a.self_adjoint_eigenvalues(Side::Lower).ok()
}

/// Eigenvalues of a general real matrix.
pub fn eigenvalues(a: MatRef<'_, f64>) -> Option<Vec<c64>> {
    a.eigenvalues().ok()
}

/// Eigenvalues and right vectors (columns, unit norm) of a general real matrix.
pub fn real_general(a: MatRef<'_, f64>) -> Option<(Vec<c64>, Mat<c64>)> {
    let eigen = a.eigen().ok()?;
    Some((eigen.S().column_vector().iter().copied().collect(), eigen.U().to_owned()))
}

fn symmetrised(a: MatRef<'_, f64>) -> Mat<f64> {
    Mat::from_fn(a.nrows(), a.ncols(), |i, j| 0.5 * (a[(i, j)] + a[(j, i)]))
}
