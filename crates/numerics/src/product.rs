//! Products of matrices.

use faer::{Mat, MatRef};

/// `A B`, m x n.
pub fn product(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    a * b
}

/// `A^T B`.
pub fn transposed_product(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    a.transpose() * b
}

/// `A B^T`.
pub fn product_transposed(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    a * b.transpose()
}
