//! Singular values.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::svd::{ComputeSvdVectors, SvdParams, svd, svd_scratch};
use faer::{Auto, Mat, MatRef, Par};

/// `A = U S V^T` with singular values in descending order: `U` is m x k, `V` n x k, k the smaller of m and n. `None` where
/// the iteration does not converge.
///
/// By QR iteration at any size, for the reason given at [`crate::symmetric`].
pub fn thin_svd(a: MatRef<'_, f64>) -> Option<(Mat<f64>, Vec<f64>, Mat<f64>)> {
    let (rows, columns) = a.shape();
    let k = rows.min(columns);
    let iteration = SvdParams { recursion_threshold: usize::MAX, ..Auto::<f64>::auto() };
    let thin = ComputeSvdVectors::Thin;
    let memory = &mut MemBuffer::new(svd_scratch::<f64>(rows, columns, thin, thin, Par::Seq, iteration.into()));
    let (mut u, mut s, mut v) = (Mat::zeros(rows, k), Diag::zeros(k), Mat::zeros(columns, k));
    let stack = MemStack::new(memory);
    svd(a, s.as_mut(), Some(u.as_mut()), Some(v.as_mut()), Par::Seq, stack, iteration.into()).ok()?;
    Some((u, s.column_vector().iter().copied().collect(), v))
}
