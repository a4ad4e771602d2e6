//! The columns of the harmonic fit at any times.
//!
//! They are made block by block, small enough for the cache, by complex powers of one sine and cosine a sample; every
//! channel is multiplied with the block while it is there.

use super::slope::Slope;
use super::sums::Sums;
use dashpot_numerics::{dot, sum};
use std::ops::Range;

/// Samples of a block: with 16 columns, half of a first-level cache.
const BLOCK: usize = 256;

/// Columns at any times.
#[derive(Debug)]
pub(super) struct AnyColumns<'a> {
    time: &'a [f64],
    harmonics: usize,
    middle: f64,
    half: f64,
    cosine: Vec<f64>,
    sine: Vec<f64>,
}

impl<'a> AnyColumns<'a> {
    /// Columns at the given times.
    pub(super) fn new(time: &'a [f64], omega: f64, harmonics: usize) -> Self {
        let (first, last) = (time[0], time[time.len() - 1]);
        let half = 0.5 * (last - first);
        let middle = first + half;
        let (sine, cosine) = time.iter().map(|t| (omega * (t - middle)).sin_cos()).unzip();
        Self { time, harmonics, middle, half, cosine, sine }
    }

    /// Calls `work` with the range of each block and its columns `s, cos 1, sin 1, ...` up to harmonic `count`.
    fn blocks(&self, count: usize, mut work: impl FnMut(Range<usize>, &[f64])) {
        let mut columns = vec![0.0; (2 * count + 1) * BLOCK];
        let n = self.time.len();
        for start in (0..n).step_by(BLOCK) {
            let range = start..(start + BLOCK).min(n);
            self.fill(&range, count, &mut columns);
            work(range, &columns);
        }
    }

    /// Writes the columns of a block, each `BLOCK` long.
    fn fill(&self, range: &Range<usize>, count: usize, columns: &mut [f64]) {
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

    /// Sums over all samples.
    pub(super) fn sums(&self) -> Sums {
        let mut sums = Sums::zero(self.harmonics);
        self.blocks(2 * self.harmonics, |range, columns| {
            let column = |k: usize| &columns[k * BLOCK..k * BLOCK + range.len()];
            sums.s += sum(column(0));
            sums.s_squared += dot(column(0), column(0));
            for k in 1..=2 * self.harmonics {
                sums.cos[k] += sum(column(2 * k - 1));
                sums.sin[k] += sum(column(2 * k));
            }
            for k in 1..=self.harmonics {
                sums.s_cos[k] += dot(column(0), column(2 * k - 1));
                sums.s_sin[k] += dot(column(0), column(2 * k));
            }
        });
        sums.cos[0] = self.time.len() as f64;
        sums
    }

    /// Products of every column with every channel.
    pub(super) fn products(&self, channels: &[&[f64]]) -> Vec<Vec<f64>> {
        let mut products = vec![vec![0.0; 2 * self.harmonics + 2]; channels.len()];
        self.blocks(self.harmonics, |range, columns| {
            for (channel, products) in channels.iter().zip(&mut products) {
                add_products(&channel[range.clone()], columns, products);
            }
        });
        products
    }

    /// Calls `work` with the range of each block and what the unknowns leave of the channel there.
    pub(super) fn each_residual(&self, channel: &[f64], unknowns: &[f64], mut work: impl FnMut(Range<usize>, &[f64])) {
        let mut left = Vec::with_capacity(BLOCK);
        self.blocks(self.harmonics, |range, columns| {
            left.clear();
            left.extend_from_slice(&channel[range.clone()]);
            subtract(&mut left, columns, unknowns);
            work(range, &left);
        });
    }

    /// What the unknowns leave of a channel beside the derivative of the fit, `-(t - middle) (columns * turn)`; times in s.
    pub(super) fn slope(&self, channel: &[f64], [unknowns, turn]: [&[f64]; 2]) -> Slope {
        let mut slope = Slope::zero(self.harmonics);
        self.blocks(self.harmonics, |range, columns| {
            let mut left = channel[range.clone()].to_vec();
            subtract(&mut left, columns, unknowns);
            let mut derivative = vec![0.0; range.len()];
            subtract(&mut derivative, columns, turn);
            for (j, t) in derivative.iter_mut().zip(&self.time[range]) {
                *j *= t - self.middle;
            }
            slope.add(&left, &derivative);
            add_products(&derivative, columns, &mut slope.products);
        });
        slope
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
