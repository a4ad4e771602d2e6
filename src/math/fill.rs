//! Matrices filled entry by entry.
//!
//! `faer`'s own `Mat::from_fn` is compiled with the whole of `faer`'s matrix code again for every closure that is changed
//! anywhere in the crate; these are compiled beside the closure.

use faer::{Mat, c64};

/// A real matrix of the entries `entry(row, column)`.
pub(crate) fn filled(rows: usize, columns: usize, mut entry: impl FnMut(usize, usize) -> f64) -> Mat<f64> {
    let mut matrix = Mat::<f64>::zeros(rows, columns);
    for j in 0..columns {
        for i in 0..rows {
            matrix[(i, j)] = entry(i, j);
        }
    }
    matrix
}

/// A complex matrix of the entries `entry(row, column)`.
pub(crate) fn filled_complex(rows: usize, columns: usize, mut entry: impl FnMut(usize, usize) -> c64) -> Mat<c64> {
    let mut matrix = Mat::<c64>::zeros(rows, columns);
    for j in 0..columns {
        for i in 0..rows {
            matrix[(i, j)] = entry(i, j);
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::mat;

    #[test]
    fn entries_stand_where_they_belong() {
        assert_eq!(filled(2, 3, |i, j| (10 * i + j) as f64), mat![[0.0, 1.0, 2.0], [10.0, 11.0, 12.0]]);
        assert_eq!(filled_complex(1, 2, |_, j| c64::new(0.0, j as f64))[(0, 1)], c64::new(0.0, 1.0));
    }
}
