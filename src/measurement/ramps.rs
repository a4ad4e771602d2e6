//! Whether the force starts or ends within the record: a record that was switched on before the exciter, or a test whose
//! amplitude is run up, held and run down.
//!
//! The fundamental of each block of whole periods is compared with the median block. Of a transient the response grows
//! or falls while the force stays as it is; here the force itself does.

use super::settling::part;
use super::{HarmonicFit, Record};
use crate::math::statistics::median;

/// Blocks that the record is cut into, where it has periods enough.
const BLOCKS: usize = 12;
/// Fewest blocks in which a ramp can be told from the rest.
const FEWEST: usize = 5;
/// Share of the median amplitude below which a block at an end is no part of the steady test.
const STEADY: f64 = 0.9;
/// Deviation of the steady blocks up to which the force is held at all: a decay has no steady part.
const HELD: f64 = 0.1;

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
    pub fn reason(&self, fit: &HarmonicFit) -> String {
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

/// Run-up and run-down of the force, or of the first channel where no force is recorded.
pub(super) fn find(record: &Record, fit: &HarmonicFit) -> Option<Ramps> {
    let channel = fit.force_channels().first().copied().unwrap_or(0);
    let (ends, sizes) = blocks(record, fit, channel)?;
    let level = median(&sizes);
    if level <= 0.0 {
        return None;
    }
    let low = |size: &&f64| **size < STEADY * level;
    let (first, last) = (sizes.iter().take_while(low).count(), sizes.iter().rev().take_while(low).count());
    let steady = sizes.get(first..sizes.len().saturating_sub(last))?;
    let held = steady.iter().all(|size| (size / level - 1.0).abs() < HELD);
    if first + last == 0 || 2 * steady.len() < sizes.len() || !held {
        return None;
    }
    let up = (first > 0).then(|| ends[first]);
    let down = (last > 0).then(|| ends[sizes.len() - last]);
    Some(Ramps { channel, up, down })
}

/// Times at which the blocks begin, with the end of the last, and the amplitude of the fundamental in each.
pub(super) fn blocks(record: &Record, fit: &HarmonicFit, channel: usize) -> Option<(Vec<f64>, Vec<f64>)> {
    let time = record.time();
    let step = record.duration() / (time.len() - 1) as f64;
    let periods = ((record.duration() + step) / fit.period() + 1e-9).floor() as usize;
    let (each, count) = ((periods / BLOCKS).max(1), periods.min(BLOCKS));
    if count < FEWEST {
        return None;
    }
    let end = |k: usize| time[0] + (k * each) as f64 * fit.period();
    let index = |k: usize| time.partition_point(|t| *t < end(k) - 0.01 * step);
    let size = |k: usize| Some(part(record, fit, index(k)..index(k + 1))?.fundamentals[channel].norm());
    // What is left of the record behind the last whole block belongs to it.
    let sizes = (0..count).map(size).collect::<Option<Vec<f64>>>()?;
    Some(((0..=count).map(end).collect(), sizes))
}
