//! Products for many short vectors that lie one behind the other, as a march in time needs them at every step.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the wide instructions")]

use crate::lanes::{Wide, dot, widest};

/// `y += A x`, the matrix column by column.
pub fn add_product(matrix: &[f64], x: &[f64], y: &mut [f64]) {
    widest(AddProduct(matrix, x, y));
}

struct AddProduct<'a>(&'a [f64], &'a [f64], &'a mut [f64]);

impl Wide for AddProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(matrix, x, y) = self;
        let mut rest = matrix;
        for x in x {
            let (column, others) = rest.split_at(y.len());
            rest = others;
            y.iter_mut().zip(column).for_each(|(y, a)| *y += a * x);
        }
    }
}

/// Multiplies complex vectors, each its real parts and behind them its imaginary parts, by `factor`, laid out alike.
pub fn turn(factor: &[f64], vectors: &mut [f64]) {
    if factor.len() > 1 {
        widest(Turn(factor, vectors));
    }
}

struct Turn<'a>(&'a [f64], &'a mut [f64]);

impl Wide for Turn<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(factor, vectors) = self;
        let half = factor.len() / 2;
        let (c, s) = factor.split_at(half);
        let mut rest = vectors;
        while rest.len() >= 2 * half {
            let (re, others) = rest.split_at_mut(half);
            let (im, others) = others.split_at_mut(half);
            rest = others;
            for ((re, im), (c, s)) in re.iter_mut().zip(im).zip(c.iter().zip(s)) {
                let (a, b) = (*re, *im);
                *re = c * a - s * b;
                *im = s * a + c * b;
            }
        }
    }
}

/// Scalar products of every row with every vector, both `width` long: those of the first vector first.
pub fn scalar_products(rows: &[f64], vectors: &[f64], width: usize, out: &mut Vec<f64>) {
    out.clear();
    if width > 0 {
        widest(ScalarProducts { rows, vectors, width, out });
    }
}

struct ScalarProducts<'a> {
    rows: &'a [f64],
    vectors: &'a [f64],
    width: usize,
    out: &'a mut Vec<f64>,
}

impl Wide for ScalarProducts<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { rows, vectors, width, out } = self;
        for vector in vectors.chunks_exact(width) {
            out.extend(rows.chunks_exact(width).map(|row| dot(row, vector)));
        }
    }
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
