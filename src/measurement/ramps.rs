//! Whether the force starts or ends within the record: a record that was switched on before the exciter, or a test whose
//! amplitude is run up, held and run down.
//!
//! The fundamental of each block of whole periods is compared with the blocks in which it is largest. Of a transient the
//! response grows or falls while the force stays as it is; here the force itself does. What falls off behind a steady part
//! is run down, whatever the force: a friction damper that is moved ever less still gives the same force.

use super::fit::HarmonicFit;
use super::fundamentals::fundamentals;
use super::record::Record;
use super::signal::references;
use crate::math::statistics::median;

/// Blocks that the record is cut into, where it has periods enough.
const BLOCKS: usize = 12;
/// Fewest blocks in which a ramp can be told from the rest.
const FEWEST: usize = 5;
/// Fewest blocks of a steady part.
const FEWEST_STEADY: usize = 2;
/// Share of its level below which a block at an end is no part of the steady test, and below which it is a ramp at all: an
/// end block of a ramp averages half of it or less.
const STEADY: f64 = 0.9;
const RAMP: f64 = 0.75;
/// Noise over signal of a channel from which on its blocks say nothing; ramps themselves look like much noise.
const UNCLEAR: f64 = 0.7;

/// The steady part of a record whose force is run up or down.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ramps {
    /// Channel by which it is seen.
    channel: usize,
    /// When the force has reached its level, s; `None` where it starts at it.
    up: Option<f64>,
    /// When it leaves it, s.
    down: Option<f64>,
}

impl Ramps {
    /// What is wrong, and how to mend it.
    pub(super) fn reason(&self, fit: &HarmonicFit) -> String {
        let name = &fit.channels[self.channel].channel;
        let (what, cut) = match (self.up, self.down) {
            (Some(up), Some(down)) => {
                (format!("is run up until {up:.3} s and down from {down:.3} s"), format!("from {up:.3} to {down:.3} s"))
            }
            (Some(up), None) => (format!("is run up until {up:.3} s"), format!("from {up:.3} s on")),
            (None, down) => {
                let down = down.unwrap_or_default();
                (format!("is run down from {down:.3} s"), format!("up to {down:.3} s"))
            }
        };
        format!("{name} {what} within the record: cut the record to its steady part, {cut}")
    }
}

/// How a channel's amplitude begins and ends.
struct Ends {
    channel: usize,
    /// Blocks at the start and at the end below the steady level.
    low: [usize; 2],
    /// Whether the outermost of them is far below it.
    ramp: [bool; 2],
}

impl Ends {
    fn new(channel: usize, sizes: &[f64]) -> Option<Self> {
        let most = sizes.iter().fold(0.0_f64, |most, size| most.max(*size));
        let upper: Vec<f64> = sizes.iter().copied().filter(|size| *size >= STEADY * most).collect();
        let level = median(&upper);
        let low = |size: &&f64| **size < STEADY * level;
        let counts = [sizes.iter().take_while(low).count(), sizes.iter().rev().take_while(low).count()];
        let steady = sizes.get(counts[0]..sizes.len().saturating_sub(counts[1]))?;
        let held = level > 0.0 && steady.len() >= FEWEST_STEADY && !steady.iter().any(|size| low(&size));
        let ramp = [sizes[0], sizes[sizes.len() - 1]].map(|size| size < RAMP * level);
        held.then_some(Self { channel, low: counts, ramp })
    }
}

/// Run-up and run-down of the force, or of all that moves.
pub(super) fn find(record: &Record, fit: &HarmonicFit) -> Option<Ramps> {
    let (times, blocks) = blocks(record, fit)?;
    let references = references(fit);
    let clear = |c: &usize| references[*c] > 0.0 && fit.channels[*c].noise < UNCLEAR * references[*c];
    let ends: Vec<Ends> = (0..fit.channels.len()).filter(clear).filter_map(|c| Ends::new(c, &blocks[c])).collect();
    let forces = fit.force_channels();
    let by_force = ends.iter().find(|e| forces.contains(&e.channel) && (e.ramp[0] || e.ramp[1]));
    let seen = by_force.or_else(|| ends.iter().find(|e| e.ramp[1]))?;
    let [first, last] = [0, 1].map(|side| ends.iter().map(|e| e.low[side]).max().unwrap_or(0));
    let count = times.len() - 1;
    if first + last + FEWEST_STEADY > count {
        return None;
    }
    let up = (first > 0).then(|| times[first]);
    let down = (last > 0).then(|| times[count - last]);
    Some(Ramps { channel: seen.channel, up, down })
}

/// Times at which the blocks begin, with the end of the last, and the amplitude of the fundamental of each channel in each.
pub(super) fn blocks(record: &Record, fit: &HarmonicFit) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
    let time = record.time();
    let step = record.duration() / (time.len() - 1) as f64;
    let periods = ((record.duration() + step) / fit.period() + 1e-9).floor() as usize;
    let (each, count) = ((periods / BLOCKS).max(1), periods.min(BLOCKS));
    if count < FEWEST {
        return None;
    }
    // What is left of the record belongs to no block; the last ones are counted from its end.
    let spare = (periods - each * count) as f64 * fit.period();
    let begin = |k: usize| time[0] + (k * each) as f64 * fit.period() + if 2 * k >= count { spare } else { 0.0 };
    let index = |t: f64| time.partition_point(|at| *at < t - 0.01 * step);
    let whole = (fit.period() / step - 1e-6).ceil() as usize;
    let of_block = |k: usize| {
        let (from, to) = (begin(k), begin(k) + each as f64 * fit.period());
        let mut range = index(from)..index(to);
        if each == 1 {
            // A single period between two samples takes the next one too.
            range.end = range.end.max(range.start + whole).min(time.len());
            range.start = range.start.min(range.end.saturating_sub(whole));
        }
        Some(fundamentals(record, fit, range)?.fundamentals)
    };
    let found = (0..count).map(of_block).collect::<Option<Vec<_>>>()?;
    let sizes = (0..fit.channels.len()).map(|c| found.iter().map(|block| block[c].norm()).collect()).collect();
    let end = begin(count - 1) + each as f64 * fit.period();
    Some(((0..count).map(begin).chain([end]).collect(), sizes))
}

/// The steady part of a record whose force is run up or down; none where it is steady from end to end.
pub fn steady_part(record: &Record, fit: &HarmonicFit) -> Option<super::kind::TimeSpan> {
    find(record, fit).map(|ramps| super::kind::TimeSpan { start_s: ramps.up, end_s: ramps.down })
}
