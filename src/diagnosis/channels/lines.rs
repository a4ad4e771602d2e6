//! Records that are not steady as lines of their spectra next to the modes, on which the faults of channels are looked for as
//! on steady runs.
//!
//! A record with a measured force is weighted by `exp(-a t)`, force and motion alike: the spectrum of a linear structure that
//! starts at rest is then that of `s = a + i w` in place of `i w`, `X(s) = H(s) F(s)`, however early the record ends. A motion that
//! was there before adds to the amplitudes of the modes, which are left free. Next to mode j with a modal mass of 1
//!
//! ```text
//! Re(f / q) = w_j^2 + a^2 + 2 zeta w_j a - w^2
//! ```
//!
//! so that the slope that tells factors of the force is as it is on steady runs. A free decay has no force, and any weight leaves each
//! mode its shape: `t^2 exp(-a t)`, whose spectrum falls with the third power of the distance from a mode, keeps the modes apart.
//! F. J. Harris, *On the use of windows for harmonic analysis*, Proc. IEEE 66, 1978; exponential windows: D. J. Ewins, *Modal Testing*,
//! 2nd edition, 3.11.

use crate::diagnosis::records::channel_noise::noise_of;
use crate::measurement::{Kind, Quantity, TransientRun};
use crate::structure::modes::Modes;
use dashpot_numerics::RealTransform;
use faer::c64;
use std::f64::consts::TAU;

/// Decay of the weights over the record, nepers: what is cut off at its end is below 1 % of the largest.
const OF_FORCED: f64 = 5.0;
const OF_DECAY: f64 = 10.0;
/// Relative distance from a mode of the model within which its peak is looked for.
const REACH: f64 = 0.12;
/// Height over the noise of the strongest channel at a peak from which on the line is used: no fault of a few per cent hides or
/// shows then.
const HEIGHT: f64 = 50.0;
/// Periods of a mode that the record covers at least.
const PERIODS: f64 = 12.0;
/// Lines on each side of a peak that are used where a force is measured, and their distance as a share of its frequency in long records:
/// the slope of a mode is told from squared frequencies that differ by some parts in a thousand.
const BESIDE: usize = 2;
const APART: f64 = 1e-3;
/// Share of the largest force of a line below which a force is at rest: the hammer that hits elsewhere in other runs.
const AT_REST: f64 = 0.02;
/// Share of the sampling rate up to which the filters of recorders leave signals as they are.
const FLAT: f64 = 0.34;

/// One line of one record.
pub(super) struct Line {
    /// Circular frequency, rad/s.
    pub omega: f64,
    /// Complex frequency of the weighted record, rad/s; none of a decay.
    pub s: Option<c64>,
    /// Number of each response channel among those of the run, and its displacement there, m s (rad s).
    pub motion: Vec<(usize, c64)>,
    /// The same of the forces, N s.
    pub forces: Vec<(usize, c64)>,
}

/// A weighted spectrum of one record.
struct Weighted {
    /// Decay of the weight, 1/s.
    decay: f64,
    /// Circular frequency from one line to the next, rad/s.
    resolution: f64,
    /// Lines of each response channel and of each force, with their numbers.
    motion: Vec<(usize, Vec<c64>)>,
    forces: Vec<(usize, Vec<c64>)>,
    /// Deviation of a line of each response channel by its noise.
    noise: Vec<f64>,
}

/// Circular frequency up to which the lines of a run are used, rad/s.
pub(super) fn highest(run: &TransientRun) -> f64 {
    TAU * FLAT / run.step()
}

/// The lines of a record next to the modes that it shows.
pub(super) fn lines(run: &TransientRun, modes: &Modes) -> Vec<Line> {
    let weighted = Weighted::new(run);
    if run.kind != Kind::Decay && weighted.forces.is_empty() {
        return Vec::new();
    }
    let length = run.step() * run.len() as f64;
    let seen = |j: &usize| modes.omega[*j] * length > TAU * PERIODS && modes.omega[*j] < highest(run);
    let peaks = (0..modes.len()).filter(seen).filter_map(|j| weighted.peak(modes, j));
    peaks.flat_map(|peak| weighted.about(run, peak)).collect()
}

impl Weighted {
    fn new(run: &TransientRun) -> Self {
        let free = run.kind == Kind::Decay;
        let length = run.len() & !1;
        let period = run.step() * length as f64;
        let decay = if free { OF_DECAY } else { OF_FORCED } / period;
        let weight = |n: usize| {
            let t = run.step() * n as f64;
            (-decay * t).exp() * if free { (decay * t).powi(2) } else { 1.0 }
        };
        let weights: Vec<f64> = (0..length).map(weight).collect();
        let transform = RealTransform::new(length);
        let spectrum = |c: usize| {
            let samples = &run.samples(c)[..length];
            // Forces between hits are zero by themselves; a mean of motions is no motion.
            let motion = run.channels()[c].quantity != Quantity::Force;
            let mean = if motion { samples.iter().sum::<f64>() / length as f64 } else { 0.0 };
            let mut work: Vec<f64> = samples.iter().zip(&weights).map(|(y, w)| (y - mean) * w).collect();
            (c, transform.forward(&mut work).iter().map(|line| line * run.step()).collect::<Vec<c64>>())
        };
        let motion: Vec<(usize, Vec<c64>)> = run.response_channels().into_iter().map(&spectrum).collect();
        let forces = run.force_channels().into_iter().map(&spectrum).collect();
        let energy = weights.iter().map(|w| w * w).sum::<f64>().sqrt() * run.step();
        let noise = motion.iter().map(|(c, _)| noise_of(&run.samples(*c)[..length], run.step()) * energy).collect();
        Self { decay, resolution: TAU / period, motion, forces, noise }
    }

    /// The line of the highest peak next to mode `j`, no further than half-way to its neighbours, where it stands out of the noise.
    fn peak(&self, modes: &Modes, j: usize) -> Option<usize> {
        let own = modes.omega[j];
        let below = if j > 0 { 0.5 * (modes.omega[j - 1] + own) } else { 0.0 };
        let above = modes.omega.get(j + 1).map_or(f64::INFINITY, |next| 0.5 * (next + own));
        let from = (own * (1.0 - REACH)).max(below);
        let to = (own * (1.0 + REACH)).min(above);
        let count = self.motion.first()?.1.len();
        let first = ((from / self.resolution).ceil() as usize).max(BESIDE + 1);
        let last = ((to / self.resolution).floor() as usize).min(count.saturating_sub(BESIDE + 1));
        let height = |k: usize| {
            let channels = self.motion.iter().zip(&self.noise);
            channels.map(|((_, lines), noise)| lines[k].norm_sqr() / (noise * noise)).fold(0.0, f64::max)
        };
        let peak = (first..=last).max_by(|&a, &b| height(a).total_cmp(&height(b)))?;
        let is_peak = height(peak) >= height(peak - 1) && height(peak) >= height(peak + 1);
        (is_peak && height(peak) > HEIGHT * HEIGHT).then_some(peak)
    }

    /// The line of a peak, and those beside it where a force is measured.
    fn about(&self, run: &TransientRun, peak: usize) -> Vec<Line> {
        if self.forces.is_empty() {
            return vec![self.line(run, peak)];
        }
        let stride = ((APART * peak as f64) as usize).max(1);
        (0..=2 * BESIDE).map(|i| self.line(run, peak + i * stride - BESIDE * stride)).collect()
    }

    fn line(&self, run: &TransientRun, k: usize) -> Line {
        let omega = k as f64 * self.resolution;
        let largest = self.forces.iter().map(|(_, lines)| lines[k].norm()).fold(0.0, f64::max);
        let acts = |(_, lines): &&(usize, Vec<c64>)| lines[k].norm() > AT_REST * largest;
        let forced = !self.forces.is_empty();
        let s = c64::new(if forced { self.decay } else { 0.0 }, omega);
        let displacement = |(c, lines): &(usize, Vec<c64>)| {
            (*c, lines[k] * s.powi(-run.channels()[*c].quantity.derivatives().unwrap_or(0)))
        };
        Line {
            omega,
            s: forced.then_some(s),
            motion: self.motion.iter().map(displacement).collect(),
            forces: self.forces.iter().filter(acts).map(|(c, lines)| (*c, lines[k])).collect(),
        }
    }
}
