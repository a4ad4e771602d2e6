//! Products of matrices.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the wide instructions")]

use crate::lanes::{Wide, dot, widest};
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

/// `A^T b`, n values: a scalar product a column, which reads the matrix once; products of blocks would pack it first.
pub fn with_columns(a: &Mat<f64>, b: &[f64]) -> Vec<f64> {
    widest(WithColumns(a, b))
}

struct WithColumns<'a>(&'a Mat<f64>, &'a [f64]);

impl Wide for WithColumns<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn call(self) -> Vec<f64> {
        let Self(a, b) = self;
        (0..a.ncols()).map(|j| dot(a.col_as_slice(j), b)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{transposed_product, with_columns};
    use faer::{Mat, MatRef};

    #[test]
    fn products_with_columns_are_those_of_the_transposed_matrix() {
        let a = Mat::from_fn(37, 5, |i, j| (1.7 * i as f64 - 0.4 * j as f64).sin());
        let b: Vec<f64> = (0..37).map(|i| (0.3 * f64::from(i)).cos()).collect();
        let whole = transposed_product(a.as_ref(), MatRef::from_column_major_slice(&b, 37, 1));
        let own = with_columns(&a, &b);
        assert!((0..5).all(|j| (own[j] - whole[(j, 0)]).abs() < 1e-13), "{own:?} {whole:?}");
    }
}
