//! One run that is not in steady state: a part of a record in time, its channels corrected for their known errors.
//!
//! A channel with known delay `tau` and gain `g` records `g y(t - tau)`; the run holds `y`, read between the samples by a
//! polynomial through six of them (error below 1e-3 of the amplitude up to a fifth of the sampling rate).

use super::run::Correction;
use super::{Channel, Finding, Kind, Part, Quantity, Record};
use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

/// Fewest samples of a part.
pub const FEWEST_SAMPLES: usize = 32;
/// Deviation of an instant from even steps that still counts as even, in steps.
const UNEVEN: f64 = 0.25;
/// Points of the polynomial between the samples.
const POINTS: usize = 6;

/// A decay or a transient record and the part of it that is used.
#[derive(Debug, Clone, PartialEq)]
pub struct TransientRun {
    /// Name of the file, for messages and results.
    pub file: String,
    /// The whole record in equal steps, channels corrected for their known errors.
    pub record: Arc<Record>,
    /// Decay or transient.
    pub kind: Kind,
    /// The part that is used, as the project says it.
    pub part: Part,
    /// Label of the force level.
    pub level: Option<i64>,
    /// Label of the session: runs without re-assembly between them.
    pub session: Option<String>,
    /// Whether the user wants it used.
    pub enabled: bool,
    /// What is wrong with the record, each with its reason in words.
    pub findings: Vec<Finding>,
    samples: Range<usize>,
}

/// What a run is called and what is done with it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TransientLabel {
    /// Name of the file.
    pub file: String,
    /// Decay or transient.
    pub kind: Kind,
    /// The part that is used.
    pub part: Part,
    /// Label of the force level.
    pub level: Option<i64>,
    /// Label of the session.
    pub session: Option<String>,
    /// Whether the user wants it used.
    pub enabled: bool,
}

/// Why a record makes no transient run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum TransientRunError {
    #[error(
        "{found} samples lie between start_s and end_s (the record lasts from {first_s} s to {last_s} s); give at least {FEWEST_SAMPLES}"
    )]
    PartTooShort { found: usize, first_s: f64, last_s: f64 },
    #[error("sample {row} at {time_s} s is {off:.2} steps off even steps; records that are not steady need even steps")]
    UnevenSteps { row: usize, time_s: f64, off: f64 },
    #[error("no channel measures motion; add one, such as acc@7 [m/s^2]")]
    NoMotion,
}

impl TransientRun {
    /// Takes a part of a record and says what is wrong with it.
    ///
    /// # Errors
    /// [`TransientRunError`]: a part without samples, uneven steps, no motion.
    pub fn new(
        label: TransientLabel,
        record: Arc<Record>,
        corrections: &[Correction],
    ) -> Result<Self, TransientRunError> {
        let samples = label.part.samples(record.time());
        if samples.len() < FEWEST_SAMPLES {
            let (first_s, last_s) = (record.time()[0], record.time()[record.len() - 1]);
            return Err(TransientRunError::PartTooShort { found: samples.len(), first_s, last_s });
        }
        check_steps(&record.time()[samples.clone()], samples.start)?;
        if record.channels().iter().all(|channel| channel.quantity == Quantity::Force) {
            return Err(TransientRunError::NoMotion);
        }
        let record = corrected(record, corrections);
        let TransientLabel { file, kind, part, level, session, enabled } = label;
        Ok(Self { file, record, kind, part, level, session, enabled, findings: Vec::new(), samples })
    }

    /// Numbers of the samples of the record that are used.
    pub fn range(&self) -> Range<usize> {
        self.samples.clone()
    }

    /// Number of samples that are used.
    pub fn len(&self) -> usize {
        self.samples.len()
    }

    /// Whether no sample is used; never true.
    pub fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }

    /// Instants of the part that is used, s.
    pub fn time(&self) -> &[f64] {
        &self.record.time()[self.samples.clone()]
    }

    /// Channels in the order of the record.
    pub fn channels(&self) -> &[Channel] {
        self.record.channels()
    }

    /// Samples of a channel in the part that is used, SI units.
    pub fn samples(&self, channel: usize) -> &[f64] {
        &self.record.samples(channel)[self.samples.clone()]
    }

    /// Time between samples, s.
    pub fn step(&self) -> f64 {
        let time = self.time();
        (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64
    }

    /// Numbers of the channels that measure motion.
    pub fn response_channels(&self) -> Vec<usize> {
        self.numbers(|quantity| quantity != Quantity::Force)
    }

    /// Numbers of the channels that measure forces. A decay has none: nothing acts on it.
    pub fn force_channels(&self) -> Vec<usize> {
        if self.kind == Kind::Decay { Vec::new() } else { self.numbers(|quantity| quantity == Quantity::Force) }
    }

    fn numbers(&self, wanted: impl Fn(Quantity) -> bool) -> Vec<usize> {
        (0..self.channels().len()).filter(|&c| wanted(self.channels()[c].quantity)).collect()
    }
}

fn check_steps(time: &[f64], first: usize) -> Result<(), TransientRunError> {
    let step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let off = |n: usize| ((time[n] - time[0]) / step - n as f64).abs();
    match (0..time.len()).find(|&n| off(n) > UNEVEN) {
        Some(n) => Err(TransientRunError::UnevenSteps { row: first + n + 1, time_s: time[n], off: off(n) }),
        None => Ok(()),
    }
}

/// The record with every known delay and gain taken out; shared where there is none.
fn corrected(record: Arc<Record>, corrections: &[Correction]) -> Arc<Record> {
    let correction = |channel: &Channel| {
        corrections.iter().find(|c| c.channel.quantity == channel.quantity && c.channel.dof == channel.dof)
    };
    if record.channels().iter().all(|channel| correction(channel).is_none()) {
        return record;
    }
    let step = record.step();
    let mend = |c: usize| match correction(&record.channels()[c]) {
        None => record.samples(c).to_vec(),
        Some(known) => {
            let later = shifted(record.samples(c), known.delay / step);
            later.iter().map(|y| y / known.gain).collect()
        }
    };
    let mut mended = (*record).clone();
    mended.samples = (0..record.channels().len()).map(mend).collect();
    Arc::new(mended)
}

/// `y(n + shift)` between the samples; beyond the ends the last polynomial goes on for no more than the shift.
fn shifted(samples: &[f64], shift: f64) -> Cow<'_, [f64]> {
    if shift == 0.0 {
        return Cow::Borrowed(samples);
    }
    let last = samples.len() - 1;
    let at = |n: usize| {
        let x = (n as f64 + shift).clamp(0.0, last as f64);
        let first = (x.floor() as usize).saturating_sub(POINTS / 2 - 1).min((last + 1).saturating_sub(POINTS));
        let points = first..(first + POINTS).min(last + 1);
        let weight = |i: usize| {
            points.clone().filter(|&j| j != i).map(|j| (x - j as f64) / (i as f64 - j as f64)).product::<f64>()
        };
        points.clone().map(|i| weight(i) * samples[i]).sum()
    };
    Cow::Owned((0..samples.len()).map(at).collect())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use std::f64::consts::TAU;

    fn channel(quantity: Quantity) -> Channel {
        Channel { quantity, dof: 0, label: "1".into() }
    }

    fn record(signal: impl Fn(f64) -> f64) -> Arc<Record> {
        let time: Vec<f64> = (0..400).map(|n| 0.01 * f64::from(n)).collect();
        let samples = vec![time.iter().map(|&t| signal(t)).collect()];
        Arc::new(Record::new(time, vec![channel(Quantity::Displacement)], samples).unwrap())
    }

    fn label(start_s: Option<f64>, end_s: Option<f64>) -> TransientLabel {
        TransientLabel { kind: Kind::Decay, part: Part { start_s, end_s }, enabled: true, ..Default::default() }
    }

    #[test]
    fn known_errors_of_a_channel_are_taken_out() {
        let [delay, gain] = [0.0037, 1.25];
        let wave = |t: f64| (TAU * 3.0 * t).sin() * (-0.2 * t).exp();
        let correction = Correction { channel: channel(Quantity::Displacement), delay, gain };
        let run = TransientRun::new(label(None, None), record(|t| gain * wave(t - delay)), &[correction]).unwrap();
        let worst = (3..396).map(|n| (run.samples(0)[n] - wave(run.time()[n])).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-5, "{worst}");
    }

    #[test]
    fn a_part_without_samples_is_refused() {
        let error = TransientRun::new(label(Some(9.0), None), record(f64::sin), &[]).unwrap_err();
        assert!(error.to_string().starts_with("0 samples lie between start_s and end_s"), "{error}");
        let run = TransientRun::new(label(Some(1.0), Some(2.0)), record(f64::sin), &[]).unwrap();
        assert_eq!((run.len(), run.time()[0], run.range()), (101, 1.0, 100..201));
    }
}
