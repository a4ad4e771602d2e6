//! Many vectors side by side: a row holds one entry of all of them, so that what is done to every vector runs along rows, as a march
//! in time with many derivatives needs it at every step. Rows are [`stride`] long; what stands behind the vectors is padding.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the wide instructions")]

use crate::lanes::{Wide, widest};

/// Vectors that are treated at once.
const BLOCK: usize = 4;

/// Length of the rows of `count` vectors.
pub fn stride(count: usize) -> usize {
    count.next_multiple_of(BLOCK)
}

/// Multiplies complex vectors by `factor`: rows of the real parts, behind them those of the imaginary parts, each `stride` long; the factor
/// is laid out alike.
pub fn turn_rows(factor: &[f64], rows: &mut [f64], stride: usize) {
    widest(Turn { factor, rows, stride });
}

struct Turn<'a> {
    factor: &'a [f64],
    rows: &'a mut [f64],
    stride: usize,
}

impl Wide for Turn<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let half = self.factor.len() / 2;
        let (c, s) = self.factor.split_at(half);
        let (mut re, mut im) = self.rows.split_at_mut(half * self.stride);
        for (c, s) in c.iter().zip(s) {
            let (own, others) = re.split_at_mut(self.stride);
            let (own_im, others_im) = im.split_at_mut(self.stride);
            (re, im) = (others, others_im);
            for (re, im) in blocks(own).iter_mut().zip(blocks(own_im)) {
                for k in 0..BLOCK {
                    let (a, b) = (re[k], im[k]);
                    re[k] = c * a - s * b;
                    im[k] = s * a + c * b;
                }
            }
        }
    }
}

/// Scalar products of one vector with all: `out = sum_i weights_i row_i`.
pub fn combine_rows(weights: &[f64], rows: &[f64], out: &mut [f64]) {
    widest(Combine(weights, rows, out));
}

struct Combine<'a>(&'a [f64], &'a [f64], &'a mut [f64]);

impl Wide for Combine<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(weights, rows, out) = self;
        let stride = out.len();
        let pairs = weights.as_chunks::<2>();
        for (b, out) in blocks(out).iter_mut().enumerate() {
            // Two sums: each addition waits for the one before.
            let (mut even, mut odd) = ([0.0; BLOCK], [0.0; BLOCK]);
            let mut at = b * BLOCK;
            for w in pairs.0 {
                let (first, second) = (&rows[at..at + BLOCK], &rows[at + stride..at + stride + BLOCK]);
                for k in 0..BLOCK {
                    even[k] += w[0] * first[k];
                    odd[k] += w[1] * second[k];
                }
                at += 2 * stride;
            }
            for w in pairs.1 {
                let rest = &rows[at..at + BLOCK];
                for k in 0..BLOCK {
                    even[k] += w * rest[k];
                }
            }
            for k in 0..BLOCK {
                out[k] = even[k] + odd[k];
            }
        }
    }
}

/// Adds to every vector its own multiple of one: `row_i += weights_i multiples`.
pub fn add_to_rows(weights: &[f64], multiples: &[f64], rows: &mut [f64]) {
    widest(Add(weights, multiples, rows));
}

struct Add<'a>(&'a [f64], &'a [f64], &'a mut [f64]);

impl Wide for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(weights, multiples, mut rows) = self;
        for w in weights {
            let (own, others) = rows.split_at_mut(multiples.len());
            rows = others;
            for (row, m) in blocks(own).iter_mut().zip(multiples.as_chunks::<BLOCK>().0) {
                for k in 0..BLOCK {
                    row[k] += w * m[k];
                }
            }
        }
    }
}

/// Adds a product to the first vectors: `row_i += sum_j A_ij x_j`, where `A_ij` is `columns` long, those of row 0 first. `columns` is a
/// [`stride`].
pub fn add_product_to_rows(matrix: &[f64], x: &[f64], columns: usize, rows: &mut [f64], stride: usize) {
    if columns > 0 {
        widest(AddProduct { matrix, x, columns, rows, stride });
    }
}

struct AddProduct<'a> {
    matrix: &'a [f64],
    x: &'a [f64],
    columns: usize,
    rows: &'a mut [f64],
    stride: usize,
}

impl Wide for AddProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { mut matrix, x, columns, mut rows, stride } = self;
        let size = columns * x.len();
        while rows.len() >= stride && matrix.len() >= size {
            let (row, others) = rows.split_at_mut(stride);
            let (own, behind) = matrix.split_at(size);
            // Two blocks at once: each addition waits for the one before.
            let (wide, narrow) = row[..columns].as_chunks_mut::<{ 2 * BLOCK }>();
            let mut at = 0;
            for row in wide {
                add_block(row, &own[at..], x, columns);
                at += 2 * BLOCK;
            }
            for row in blocks(narrow) {
                add_block(row, &own[at..], x, columns);
                at += BLOCK;
            }
            (rows, matrix) = (others, behind);
        }
    }
}

/// `row += sum_j x_j m_j` with blocks `m_j` that begin `columns` behind each other.
#[inline(always)]
fn add_block<const N: usize>(row: &mut [f64; N], matrix: &[f64], x: &[f64], columns: usize) {
    let mut sum = *row;
    let mut at = 0;
    for x in x {
        let entry = &matrix[at..at + N];
        for k in 0..N {
            sum[k] += entry[k] * x;
        }
        at += columns;
    }
    *row = sum;
}

#[inline(always)]
fn blocks(row: &mut [f64]) -> &mut [[f64; BLOCK]] {
    row.as_chunks_mut::<BLOCK>().0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entry `i` of vector `v`.
    fn entry(i: usize, v: usize) -> f64 {
        ((3 * i + 7 * v) as f64 * 0.37).sin()
    }

    fn rows(width: usize, count: usize) -> Vec<f64> {
        let stride = stride(count);
        (0..width * stride).map(|k| if k % stride < count { entry(k / stride, k % stride) } else { 0.0 }).collect()
    }

    #[test]
    fn rows_do_what_is_done_to_each_vector() {
        for (half, count) in [(1, 1), (3, 4), (5, 7), (8, 38)] {
            let (width, stride) = (2 * half, stride(count));
            let weights: Vec<f64> = (0..width).map(|i| (i as f64 * 1.3).cos()).collect();
            let start = rows(width, count);
            let mut seen = vec![0.0; stride];
            combine_rows(&weights, &start, &mut seen);
            let mut turned = start.clone();
            turn_rows(&weights, &mut turned, stride);
            let mut added = start.clone();
            add_to_rows(&weights, &seen, &mut added);
            for v in 0..count {
                let own: Vec<f64> = (0..width).map(|i| entry(i, v)).collect();
                assert!((seen[v] - crate::dot(&weights, &own)).abs() < 1e-14);
                let mut vector = own.clone();
                crate::turn(&weights, &mut vector);
                for i in 0..width {
                    assert!((turned[i * stride + v] - vector[i]).abs() < 1e-15);
                    assert!((added[i * stride + v] - own[i] - weights[i] * seen[v]).abs() < 1e-14);
                }
            }
        }
    }

    #[test]
    fn products_reach_the_first_vectors() {
        let (width, count, inputs) = (3, 13, 5);
        let (stride, columns) = (stride(count), 12);
        let matrix: Vec<f64> = (0..width * inputs * columns).map(|k| (k as f64 * 0.7).sin()).collect();
        let x: Vec<f64> = (0..inputs).map(|j| j as f64 - 1.5).collect();
        let mut sum = rows(width, count);
        add_product_to_rows(&matrix, &x, columns, &mut sum, stride);
        for i in 0..width {
            for v in 0..count {
                let more: f64 = (0..inputs)
                    .map(|j| if v < columns { matrix[(i * inputs + j) * columns + v] * x[j] } else { 0.0 })
                    .sum();
                assert!((sum[i * stride + v] - entry(i, v) - more).abs() < 1e-14);
            }
        }
    }
}
