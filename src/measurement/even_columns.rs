//! The columns of the harmonic fit at even time steps.
//!
//! About the middle of a block, cosines are even and sines odd, and all blocks have the same columns but for a turn:
//! `cos h(phi + theta) = cos h phi cos h theta - sin h phi sin h theta`. So the samples of a block are folded into sums
//! and differences about its middle, multiplied by half as many rows that stay in the cache, and turned. The sums of
//! the normal matrix are closed, with `x = k omega dt` and n samples about their middle:
//!
//! ```text
//! sum cos(k theta) = sin(n x/2) / sin(x/2) = D(x),    sum m sin(m x) = -D'(x),    sum m^2 = n (n^2 - 1) / 12
//! ```

use super::slope::Slope;
use super::sums::Sums;
use dashpot_numerics::{LANES, dot, sum};
use faer::c64;
use std::ops::Range;

/// Half of the samples of a block.
const HALF: usize = 128;

/// Samples of a block.
const BLOCK: usize = 2 * HALF;

/// Deviation from even steps, in roundings of the latest time, below which they are even: what computing or writing
/// `n dt` leaves.
const ROUNDINGS: f64 = 4.0;

/// Columns at even time steps.
#[derive(Debug)]
pub(super) struct EvenColumns {
    samples: usize,
    harmonics: usize,
    /// Phase of one step, rad.
    phase: f64,
    /// `cos(h theta)` at half a step, one and a half steps ... from a block's middle, one row a harmonic.
    cos: Vec<f64>,
    /// `sin(h theta)` there, below a first row of the distances in steps.
    sin: Vec<f64>,
    /// `exp(i h phi)` of the middle of every block, H a block.
    turns: Vec<c64>,
}

impl EvenColumns {
    /// Whether the times are even to rounding.
    pub(super) fn suit(time: &[f64]) -> bool {
        let n = time.len();
        if n < 2 {
            return false;
        }
        let (first, last) = (time[0], time[n - 1]);
        let step = (last - first) / (n - 1) as f64;
        let limit = ROUNDINGS * f64::EPSILON * first.abs().max(last.abs());
        step > 0.0 && time.iter().enumerate().all(|(i, t)| (t - (first + i as f64 * step)).abs() <= limit)
    }

    /// Columns at the given times.
    pub(super) fn new(time: &[f64], omega: f64, harmonics: usize) -> Self {
        let samples = time.len();
        let phase = omega * (time[samples - 1] - time[0]) / (samples - 1) as f64;
        let sin_cos = |h: usize, distance: f64| (h as f64 * phase * distance).sin_cos();
        let distance = |j: usize| j as f64 + 0.5;
        let mut columns = Self { samples, harmonics, phase, cos: Vec::new(), sin: Vec::new(), turns: Vec::new() };
        columns.sin.extend((0..HALF).map(distance));
        for h in 1..=harmonics {
            columns.cos.extend((0..HALF).map(|j| sin_cos(h, distance(j)).1));
            columns.sin.extend((0..HALF).map(|j| sin_cos(h, distance(j)).0));
        }
        for block in 0..samples.div_ceil(BLOCK) {
            let middle = columns.middle_of(block);
            columns.turns.extend((1..=harmonics).map(|h| sin_cos(h, middle)).map(|(sin, cos)| c64::new(cos, sin)));
        }
        columns
    }

    /// Distance of a block's middle from that of the record, steps.
    fn middle_of(&self, block: usize) -> f64 {
        (block * BLOCK + HALF) as f64 - 0.5 * self.samples as f64
    }

    /// `s` of one step.
    fn scale(&self) -> f64 {
        2.0 / (self.samples - 1) as f64
    }

    /// Sums over all samples.
    pub(super) fn sums(&self) -> Sums {
        let n = self.samples as f64;
        let mut sums = Sums::zero(self.harmonics);
        sums.s_squared = self.scale().powi(2) * n * (n * n - 1.0) / 12.0;
        sums.cos[0] = n;
        for k in 1..=2 * self.harmonics {
            let half = 0.5 * k as f64 * self.phase;
            let ((whole_sin, whole_cos), (sin, cos)) = ((n * half).sin_cos(), half.sin_cos());
            sums.cos[k] = whole_sin / sin;
            if k <= self.harmonics {
                sums.s_sin[k] = self.scale() * 0.5 * (whole_sin * cos - n * whole_cos * sin) / (sin * sin);
            }
        }
        sums
    }

    /// Calls `work` with every block's number and its range.
    fn blocks(&self) -> impl Iterator<Item = (usize, Range<usize>)> {
        let n = self.samples;
        (0..n.div_ceil(BLOCK)).map(move |block| (block, block * BLOCK..(block * BLOCK + BLOCK).min(n)))
    }

    /// Products of every column with every channel.
    pub(super) fn products(&self, channels: &[&[f64]]) -> Vec<Vec<f64>> {
        channels.iter().map(|channel| self.products_of(channel)).collect()
    }

    fn products_of(&self, channel: &[f64]) -> Vec<f64> {
        let mut products = vec![0.0; 2 * self.harmonics + 2];
        let mut filled = [0.0; BLOCK];
        for (block, range) in self.blocks() {
            let values = &channel[range];
            if values.len() == BLOCK {
                self.add_products(block, values, &mut products);
            } else {
                filled[..values.len()].copy_from_slice(values);
                self.add_products(block, &filled, &mut products);
            }
        }
        products
    }

    /// Adds a full block's products.
    fn add_products(&self, block: usize, values: &[f64], products: &mut [f64]) {
        let (mut sums, mut differences) = ([0.0; HALF], [0.0; HALF]);
        let (left, right) = values.split_at(HALF);
        for ((plus, minus), (l, r)) in sums.iter_mut().zip(&mut differences).zip(left.iter().rev().zip(right)) {
            *plus = r + l;
            *minus = r - l;
        }
        let total = sum(&sums);
        products[0] += total;
        products[1] += self.scale() * (self.middle_of(block) * total + dot(&differences, &self.sin[..HALF]));
        let turns = &self.turns[block * self.harmonics..(block + 1) * self.harmonics];
        for (h, turn) in turns.iter().enumerate() {
            let even = dot(&sums, &self.cos[h * HALF..(h + 1) * HALF]);
            let odd = dot(&differences, &self.sin[(h + 1) * HALF..(h + 2) * HALF]);
            products[2 * h + 2] += turn.re * even - turn.im * odd;
            products[2 * h + 3] += turn.im * even + turn.re * odd;
        }
    }

    /// Calls `work` with the range of each block and what the unknowns leave of the channel there.
    pub(super) fn each_residual(&self, channel: &[f64], unknowns: &[f64], mut work: impl FnMut(Range<usize>, &[f64])) {
        for (block, range) in self.blocks() {
            let mut left = self.fitted(block, unknowns);
            for (left, y) in left.iter_mut().zip(&channel[range.clone()]) {
                *left = y - *left;
            }
            let length = range.len();
            work(range, &left[..length]);
        }
    }

    /// What the unknowns leave of a channel beside the derivative of the fit, `-(t - middle) (columns * turn)`; times in s.
    pub(super) fn slope(&self, channel: &[f64], [unknowns, turn]: [&[f64]; 2], time: &[f64], middle: f64) -> Slope {
        let mut slope = Slope::zero(self.harmonics);
        let mut derivative = [0.0; BLOCK];
        for (block, range) in self.blocks() {
            let (fitted, turned) = (self.fitted(block, unknowns), self.fitted(block, turn));
            let mut left = fitted;
            for (left, y) in left.iter_mut().zip(&channel[range.clone()]) {
                *left = y - *left;
            }
            derivative.fill(0.0);
            for ((j, turned), t) in derivative.iter_mut().zip(&turned).zip(&time[range.clone()]) {
                *j = -turned * (t - middle);
            }
            slope.add(&left[..range.len()], &derivative[..range.len()]);
            self.add_products(block, &derivative, &mut slope.products);
        }
        slope
    }

    /// The fit over a block, in the order of its samples.
    fn fitted(&self, block: usize, unknowns: &[f64]) -> [f64; BLOCK] {
        let (even, odd) = self.halves(block, unknowns);
        let mut fitted = [0.0; BLOCK];
        let (left, right) = fitted.split_at_mut(HALF);
        for ((l, r), (e, o)) in left.iter_mut().rev().zip(right).zip(even.iter().zip(&odd)) {
            *l = e - o;
            *r = e + o;
        }
        fitted
    }

    /// Even and odd part of the fit about a block's middle.
    fn halves(&self, block: usize, unknowns: &[f64]) -> ([f64; HALF], [f64; HALF]) {
        let level = unknowns[0] + unknowns[1] * self.scale() * self.middle_of(block);
        let (mut even, mut odd) = ([level; HALF], [0.0; HALF]);
        add(&mut odd, unknowns[1] * self.scale(), &self.sin[..HALF]);
        let turns = &self.turns[block * self.harmonics..(block + 1) * self.harmonics];
        for (h, turn) in turns.iter().enumerate() {
            let (a, b) = (unknowns[2 * h + 2], unknowns[2 * h + 3]);
            add(&mut even, a * turn.re + b * turn.im, &self.cos[h * HALF..(h + 1) * HALF]);
            add(&mut odd, b * turn.re - a * turn.im, &self.sin[(h + 1) * HALF..(h + 2) * HALF]);
        }
        (even, odd)
    }
}

/// `values += factor * row`, in lanes.
fn add(values: &mut [f64; HALF], factor: f64, row: &[f64]) {
    for (values, row) in values.chunks_exact_mut(LANES).zip(row.chunks_exact(LANES)) {
        for i in 0..LANES {
            values[i] += factor * row[i];
        }
    }
}
