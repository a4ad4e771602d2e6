//! Products for many short vectors that lie one behind the other, as a march in time needs them at every step.

use pulp::Arch;

use crate::lanes::dot;

/// `y += A x`, the matrix column by column.
pub fn add_product(matrix: &[f64], x: &[f64], y: &mut [f64]) {
    Arch::new().dispatch(|| {
        for (column, x) in matrix.chunks_exact(y.len()).zip(x) {
            y.iter_mut().zip(column).for_each(|(y, a)| *y += a * x);
        }
    });
}

/// Multiplies complex vectors, each its real parts and behind them its imaginary parts, by `factor`, laid out alike.
pub fn turn(factor: &[f64], vectors: &mut [f64]) {
    let half = factor.len() / 2;
    if half == 0 {
        return;
    }
    let (c, s) = factor.split_at(half);
    Arch::new().dispatch(|| {
        for vector in vectors.chunks_exact_mut(2 * half) {
            let (re, im) = vector.split_at_mut(half);
            for k in 0..half {
                let (a, b) = (re[k], im[k]);
                re[k] = c[k] * a - s[k] * b;
                im[k] = s[k] * a + c[k] * b;
            }
        }
    });
}

/// Scalar products of every row with every vector, both `width` long: those of the first vector first.
pub fn scalar_products(rows: &[f64], vectors: &[f64], width: usize, out: &mut Vec<f64>) {
    out.clear();
    if width == 0 {
        return;
    }
    Arch::new().dispatch(|| {
        for vector in vectors.chunks_exact(width) {
            out.extend(rows.chunks_exact(width).map(|row| dot(row, vector)));
        }
    });
}

#[cfg(test)]
mod tests {
    use super::{add_product, scalar_products, turn};

    #[test]
    fn products_are_those_of_the_definition() {
        let mut y = [1.0, 1.0];
        add_product(&[1.0, 2.0, 3.0, 4.0], &[10.0, 100.0], &mut y);
        assert_eq!(y, [311.0, 421.0]);
        let mut vectors = [1.0, 2.0, 3.0, 4.0, 0.0, 1.0, 1.0, 0.0];
        turn(&[0.0, 2.0, 1.0, 0.0], &mut vectors);
        assert_eq!(vectors, [-3.0, 4.0, 1.0, 8.0, -1.0, 2.0, 0.0, 0.0]);
        let mut out = Vec::new();
        scalar_products(&[1.0, 2.0, 3.0, 4.0], &[1.0, 1.0, 2.0, 0.0], 2, &mut out);
        assert_eq!(out, [3.0, 7.0, 2.0, 6.0]);
    }
}
