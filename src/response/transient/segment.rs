//! Segments of a record that are stepped through at one step length, with the measured forces over their steps.

use super::hold::{Hold, Polynomial, shifted, value};
use super::setup::SampledForces;

/// Phase of the highest mode, rad, that a step covers at most where friction holds: a force that leaves no velocity at the end of a step
/// may be anything in between, and derivatives grow from step to step where it is (the held mode is sampled, its zeros lie outside the
/// unit circle: Astrom, Hagander and Sternby, "Zeros of sampled systems", Automatica 20, 1984).
const HELD_PHASE: f64 = 1.2;
/// Parts of a step at most.
const MOST_SUBSTEPS: usize = 8;

/// Samples that are stepped through at one step length.
pub(super) struct Segment {
    /// Numbers of its first and last sample.
    pub from: usize,
    pub to: usize,
    /// Samples that a step covers, and parts in which it is made.
    pub samples: usize,
    pub substeps: usize,
    /// Forces over its steps, one list a drive.
    held: Vec<Vec<Polynomial>>,
}

impl SampledForces {
    /// The segments of a record: from sample to sample, then in longer steps, over which forces go on straight between their means. Where
    /// friction holds modes up to `held` rad/s all steps resolve these.
    pub(super) fn segments(&self, held: Option<f64>) -> Vec<Segment> {
        let last = self.samples.max(1) - 1;
        let longer: Vec<_> = self.step_lengths.iter().filter(|length| held.is_none() && length.from < last).collect();
        let least = held.map_or(1, |omega| ((omega * self.step / HELD_PHASE).ceil() as usize).clamp(1, MOST_SUBSTEPS));
        let end = |k: usize| longer.get(k).map_or(last, |length| length.from);
        let held = self.forces.iter().map(|force| Hold::BandLimited.polynomials(&force[..self.samples])).collect();
        let fine = Segment { from: 0, to: end(0), samples: 1, substeps: self.substeps.max(least), held };
        let long = longer.iter().enumerate().map(|(k, length)| {
            let (from, to, samples) = (length.from, end(k + 1), length.samples);
            let straight = |force: &Vec<f64>| Hold::FirstOrder.polynomials(&means(force, from, to, samples));
            Segment { from, to, samples, substeps: 1, held: self.forces.iter().map(straight).collect() }
        });
        std::iter::once(fine).chain(long).filter(|s| s.from < s.to || s.from == 0).collect()
    }
}

/// Means of a force about every so many samples.
fn means(force: &[f64], from: usize, to: usize, samples: usize) -> Vec<f64> {
    let mean = |n: usize| {
        let around = &force[n.saturating_sub(samples / 2)..(n + samples / 2 + 1).min(force.len())];
        around.iter().sum::<f64>() / around.len() as f64
    };
    (from..=to).step_by(samples).map(mean).collect()
}

impl Segment {
    /// Length of a part of a step and time over which forces are one polynomial, s, where samples are `step` s apart.
    pub(super) fn lengths(&self, step: f64) -> [f64; 2] {
        let whole = self.samples as f64 * step;
        [whole / self.substeps as f64, whole]
    }

    /// Each force at the start, and its rate there, where samples are `step` s apart.
    pub(super) fn begin(&self, step: f64) -> Vec<[f64; 2]> {
        let start = |list: &Vec<Polynomial>| list.first().map_or([0.0; 2], |first| [first[0], first[1] / step]);
        self.held.iter().map(start).collect()
    }

    /// Forces over part `k` of the step that begins at sample `n`.
    pub(super) fn drives(&self, n: usize, k: usize, drives: &mut [Polynomial]) {
        let share = k as f64 / self.substeps as f64;
        for (drive, list) in drives.iter_mut().zip(&self.held) {
            let whole = &list[(n - self.from) / self.samples];
            *drive = if k == 0 { *whole } else { shifted(whole, share) };
        }
    }

    /// Forces at sample `n`, which lies between two steps.
    pub(super) fn inputs(&self, n: usize, inputs: &mut [f64]) {
        for (u, list) in inputs.iter_mut().zip(&self.held) {
            *u = value(&list[(n - self.from) / self.samples], 0.0);
        }
    }
}
