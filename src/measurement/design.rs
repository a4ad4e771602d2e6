//! The columns of the harmonic fit, their normal matrix and their products with channels.
//!
//! `y(t) = u_0 + u_1 s + sum_h a_h cos(h theta) + b_h sin(h theta)`, `theta = omega (t - t_mid)`, `s` from -1 to 1.
//!
//! All channels share the columns, hence one normal matrix. It needs no products of columns: products of two cosines
//! or sines are sums of harmonics up to 2H, so that `4 H + 2` plain sums and `4 H` sums with `s` fill it, at any time
//! steps. At even steps the sums have closed forms and the columns symmetries (`even_columns.rs`); at any others they
//! are made block by block (`any_columns.rs`).

use super::any_columns::AnyColumns;
use super::even_columns::EvenColumns;
use super::slope::Slope;
use super::sums::Sums;
use dashpot_numerics::EquilibratedCholesky;
use faer::Mat;
use std::ops::Range;

/// Least share of a column that is not explained by those before it: less, and its coefficient has lost six of sixteen
/// digits. A record that holds a period is far from it unless most of the period is missing.
const LEAST_INDEPENDENCE: f64 = 1e-6;

/// How the columns are made.
#[derive(Debug)]
enum Columns<'a> {
    Even(EvenColumns),
    Any(AnyColumns<'a>),
}

/// The columns of a fit at the times of a record or a part of it.
#[derive(Debug)]
pub(super) struct Design<'a> {
    time: &'a [f64],
    harmonics: usize,
    columns: Columns<'a>,
    /// Middle of the times, s.
    pub(super) middle: f64,
    /// Half of the duration, s.
    pub(super) half: f64,
    /// Inverse of the normal matrix, (2H+2) x (2H+2): 1, s, cos 1, sin 1, cos 2, ...
    pub(super) inverse: Mat<f64>,
    /// Least share of a column that is not explained by those before it.
    pub(super) independence: f64,
}

impl<'a> Design<'a> {
    /// Columns at increasing times for the circular frequency `omega`; `None` where they depend on each other.
    pub(super) fn new(time: &'a [f64], omega: f64, harmonics: usize) -> Option<Self> {
        let columns = if EvenColumns::suit(time) {
            Columns::Even(EvenColumns::new(time, omega, harmonics))
        } else {
            Columns::Any(AnyColumns::new(time, omega, harmonics))
        };
        Self::with(time, harmonics, columns)
    }

    fn with(time: &'a [f64], harmonics: usize, columns: Columns<'a>) -> Option<Self> {
        let (first, last) = (*time.first()?, *time.last()?);
        let half = 0.5 * (last - first);
        let sums = match &columns {
            Columns::Even(columns) => columns.sums(),
            Columns::Any(columns) => columns.sums(),
        };
        let (inverse, independence) = invert(&normal_matrix(harmonics, &sums))?;
        Some(Self { time, harmonics, columns, middle: first + half, half, inverse, independence })
    }

    /// Number of unknowns, 2H + 2.
    pub(super) fn unknowns(&self) -> usize {
        2 * self.harmonics + 2
    }

    /// Products of every column with every channel, `(2H+2)` a channel.
    pub(super) fn products(&self, channels: &[&[f64]]) -> Vec<Vec<f64>> {
        match &self.columns {
            Columns::Even(columns) => columns.products(channels),
            Columns::Any(columns) => columns.products(channels),
        }
    }

    /// Calls `work` with the range of each block of samples and what the unknowns leave of the channel there.
    pub(super) fn each_residual(&self, channel: &[f64], unknowns: &[f64], work: impl FnMut(Range<usize>, &[f64])) {
        match &self.columns {
            Columns::Even(columns) => columns.each_residual(channel, unknowns, work),
            Columns::Any(columns) => columns.each_residual(channel, unknowns, work),
        }
    }

    /// What the unknowns leave of a channel.
    pub(super) fn residual(&self, channel: &[f64], unknowns: &[f64]) -> Vec<f64> {
        let mut residual = Vec::with_capacity(channel.len());
        self.each_residual(channel, unknowns, |_, left| residual.extend_from_slice(left));
        residual
    }

    /// What unknowns leave of a channel beside the derivative of a fit with the unknowns `of` by the frequency.
    pub(super) fn slope(&self, channel: &[f64], unknowns: &[f64], of: &[f64]) -> Slope {
        let mut turn = vec![0.0; of.len()];
        for h in 1..of.len() / 2 {
            turn[2 * h] = -(h as f64) * of[2 * h + 1];
            turn[2 * h + 1] = h as f64 * of[2 * h];
        }
        match &self.columns {
            Columns::Even(columns) => columns.slope(channel, [unknowns, &turn], self.time, self.middle),
            Columns::Any(columns) => columns.slope(channel, [unknowns, &turn]),
        }
    }

    /// The solution for given products.
    pub(super) fn solve(&self, products: &[f64]) -> Vec<f64> {
        let p = self.unknowns();
        (0..p).map(|i| (0..p).map(|j| self.inverse[(i, j)] * products[j]).sum()).collect()
    }
}

/// The normal matrix of columns with these sums.
fn normal_matrix(harmonics: usize, sums: &Sums) -> Mat<f64> {
    let p = 2 * harmonics + 2;
    Mat::from_fn(p, p, |i, j| match (i.min(j), i.max(j)) {
        (0, 0) => sums.cos[0],
        (0, 1) => sums.s,
        (1, 1) => sums.s_squared,
        (0, k) if k % 2 == 0 => sums.cos[k / 2],
        (0, k) => sums.sin[k / 2],
        (1, k) if k % 2 == 0 => sums.s_cos[k / 2],
        (1, k) => sums.s_sin[k / 2],
        (a, b) => product_sum(a, b, &sums.cos, &sums.sin),
    })
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

/// Inverse of a normal matrix, and the least share of a column that those before it do not explain; `None` where columns depend on each other.
fn invert(normal: &Mat<f64>) -> Option<(Mat<f64>, f64)> {
    let factor = EquilibratedCholesky::new(normal.as_ref(), 0.0)?;
    let independence = factor.independence();
    (independence >= LEAST_INDEPENDENCE).then(|| (factor.inverse(), independence))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    /// The columns written out.
    fn column(design: &Design<'_>, omega: f64, t: f64, k: usize) -> f64 {
        let theta = (k / 2) as f64 * omega * (t - design.middle);
        match k {
            0 => 1.0,
            1 => (t - design.middle) / design.half,
            k if k % 2 == 0 => theta.cos(),
            _ => theta.sin(),
        }
    }

    /// Several blocks, the last not full; even and uneven times that start late.
    fn designs(run: impl Fn(&[f64], Design<'_>, f64)) {
        let omega = 5.0;
        let even: Vec<f64> = (0..700).map(|n| 3.0 + f64::from(n) / 128.0).collect();
        let uneven: Vec<f64> = (0..700).map(|n| 3.0 + f64::from(n) * 0.01 + 0.004 * f64::from(n * n % 7)).collect();
        run(&even, Design::new(&even, omega, 3).unwrap(), omega);
        run(&uneven, Design::new(&uneven, omega, 3).unwrap(), omega);
        let slow = Columns::Any(AnyColumns::new(&even, omega, 3));
        run(&even, Design::with(&even, 3, slow).unwrap(), omega);
    }

    #[test]
    fn the_inverse_is_that_of_the_columns() {
        designs(|time, design, omega| {
            for i in 0..8 {
                for j in 0..8 {
                    let entry = |k: usize| -> f64 {
                        let products =
                            time.iter().map(|&t| column(&design, omega, t, i) * column(&design, omega, t, k));
                        products.sum::<f64>() * design.inverse[(k, j)]
                    };
                    let product: f64 = (0..8).map(entry).sum();
                    let expected = f64::from(u8::from(i == j));
                    assert!((product - expected).abs() < 1e-12, "{i} {j}: {product}");
                }
            }
        });
    }

    #[test]
    fn products_and_residuals_are_those_of_the_columns() {
        designs(|time, design, omega| {
            let values: Vec<f64> = time.iter().map(|t| (t * t * 3.0).sin() + t).collect();
            let products = design.products(&[&values]);
            let unknowns: Vec<f64> = (0..8).map(|k| 0.3 + f64::from(k)).collect();
            let residuals = [design.residual(&values, &unknowns)];
            for k in 0..8 {
                let slow: f64 = time.iter().zip(&values).map(|(&t, y)| column(&design, omega, t, k) * y).sum();
                assert!((products[0][k] - slow).abs() < 1e-10, "{k}: {} {slow}", products[0][k]);
            }
            for (n, (&t, y)) in time.iter().zip(&values).enumerate() {
                let slow: f64 = y - (0..8).map(|k| unknowns[k] * column(&design, omega, t, k)).sum::<f64>();
                assert!((residuals[0][n] - slow).abs() < 1e-11, "{n}: {} {slow}", residuals[0][n]);
            }
        });
    }

    #[test]
    fn the_slope_is_that_of_the_columns() {
        designs(|time, design, omega| {
            let values: Vec<f64> = time.iter().map(|t| (t * t * 3.0).sin() + t).collect();
            let unknowns: Vec<f64> = (0..8).map(|k| 0.3 + f64::from(k)).collect();
            let slope = design.slope(&values, &unknowns, &unknowns);
            let residual = design.residual(&values, &unknowns);
            // d/d omega of a cos(h theta) + b sin(h theta), written out.
            let derivative: Vec<f64> = time
                .iter()
                .map(|&t| {
                    let column_of = |k: usize| column(&design, omega, t, k);
                    let each = |h: usize| {
                        h as f64 * (unknowns[2 * h + 1] * column_of(2 * h) - unknowns[2 * h] * column_of(2 * h + 1))
                    };
                    (t - design.middle) * (1..4).map(each).sum::<f64>()
                })
                .collect();
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
            near(slope.squares, dot(&residual, &residual));
            near(slope.along, dot(&derivative, &residual));
            near(slope.length, dot(&derivative, &derivative));
            for k in 0..8 {
                let slow: f64 = time.iter().zip(&derivative).map(|(&t, j)| column(&design, omega, t, k) * j).sum();
                assert!((slope.products[k] - slow).abs() < 1e-9, "{k}: {} {slow}", slope.products[k]);
            }
        });
    }

    #[test]
    fn columns_that_depend_on_each_other_are_refused() {
        let time: Vec<f64> = (0..100).map(f64::from).collect();
        // The second harmonic at the Nyquist frequency has a sine that is zero at every sample.
        assert!(Design::new(&time, 0.5 * std::f64::consts::PI, 2).is_none());
        let uneven: Vec<f64> = (0..100).map(|n| f64::from(n) + if n > 50 { 4.0 } else { 0.0 }).collect();
        assert!(Design::new(&uneven, 0.5 * std::f64::consts::PI, 2).is_none());
    }
}
