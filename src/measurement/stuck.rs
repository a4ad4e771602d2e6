//! Samples that stand still where the motion does not, and samples that are not there.
//!
//! Both compare with the fit: where it moves by more than rounding and noise explain, equal samples are a fault.

use super::even_columns::EvenColumns;
use super::finding::{Finding, Flag};
use super::fit::{ChannelFit, HarmonicFit};
use super::record::Record;
use crate::math::statistics::median;
use faer::c64;

/// Equal samples in a row at the largest or the least value that are called clipped; two can be chance.
const FEWEST_CLIPPED: usize = 3;

/// Steps of rounding by which the motion must change over samples that stand still.
const STEPS_OF_ROUNDING: f64 = 3.0;

/// Rounding over noise below which two equal samples are no chance.
const FINE: f64 = 1e-3;

/// A step of the time that is called a gap, in median steps.
const GAP: f64 = 1.5;

/// Share of steps that must be even for a gap to mean a gap; other records have uneven steps by design.
const EVEN_SHARE: f64 = 0.9;

/// A gap where steps are uneven by design, in median steps.
const WIDE_GAP: f64 = 5.0;

/// Second derivative of a fit at a time.
fn curvature(fit: &ChannelFit, omega: f64, time: f64) -> f64 {
    at(fit, omega, time, |h, w| -(h as f64 * w).powi(2))
}

/// The periodic part of a fit at a time, each harmonic times a factor.
fn at(fit: &ChannelFit, omega: f64, time: f64, factor: impl Fn(usize, f64) -> f64) -> f64 {
    let harmonics = fit.amplitudes.iter().enumerate();
    harmonics
        .map(|(i, y)| {
            let (sin, cos) = ((i + 1) as f64 * omega * time).sin_cos();
            factor(i + 1, omega) * (y * c64::new(cos, sin)).re
        })
        .sum()
}

/// Step in which a channel's numbers come: as written, or the least change between neighbours.
fn rounding(record: &Record, channel: usize) -> f64 {
    let steps = record.samples(channel).windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| *step > 0.0);
    steps.fold(f64::INFINITY, f64::min).max(record.resolution(channel))
}

/// One finding a channel that stands still at an end of its range.
pub(super) fn clipped(record: &Record, fit: &HarmonicFit) -> Vec<Finding> {
    (0..fit.channels.len()).filter_map(|c| clipped_channel(record, fit, c)).collect()
}

fn clipped_channel(record: &Record, fit: &HarmonicFit, c: usize) -> Option<Finding> {
    let samples = record.samples(c);
    let (least, most) = samples.iter().fold((f64::MAX, f64::MIN), |(l, m), y| (l.min(*y), m.max(*y)));
    if least == most {
        return None;
    }
    let step = rounding(record, c);
    let (mut total, mut longest, mut limit) = (0, 0, most);
    for end in [least, most] {
        for (start, length) in plateaus(samples, end) {
            let time = record.time();
            let half = 0.5 * (time[start + length - 1] - time[start]);
            let moved = 0.5 * curvature(&fit.channels[c], fit.omega, time[start] + half).abs() * half * half;
            if moved > STEPS_OF_ROUNDING * step {
                total += length;
                if length > longest {
                    (longest, limit) = (length, end);
                }
            }
        }
    }
    (total >= FEWEST_CLIPPED).then(|| {
        let channel = &fit.channels[c].channel;
        let reason = format!(
            "{total} samples of {channel} stand at the end of its range, up to {longest} in a row at {limit:.4e} (SI units)"
        );
        Finding::of_channel(Flag::Clipped, channel, reason)
    })
}

/// Start and length of every row of at least [`FEWEST_CLIPPED`] samples that equal `end`.
fn plateaus(samples: &[f64], end: f64) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut n = 0;
    while n < samples.len() {
        let length = samples[n..].iter().take_while(|y| **y == end).count();
        if length >= FEWEST_CLIPPED {
            found.push((n, length));
        }
        n += length.max(1);
    }
    found
}

/// Gaps in the time, times that stand twice, and rows that repeat the one before.
pub(super) fn missing_samples(record: &Record, fit: &HarmonicFit) -> Option<Finding> {
    let reasons: Vec<String> =
        [gaps(record), repeated_times(record), repeated_rows(record, fit)].into_iter().flatten().collect();
    (!reasons.is_empty()).then(|| Finding::of_record(Flag::MissingSamples, reasons.join("; ")))
}

fn gaps(record: &Record) -> Option<String> {
    if EvenColumns::suit(record.time()) {
        return None;
    }
    let steps: Vec<f64> = record.time().windows(2).map(|pair| pair[1] - pair[0]).collect();
    let usual = median(&steps);
    let even = steps.iter().filter(|step| (*step - usual).abs() < 0.1 * usual).count();
    let limit = if even as f64 >= EVEN_SHARE * steps.len() as f64 { GAP } else { WIDE_GAP };
    let gaps: Vec<f64> = steps.into_iter().filter(|step| *step > limit * usual).collect();
    let missing: f64 = gaps.iter().map(|gap| (gap / usual - 1.0).round().max(1.0)).sum();
    let widest = gaps.iter().copied().fold(0.0, f64::max);
    (!gaps.is_empty())
        .then(|| format!("about {missing} samples are missing in {} gaps of up to {widest:.4e} s", gaps.len()))
}

fn repeated_times(record: &Record) -> Option<String> {
    let count = record.time().windows(2).filter(|pair| pair[0] == pair[1]).count();
    match count {
        0 => None,
        1 => Some("1 time stands twice".to_string()),
        _ => Some(format!("{count} times stand twice")),
    }
}

/// Rows whose every channel repeats the row before, where the fit says that at least one should have moved.
fn repeated_rows(record: &Record, fit: &HarmonicFit) -> Option<String> {
    let live: Vec<usize> = (0..fit.channels.len()).filter(|&c| rounding(record, c).is_finite()).collect();
    // Where rounding is far finer than the noise, equality is no chance, however little the motion moves.
    let step = |c: usize| match (rounding(record, c), fit.channels[c].noise) {
        (rounding, noise) if rounding < FINE * noise => rounding,
        (rounding, noise) => rounding.max(noise),
    };
    let steps: Vec<f64> = live.iter().map(|&c| step(c)).collect();
    let repeats = |n: usize| live.iter().all(|&c| record.samples(c)[n] == record.samples(c)[n - 1]);
    let moves = |n: usize| {
        let (before, now) = (record.time()[n - 1], record.time()[n]);
        live.iter().zip(&steps).any(|(&c, step)| {
            let value = |t: f64| at(&fit.channels[c], fit.omega, t, |_, _| 1.0);
            (value(now) - value(before)).abs() > STEPS_OF_ROUNDING * step
        })
    };
    let count = (1..record.len()).filter(|&n| !live.is_empty() && repeats(n) && moves(n)).count();
    (count > 0).then(|| format!("{count} rows repeat the one before in every channel"))
}
