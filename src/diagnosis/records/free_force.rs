//! One free force at a place over a whole record, line by line of its spectrum, and the motion there: what
//! [`super::localisation`] projects out, estimated.
//!
//! ```text
//! R_k = a_k G_k + E_k s + noise,      G_k ~ N(0, P_k)
//! G_k = V_k / 2 a_k^H (R_k - E_k s),  V_k = 1 / (|a_k|^2 / 2 + 1 / P_k)
//! P_k = mean over neighbours, weighted by what they are told by, 1 - V_k / P_k, of |G_k|^2 + V_k
//! ```
//!
//! Lines are whitened, real and imaginary parts of a deviation of 1 each. The size `P_k` that a force has there is found with it
//! (expectation and maximisation: Dempster, Laird and Rubin 1977): where the sensors do not see it, nothing is drawn.

use super::data::{RecordData, Records};
use super::localisation::{Expansion, Line, RIDGE, Spectra};
use crate::effects::Leg;
use crate::measurement::Quantity;
use dashpot_numerics::{EquilibratedCholesky, RealTransform};
use faer::{Mat, c64};
use std::f64::consts::TAU;

/// Highest line, over the highest frequency of the motion and over the sampling rate.
const HIGHEST: [f64; 2] = [3.3, 0.25];
/// Most lines.
const MOST_LINES: usize = 6000;
/// Lowest line over the lowest natural frequency where no sensor shows displacements: below it a force is told from the ends of the
/// record by nothing.
const LOWEST: f64 = 0.5;
/// Rounds of estimation, and lines on either side over which the size of the force is averaged, as a share of all.
const ROUNDS: usize = 6;
const NEIGHBOURS: f64 = 0.02;
/// Weight of the mean over all lines beside that of the neighbours: that of one line that is told well.
const ONE_LINE: f64 = 1.0;

/// The force at a place over a record, with the motion there, at its samples but the last.
pub(super) struct FreeForce {
    /// Force on the surroundings of the place, N, without its mean; of acceleration and velocity without what is slower than the modes.
    pub force: Vec<f64>,
    /// Displacement (m), velocity (m/s) and acceleration (m/s^2) along the place, of the same lines.
    pub motion: [Vec<f64>; 3],
    /// Standard deviation of a sample of the force, N.
    pub deviation: f64,
    /// Numbers of its first and last line.
    pub lines: [usize; 2],
}

/// Lines of a record with a place.
struct AtPlace<'a> {
    lines: Vec<Line>,
    /// What a unit of force does to the channels.
    under: Vec<Vec<c64>>,
    /// `|a_k|^2`.
    squares: Vec<f64>,
    /// Number of the first.
    first: usize,
    record: &'a RecordData,
    unknowns: usize,
}

impl FreeForce {
    /// Of a record, whose known sources are linear, along `leg`; `None` where it is too short.
    pub(super) fn new(records: &Records, record: &RecordData, leg: Leg) -> Option<Self> {
        let expansion = Expansion::new(records, 0.0);
        let length = record.step * (record.len() - 1) as f64;
        let highest = (HIGHEST[0] * record.highest_hz * length).min(HIGHEST[1] * (record.len() - 1) as f64) as usize;
        let slow = record.channels.iter().any(|c| c.quantity == Quantity::Displacement);
        let lowest = records.modes.omega.iter().copied().find(|w| *w > 0.0).unwrap_or(0.0);
        let first = if slow { 1 } else { ((LOWEST * lowest / TAU * length) as usize).max(1) };
        let numbers: Vec<usize> = (first..=highest.min(first + MOST_LINES)).collect();
        let unknowns = 2 * records.kept;
        if numbers.len() < 2 * unknowns {
            return None;
        }
        let pattern = expansion.pattern(leg);
        let spectra = Spectra::new(record);
        let lines = expansion.lines_of(records, record, &spectra, &numbers);
        let under: Vec<Vec<c64>> = lines.iter().map(|line| line.under(&pattern)).collect();
        let squares = under.iter().map(|a| a.iter().map(c64::norm_sqr).sum()).collect();
        let place = AtPlace { lines, under, squares, first, record, unknowns };
        let (forces, variances, ends) = place.estimated()?;
        let motion = place.motion(&expansion, &spectra, &pattern, &forces, &ends);
        let against: Vec<c64> = forces.iter().map(|g| -g).collect();
        let force = over_time(&against, first, record);
        let deviation = (2.0 * variances.iter().sum::<f64>()).sqrt() / length;
        Some(Self { force, motion, deviation, lines: [first, first + numbers.len() - 1] })
    }
}

impl AtPlace<'_> {
    /// Force and its variance on every line, and the differences between the ends of the record.
    fn estimated(&self) -> Option<(Vec<c64>, Vec<f64>, Vec<f64>)> {
        let total = |term: &dyn Fn(usize) -> f64| (0..self.lines.len()).map(term).sum::<f64>();
        let all = total(&|k| self.lines[k].measured.iter().map(c64::norm_sqr).sum()) / total(&|k| self.squares[k]);
        if !(all.is_finite() && all > 0.0) {
            return None;
        }
        let mut sizes = vec![all; self.lines.len()];
        let mut found = None;
        for _ in 0..ROUNDS {
            let variances: Vec<f64> =
                sizes.iter().zip(&self.squares).map(|(p, a)| (0.5 * a + p.recip()).recip()).collect();
            let ends = self.ends(&variances)?;
            let forces: Vec<c64> = (0..self.lines.len()).map(|k| self.force(k, variances[k], &ends)).collect();
            let seen: Vec<f64> = forces.iter().zip(&variances).map(|(g, v)| g.norm_sqr() + v).collect();
            let told: Vec<f64> = variances.iter().zip(&sizes).map(|(v, p)| (1.0 - v / p).max(0.0)).collect();
            sizes = averaged(&seen, &told);
            found = Some((forces, variances, ends));
        }
        found
    }

    /// Force on line `k` for these differences between the ends.
    fn force(&self, k: usize, variance: f64, ends: &[f64]) -> c64 {
        let line = &self.lines[k];
        let left = |c: usize| line.measured[c] - line.ends.iter().zip(ends).map(|(e, s)| e[c] * *s).sum::<c64>();
        (0..line.measured.len()).map(|c| self.under[k][c].conj() * left(c)).sum::<c64>() * (0.5 * variance)
    }

    /// Differences between the ends of the record that are likeliest, forces of all sizes being likely as they are.
    fn ends(&self, variances: &[f64]) -> Option<Vec<f64>> {
        let count = self.unknowns;
        let (mut matrix, mut against) = (Mat::<f64>::zeros(count, count), vec![0.0; count]);
        for (k, line) in self.lines.iter().enumerate() {
            let beside = |x: &[c64]| -> Vec<c64> {
                let a = &self.under[k];
                let share = a.iter().zip(x).map(|(a, x)| a.conj() * x).sum::<c64>() * (0.5 * variances[k]);
                x.iter().zip(a).map(|(x, a)| x - a * share).collect()
            };
            let inner = |a: &[c64], b: &[c64]| a.iter().zip(b).map(|(a, b)| (a.conj() * b).re).sum::<f64>();
            let measured = beside(&line.measured);
            for (i, own) in line.ends.iter().enumerate() {
                against[i] += inner(own, &measured);
                let own = beside(own);
                for (j, other) in line.ends.iter().enumerate().take(i + 1) {
                    let product = inner(&own, other);
                    matrix[(i, j)] += product;
                    if i != j {
                        matrix[(j, i)] += product;
                    }
                }
            }
        }
        Some(EquilibratedCholesky::new(matrix.as_ref(), RIDGE)?.solve(&against))
    }

    /// Displacement, velocity and acceleration along the place.
    fn motion(
        &self,
        expansion: &Expansion,
        spectra: &Spectra,
        pattern: &[f64],
        forces: &[c64],
        ends: &[f64],
    ) -> [Vec<f64>; 3] {
        let record = self.record;
        let (length, size) = (record.step * (record.len() - 1) as f64, pattern.len());
        let column = Mat::from_fn(size, 1, |r, _| c64::new(pattern[r], 0.0));
        let drives: Vec<Vec<f64>> =
            record.drives.iter().map(|&dof| expansion.pattern(Leg { first: dof, second: None })).collect();
        let kept = self.unknowns / 2;
        let difference = |from: usize| (0..kept).map(|r| pattern[r] * ends[from + r]).sum::<f64>();
        let [moved, sped] = [0, kept].map(difference).map(|x| c64::new(x, 0.0));
        let mut orders: [Vec<c64>; 3] = Default::default();
        for (k, force) in forces.iter().enumerate() {
            let w = TAU * (self.first + k) as f64 / length;
            let known = expansion.sources(w);
            let h = expansion.receptance(w, &known, &column);
            let along = |modal: &dyn Fn(usize) -> c64| (0..size).map(|r| h[(r, 0)] * modal(r)).sum::<c64>();
            let driven =
                |r: usize| drives.iter().zip(&spectra.forces).map(|(b, u)| u[self.first + k] * b[r]).sum::<c64>();
            let mut d = along(&driven) + along(&|r| c64::new(pattern[r], 0.0)) * *force;
            for (j, s) in ends.iter().enumerate() {
                let push = expansion.end_push(w, &known, j % kept, j >= kept);
                d -= along(&|r| push[r]) * *s;
            }
            let v = c64::new(0.0, w) * d + moved;
            let a = c64::new(0.0, w) * v + sped;
            orders.iter_mut().zip([d, v, a]).for_each(|(list, x)| list.push(x));
        }
        let mut lists = orders.iter().map(|lines| over_time(lines, self.first, record));
        std::array::from_fn(|_| lists.next().unwrap_or_default())
    }
}

/// Samples of what has the Fourier integral `lines` from line `first` on, over a record without its last sample.
fn over_time(lines: &[c64], first: usize, record: &RecordData) -> Vec<f64> {
    let count = record.len() - 1;
    let length = record.step * count as f64;
    let mut all = vec![c64::new(0.0, 0.0); count / 2 + 1];
    all.iter_mut().skip(first).zip(lines).for_each(|(to, line)| *to = line / length);
    let mut samples = vec![0.0; count];
    RealTransform::new(count).backward(&mut all, &mut samples);
    samples
}

/// Means over neighbours with these weights; neighbours of hardly any weight have the mean of all.
fn averaged(list: &[f64], weights: &[f64]) -> Vec<f64> {
    let half = ((NEIGHBOURS * list.len() as f64) as usize).max(2);
    let sum = |range: std::ops::Range<usize>| {
        let own = list[range.clone()].iter().zip(&weights[range]);
        own.fold([0.0, 0.0], |[s, w], (x, weight)| [s + weight * x, w + weight])
    };
    let [all, weight] = sum(0..list.len());
    let mean = all / weight.max(f64::MIN_POSITIVE);
    let local_mean = |k: usize| {
        let [own, weight] = sum(k.saturating_sub(half)..(k + half + 1).min(list.len()));
        ((own + ONE_LINE * mean) / (weight + ONE_LINE)).max(f64::MIN_POSITIVE)
    };
    (0..list.len()).map(local_mean).collect()
}

/// The same force with nothing but its lines from `first` to `last`, of the samples of a record without its last.
pub(super) fn in_band(force: &[f64], [first, last]: [usize; 2]) -> Vec<f64> {
    let count = force.len();
    let transform = RealTransform::new(count);
    let mut work = force.to_vec();
    let mut spectrum = transform.forward(&mut work);
    for (k, line) in spectrum.iter_mut().enumerate() {
        *line = if k < first || k > last { c64::new(0.0, 0.0) } else { *line / count as f64 };
    }
    if count.is_multiple_of(2) {
        spectrum[count / 2].im = 0.0;
    }
    transform.backward(&mut spectrum, &mut work);
    work
}
