//! The columns of the harmonic fit and their sums.
//!
//! `y(t) = u_0 + u_1 s + sum_h a_h cos(h theta) + b_h sin(h theta)`, `theta = omega (t - t_mid)`, `s` from -1 to 1.
//!
//! All channels share the columns, hence one normal matrix. It needs no products of columns: products of two cosines
//! or sines are sums of harmonics up to 2H, so that `4 H + 2` plain sums and `2 H` sums with `s` fill it, at any time
//! steps. Columns are made block by block, small enough for the cache, by complex powers of one sine and cosine a
//! sample; every channel is multiplied with the block while it is there.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

/// Samples of a block: with 16 columns, half of a first-level cache.
const BLOCK: usize = 256;

/// Least share of a column that is not explained by those before it: less, and its coefficient has lost six of sixteen
/// digits. A record that holds a period is far from it unless most of the period is missing.
const LEAST_INDEPENDENCE: f64 = 1e-6;

/// The columns of a fit at the times of a record or a part of it.
#[derive(Debug)]
pub(super) struct Design<'a> {
    time: &'a [f64],
    harmonics: usize,
    /// Middle of the times, s.
    pub(super) middle: f64,
    /// Half of the duration, s.
    pub(super) half: f64,
    cosine: Vec<f64>,
    sine: Vec<f64>,
    /// Inverse of the normal matrix, (2H+2) x (2H+2): 1, s, cos 1, sin 1, cos 2, ...
    pub(super) inverse: Mat<f64>,
}

impl<'a> Design<'a> {
    /// Columns at increasing times for the circular frequency `omega`; `None` where they depend on each other.
    pub(super) fn new(time: &'a [f64], omega: f64, harmonics: usize) -> Option<Self> {
        let (first, last) = (*time.first()?, *time.last()?);
        let middle = first + 0.5 * (last - first);
        let half = 0.5 * (last - first);
        let (sine, cosine) = time.iter().map(|t| (omega * (t - middle)).sin_cos()).unzip();
        let mut design = Self { time, harmonics, middle, half, cosine, sine, inverse: Mat::new() };
        design.inverse = invert(&design.normal_matrix())?;
        Some(design)
    }

    /// Number of unknowns, 2H + 2.
    pub(super) fn unknowns(&self) -> usize {
        2 * self.harmonics + 2
    }

    /// Calls `work` with the range of each block and its columns `s, cos 1, sin 1, ...` up to harmonic `count`.
    fn blocks(&self, count: usize, mut work: impl FnMut(std::ops::Range<usize>, &[f64])) {
        let mut columns = vec![0.0; (2 * count + 1) * BLOCK];
        let n = self.time.len();
        for start in (0..n).step_by(BLOCK) {
            let range = start..(start + BLOCK).min(n);
            self.fill(&range, count, &mut columns);
            work(range, &columns);
        }
    }

    /// Writes the columns of a block, each `BLOCK` long.
    fn fill(&self, range: &std::ops::Range<usize>, count: usize, columns: &mut [f64]) {
        let length = range.len();
        let scale = 1.0 / self.half;
        let times = &self.time[range.clone()];
        for (s, t) in columns[..length].iter_mut().zip(times) {
            *s = (t - self.middle) * scale;
        }
        let (c1, s1) = (&self.cosine[range.clone()], &self.sine[range.clone()]);
        columns[BLOCK..BLOCK + length].copy_from_slice(c1);
        columns[2 * BLOCK..2 * BLOCK + length].copy_from_slice(s1);
        for h in 2..=count {
            let (before, after) = columns.split_at_mut((2 * h - 1) * BLOCK);
            let (pc, ps) = before[(2 * h - 3) * BLOCK..].split_at(BLOCK);
            let (c, s) = after.split_at_mut(BLOCK);
            for i in 0..length {
                c[i] = pc[i] * c1[i] - ps[i] * s1[i];
                s[i] = pc[i] * s1[i] + ps[i] * c1[i];
            }
        }
    }

    /// The normal matrix from sums of harmonics up to 2H.
    fn normal_matrix(&self) -> Mat<f64> {
        let h = self.harmonics;
        let mut cos = vec![0.0; 2 * h + 1];
        let mut sin = vec![0.0; 2 * h + 1];
        let (mut with_s, mut s, mut s_squared) = (vec![0.0; 2 * h], 0.0, 0.0);
        self.blocks(2 * h, |range, columns| {
            let column = |k: usize| &columns[k * BLOCK..k * BLOCK + range.len()];
            s += sum(column(0));
            s_squared += dot(column(0), column(0));
            for k in 1..=2 * h {
                cos[k] += sum(column(2 * k - 1));
                sin[k] += sum(column(2 * k));
            }
            for (k, total) in with_s.iter_mut().enumerate() {
                *total += dot(column(0), column(k + 1));
            }
        });
        cos[0] = self.time.len() as f64;
        Mat::from_fn(2 * h + 2, 2 * h + 2, |i, j| match (i.min(j), i.max(j)) {
            (0, 0) => cos[0],
            (0, 1) => s,
            (1, 1) => s_squared,
            (0, k) => {
                if k % 2 == 0 {
                    cos[k / 2]
                } else {
                    sin[k / 2]
                }
            }
            (1, k) => with_s[k - 2],
            (a, b) => product_sum(a, b, &cos, &sin),
        })
    }

    /// Products of every column with every channel, `(2H+2)` a channel.
    pub(super) fn products(&self, channels: &[&[f64]]) -> Vec<Vec<f64>> {
        let mut products = vec![vec![0.0; self.unknowns()]; channels.len()];
        self.blocks(self.harmonics, |range, columns| {
            for (channel, products) in channels.iter().zip(&mut products) {
                add_products(&channel[range.clone()], columns, products);
            }
        });
        products
    }

    /// What the unknowns of each channel leave of it, and the products of every column with that.
    pub(super) fn residuals(&self, channels: &[&[f64]], unknowns: &[Vec<f64>]) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let mut residuals: Vec<Vec<f64>> = channels.iter().map(|channel| channel.to_vec()).collect();
        let mut products = vec![vec![0.0; self.unknowns()]; channels.len()];
        self.blocks(self.harmonics, |range, columns| {
            for (c, products) in products.iter_mut().enumerate() {
                let residual = &mut residuals[c][range.clone()];
                subtract(residual, columns, &unknowns[c]);
                add_products(residual, columns, products);
            }
        });
        (residuals, products)
    }

    /// `-(t - t_mid) (columns * unknowns)`; the caller turns cosines into sines to make it a derivative.
    pub(super) fn times_moment(&self, unknowns: &[f64]) -> Vec<f64> {
        let mut values = vec![0.0; self.time.len()];
        self.blocks(self.harmonics, |range, columns| subtract(&mut values[range], columns, unknowns));
        for (value, t) in values.iter_mut().zip(self.time) {
            *value *= t - self.middle;
        }
        values
    }

    /// The solution for given products.
    pub(super) fn solve(&self, products: &[f64]) -> Vec<f64> {
        let p = self.unknowns();
        (0..p).map(|i| (0..p).map(|j| self.inverse[(i, j)] * products[j]).sum()).collect()
    }
}

/// `values -= columns * unknowns` over one block.
fn subtract(values: &mut [f64], columns: &[f64], unknowns: &[f64]) {
    for value in values.iter_mut() {
        *value -= unknowns[0];
    }
    for (k, &u) in unknowns[1..].iter().enumerate() {
        for (value, x) in values.iter_mut().zip(&columns[k * BLOCK..(k + 1) * BLOCK]) {
            *value -= u * x;
        }
    }
}

/// `products += columns^T values` over one block.
fn add_products(values: &[f64], columns: &[f64], products: &mut [f64]) {
    products[0] += sum(values);
    for (k, product) in products[1..].iter_mut().enumerate() {
        *product += dot(values, &columns[k * BLOCK..k * BLOCK + values.len()]);
    }
}

/// Sum of the product of two harmonic columns, by `2 cos i cos j = cos(i-j) + cos(i+j)` and its likes.
fn product_sum(a: usize, b: usize, cos: &[f64], sin: &[f64]) -> f64 {
    let (i, j) = (a / 2, b / 2);
    let (difference, total) = (i.abs_diff(j), i + j);
    match (a % 2, b % 2) {
        (0, 0) => 0.5 * (cos[difference] + cos[total]),
        (1, 1) => 0.5 * (cos[difference] - cos[total]),
        // sin x cos y = (sin(x+y) + sin(x-y)) / 2 where x belongs to the sine.
        (1, _) => 0.5 * (sin[total] + if i >= j { sin[difference] } else { -sin[difference] }),
        _ => 0.5 * (sin[total] + if j >= i { sin[difference] } else { -sin[difference] }),
    }
}

/// Inverse of a normal matrix, by Cholesky of it with unit diagonal; `None` where columns depend on each other.
fn invert(normal: &Mat<f64>) -> Option<Mat<f64>> {
    let p = normal.nrows();
    let scale: Vec<f64> = (0..p).map(|i| normal[(i, i)].sqrt()).collect();
    if scale.iter().any(|s| !(s.is_finite() && *s > 0.0)) {
        return None;
    }
    let unit = Mat::from_fn(p, p, |i, j| normal[(i, j)] / (scale[i] * scale[j]));
    let factor = unit.llt(Side::Lower).ok()?;
    if (0..p).any(|i| factor.L()[(i, i)].powi(2) < LEAST_INDEPENDENCE) {
        return None;
    }
    let inverse = factor.solve(Mat::<f64>::identity(p, p));
    Some(Mat::from_fn(p, p, |i, j| 0.5 * (inverse[(i, j)] + inverse[(j, i)]) / (scale[i] * scale[j])))
}

/// Sum in eight lanes, which the compiler turns into vector instructions.
fn sum(x: &[f64]) -> f64 {
    let chunks = x.chunks_exact(8);
    let rest: f64 = chunks.remainder().iter().sum();
    let mut lanes = [0.0; 8];
    for chunk in chunks {
        for (lane, value) in lanes.iter_mut().zip(chunk) {
            *lane += value;
        }
    }
    rest + lanes.iter().sum::<f64>()
}

/// Scalar product in eight lanes.
pub(super) fn dot(x: &[f64], y: &[f64]) -> f64 {
    let (xs, ys) = (x.chunks_exact(8), y.chunks_exact(8));
    let rest: f64 = xs.remainder().iter().zip(ys.remainder()).map(|(a, b)| a * b).sum();
    let mut lanes = [0.0; 8];
    for (a, b) in xs.zip(ys) {
        for i in 0..8 {
            lanes[i] += a[i] * b[i];
        }
    }
    rest + lanes.iter().sum::<f64>()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn the_normal_matrix_is_that_of_the_columns() {
        // Uneven times, several blocks, a block that is not full.
        let time: Vec<f64> = (0..700).map(|n| 3.0 + f64::from(n) * 0.01 + 0.004 * f64::from(n * n % 7)).collect();
        let (omega, harmonics) = (5.0, 3);
        let design = Design::new(&time, omega, harmonics).unwrap();
        let column = |t: f64, k: usize| match k {
            0 => 1.0,
            1 => (t - design.middle) / design.half,
            k if k % 2 == 0 => ((k / 2) as f64 * omega * (t - design.middle)).cos(),
            k => ((k / 2) as f64 * omega * (t - design.middle)).sin(),
        };
        let normal = design.normal_matrix();
        for i in 0..8 {
            for j in 0..8 {
                let slow: f64 = time.iter().map(|&t| column(t, i) * column(t, j)).sum();
                assert!((normal[(i, j)] - slow).abs() < 1e-10, "{i} {j}: {} {slow}", normal[(i, j)]);
            }
        }
        let product = &normal * &design.inverse;
        for i in 0..8 {
            for j in 0..8 {
                let expected = f64::from(u8::from(i == j));
                assert!((product[(i, j)] - expected).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn columns_that_depend_on_each_other_are_refused() {
        let time: Vec<f64> = (0..100).map(f64::from).collect();
        // The second harmonic at the Nyquist frequency has a sine that is zero at every sample.
        assert!(Design::new(&time, 0.5 * std::f64::consts::PI, 2).is_none());
    }
}
