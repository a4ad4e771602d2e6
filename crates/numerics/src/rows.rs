//! Many vectors side by side: a row holds one entry of all of them, so that what is done to every vector runs along rows, as a march
//! in time with many derivatives needs it at every step. Rows are [`stride`] long; what stands behind the vectors is padding.

use pulp::Arch;

/// Vectors that are treated at once.
const BLOCK: usize = 4;

/// Length of the rows of `count` vectors.
pub fn stride(count: usize) -> usize {
    count.next_multiple_of(BLOCK)
}

/// Multiplies complex vectors by `factor`: rows of the real parts, behind them those of the imaginary parts; the factor is laid out alike.
pub fn turn_rows(factor: &[f64], rows: &mut [f64]) {
    let half = factor.len() / 2;
    if half == 0 || rows.is_empty() {
        return;
    }
    let (c, s) = factor.split_at(half);
    let (re, im) = rows.split_at_mut(rows.len() / 2);
    let stride = re.len() / half;
    Arch::new().dispatch(|| {
        let pairs = re.chunks_exact_mut(stride).zip(im.chunks_exact_mut(stride));
        for ((re, im), (c, s)) in pairs.zip(c.iter().zip(s)) {
            for (re, im) in re.iter_mut().zip(im) {
                let (a, b) = (*re, *im);
                *re = c * a - s * b;
                *im = s * a + c * b;
            }
        }
    });
}

/// Scalar products of one vector with all: `out = sum_i weights_i row_i`.
pub fn combine_rows(weights: &[f64], rows: &[f64], out: &mut [f64]) {
    let stride = out.len();
    if stride == 0 {
        return;
    }
    Arch::new().dispatch(|| {
        for (b, out) in out.as_chunks_mut::<BLOCK>().0.iter_mut().enumerate() {
            // Two sums: each addition waits for the one before.
            let mut sums = [[0.0; BLOCK]; 2];
            for (i, (w, row)) in weights.iter().zip(rows.chunks_exact(stride)).enumerate() {
                let Some(row) = row[b * BLOCK..].first_chunk::<BLOCK>() else { break };
                for (sum, x) in sums[i % 2].iter_mut().zip(row) {
                    *sum += w * x;
                }
            }
            *out = std::array::from_fn(|k| sums[0][k] + sums[1][k]);
        }
    });
}

/// Adds to every vector its own multiple of one: `row_i += weights_i multiples`.
pub fn add_to_rows(weights: &[f64], multiples: &[f64], rows: &mut [f64]) {
    let stride = multiples.len();
    if stride == 0 {
        return;
    }
    Arch::new().dispatch(|| {
        for (w, row) in weights.iter().zip(rows.chunks_exact_mut(stride)) {
            for (row, m) in row.iter_mut().zip(multiples) {
                *row += w * m;
            }
        }
    });
}

/// Adds a product to the first vectors: `row_i += sum_j A_ij x_j`, where `A_ij` is `columns` long, those of row 0 first. `columns` is a
/// [`stride`].
pub fn add_product_to_rows(matrix: &[f64], x: &[f64], columns: usize, rows: &mut [f64], stride: usize) {
    if columns == 0 || x.is_empty() {
        return;
    }
    Arch::new().dispatch(|| {
        for (row, matrix) in rows.chunks_exact_mut(stride).zip(matrix.chunks_exact(columns * x.len())) {
            for (b, row) in row[..columns].as_chunks_mut::<BLOCK>().0.iter_mut().enumerate() {
                let mut sum = *row;
                for (x, entry) in x.iter().zip(matrix.chunks_exact(columns)) {
                    let Some(entry) = entry[b * BLOCK..].first_chunk::<BLOCK>() else { break };
                    for (sum, a) in sum.iter_mut().zip(entry) {
                        *sum += a * x;
                    }
                }
                *row = sum;
            }
        }
    });
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
            turn_rows(&weights, &mut turned);
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
        let (width, count, inputs) = (3, 9, 5);
        let (stride, columns) = (stride(count), 4);
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
