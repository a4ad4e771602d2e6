//! Records in uneven steps, as telephones and loggers of events write them, taken onto even ones.
//!
//! Between the samples a record is the polynomial through the six nearest (Lagrange). Up to a tenth of the mean sampling rate and
//! with steps that vary by half it is off by less than 1e-3 of the amplitude; what polynomials through six and through four samples differ by
//! shows how much motion and noise there is that is too fast for them, and is said.

use super::channel::Channel;
use super::finding::{Finding, Flag};
use super::record::Record;
use std::sync::Arc;

/// Deviation of an instant from even steps that still counts as even, in steps.
const UNEVEN: f64 = 0.25;
/// Longest step over the median one: beyond it a sample is missing, and nothing says what was there.
const LONGEST: f64 = 2.0;
/// Shortest step over the median one: polynomials through samples that are closer magnify their noise.
const SHORTEST: f64 = 0.1;

/// The first instant that is off even steps: its number and by how many steps.
pub(super) fn off_even(time: &[f64]) -> Option<(usize, f64)> {
    let step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let off = |n: usize| ((time[n] - time[0]) / step - n as f64).abs();
    (0..time.len()).find(|&n| off(n) > UNEVEN).map(|n| (n, off(n)))
}

/// The record in even steps of the mean length, and what is said of it; none where steps are missing.
pub(super) fn evened(record: &Record) -> Option<(Arc<Record>, Finding)> {
    let time = record.time();
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_unstable_by(f64::total_cmp);
    let (shortest, median, longest) = (*steps.first()?, steps[steps.len() / 2], *steps.last()?);
    if longest > LONGEST * median || shortest < SHORTEST * median {
        return None;
    }
    let step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let even: Vec<f64> = (0..time.len()).map(|n| time[0] + n as f64 * step).collect();
    let taken = |points: usize| -> Vec<Vec<f64>> {
        (0..record.channels().len()).map(|c| at(&even, time, record.samples(c), points)).collect()
    };
    let (six, four) = (taken(6), taken(4));
    let apart = |c: usize| {
        rms(six[c].iter().zip(&four[c]).map(|(a, b)| a - b)) / rms(six[c].iter().copied()).max(f64::MIN_POSITIVE)
    };
    let worst = (0..six.len()).max_by(|&a, &b| apart(a).total_cmp(&apart(b)))?;
    let reason = said([shortest, longest, step], &record.channels()[worst], apart(worst));
    let mut mended = record.clone();
    (mended.time, mended.samples) = (even, six);
    Some((Arc::new(mended), Finding::of_record(Flag::UnevenSteps, reason)))
}

fn said([shortest, longest, step]: [f64; 3], channel: &Channel, apart: f64) -> String {
    format!(
        "steps of {:.3} to {:.3} ms were taken onto even ones of {:.3} ms by polynomials through six samples; those through four differ by \
         {:.2} % of {channel}",
        1e3 * shortest,
        1e3 * longest,
        1e3 * step,
        100.0 * apart
    )
}

fn rms(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    (values.map(|y| y * y).sum::<f64>() / count).sqrt()
}

/// Samples at `times` between those at the ascending `instants`, by the polynomial through the nearest `points`.
fn at(times: &[f64], instants: &[f64], samples: &[f64], points: usize) -> Vec<f64> {
    let (mut behind, last) = (0, instants.len());
    let sample = |&t: &f64| {
        while behind < last && instants[behind] < t {
            behind += 1;
        }
        let first = behind.saturating_sub(points / 2).min(last.saturating_sub(points));
        let near = first..(first + points).min(last);
        let weight = |i: usize| {
            let others = near.clone().filter(|&j| j != i);
            others.map(|j| (t - instants[j]) / (instants[i] - instants[j])).product::<f64>()
        };
        near.clone().map(|i| weight(i) * samples[i]).sum()
    };
    times.iter().map(sample).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::measurement::Quantity;
    use std::f64::consts::TAU;

    fn record(time: Vec<f64>, signal: impl Fn(f64) -> f64) -> Record {
        let samples = vec![time.iter().map(|&t| signal(t)).collect()];
        let channel = Channel { quantity: Quantity::Acceleration, dof: 0, label: "1".into() };
        Record::new(time, vec![channel], samples).unwrap()
    }

    /// A ringing at a twentieth of the rate, in steps that vary by a half, is what it is at even instants.
    #[test]
    fn uneven_steps_are_taken_onto_even_ones() {
        let wave = |t: f64| (TAU * 5.0 * t).sin() * (-0.3 * t).exp();
        let jitter = |n: u32| 0.25 * (f64::from(n) * 1.7).sin();
        let time: Vec<f64> = (0..600).map(|n| 0.01 * (f64::from(n) + jitter(n) + 0.003 * f64::from(n % 97))).collect();
        assert!(off_even(&time).is_some());
        let (even, finding) = evened(&record(time, wave)).unwrap();
        assert!(off_even(even.time()).is_none());
        let worst = (3..597).map(|n| (even.samples(0)[n] - wave(even.time()[n])).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-3, "{worst}");
        assert!(finding.reason.contains("of acc@1"), "{}", finding.reason);
    }

    #[test]
    fn missing_samples_stay_an_error() {
        let time: Vec<f64> = (0..100).map(|n| 0.01 * f64::from(n + if n > 50 { 3 } else { 0 })).collect();
        assert!(evened(&record(time, f64::sin)).is_none());
    }
}
