//! From a record to a run that is not in steady state: its channels corrected for their known errors.
//!
//! A channel with known delay `tau` and gain `g` records `g y(t - tau)`; the run holds `y`, read between the samples (error below 1e-3 of
//! the amplitude up to two fifths of the sampling rate).

use super::channel::{Channel, Quantity};
use super::even_steps::{evened, off_even};
use super::finding::{Finding, Flag};
use super::kind::{Kind, TimeSpan};
use super::proposal::release;
use super::record::Record;
use super::run::ChannelCorrection;
use super::transient_quality;
use super::transient_run::{TransientLabel, TransientRun};
use crate::math::fractional_delay::shifted;
use std::ops::Range;
use std::sync::Arc;

/// Fewest samples of a part.
pub(super) const FEWEST_SAMPLES: usize = 32;

/// Why a record makes no transient run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum TransientRunError {
    #[error(
        "{found} samples lie between start_s and end_s (the record lasts from {first_s} s to {last_s} s); give at least {FEWEST_SAMPLES}"
    )]
    PartTooShort { found: usize, first_s: f64, last_s: f64 },
    #[error(
        "sample {row} at {time_s} s is {off:.2} steps off even steps, and samples are missing or crowd there; records that are not steady need all of them"
    )]
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
        corrections: &[ChannelCorrection],
    ) -> Result<Self, TransientRunError> {
        let released_s = release_of(&label, &record);
        let part = TimeSpan { start_s: label.part.start_s.or(released_s), ..label.part };
        let samples = part.samples(record.time());
        if samples.len() < FEWEST_SAMPLES {
            let (first_s, last_s) = (record.time()[0], record.time()[record.len() - 1]);
            return Err(TransientRunError::PartTooShort { found: samples.len(), first_s, last_s });
        }
        let (record, evened) = in_even_steps(record, samples.clone())?;
        let samples = part.samples(record.time());
        if record.channels().iter().all(|channel| channel.quantity == Quantity::Force) {
            return Err(TransientRunError::NoMotion);
        }
        let mut record = corrected(record, corrections);
        if let Some(constant) = label.exponential_window_s {
            record = unwindowed(&record, constant);
        }
        let TransientLabel { file, kind, part, level, session, enabled, exponential_window_s } = label;
        let (findings, on_moving_base) = (Vec::new(), false);
        let mut run = Self { file, record, kind, part, level, session, enabled, findings, on_moving_base, samples };
        run.findings = transient_quality::assess(&run);
        run.findings.extend(exponential_window_s.map(|constant| windowed(&run, constant)));
        run.findings.extend(released_s.map(released));
        run.findings.extend(evened);
        Ok(run)
    }

    /// The same run without known errors of its channels.
    pub(crate) fn without_errors(&self, corrections: &[ChannelCorrection]) -> Self {
        self.with_record(corrected(self.record.clone(), corrections))
    }
}

/// Release (s) of a decay of which the project does not say where it begins.
fn release_of(label: &TransientLabel, record: &Record) -> Option<f64> {
    if label.kind == Kind::Decay && label.part.start_s.is_none() { release(record) } else { None }
}

/// What is said of a decay that is used from its release on.
fn released(start_s: f64) -> Finding {
    let reason =
        format!("the record begins before the release; it is used from {start_s:.4} s on, `start_s` says otherwise");
    Finding::of_record(Flag::BeforeRelease, reason)
}

/// The record where the part `samples` is in even steps, else taken onto even ones, which is said.
fn in_even_steps(
    record: Arc<Record>,
    samples: Range<usize>,
) -> Result<(Arc<Record>, Option<Finding>), TransientRunError> {
    let first = samples.start;
    let Some((n, off)) = off_even(&record.time()[samples]) else { return Ok((record, None)) };
    let (row, time_s) = (first + n + 1, record.time()[first + n]);
    let (even, finding) = evened(&record).ok_or(TransientRunError::UnevenSteps { row, time_s, off })?;
    Ok((even, Some(finding)))
}

/// The record with every known delay and gain taken out; shared where there is none.
fn corrected(record: Arc<Record>, corrections: &[ChannelCorrection]) -> Arc<Record> {
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

/// The record before the exponential window `exp(-t / constant)` was laid over its motion.
fn unwindowed(record: &Record, constant: f64) -> Arc<Record> {
    let mut mended = record.clone();
    for (channel, samples) in mended.channels.iter().zip(&mut mended.samples) {
        if channel.quantity != Quantity::Force {
            let start = mended.time[0];
            samples.iter_mut().zip(&mended.time).for_each(|(y, t)| *y *= ((t - start) / constant).exp());
        }
    }
    Arc::new(mended)
}

/// What is said of an exponential window.
fn windowed(run: &TransientRun, constant: f64) -> Finding {
    let last = run.time()[run.len() - 1] - run.record.time()[0];
    let reason = format!(
        "an exponential window of time constant {constant} s was taken out, which adds {:.4} 1/s to the decay of every mode; noise at the end grows {:.3} times",
        1.0 / constant,
        (last / constant).exp()
    );
    Finding::of_record(Flag::ExponentialWindow, reason)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::measurement::{Kind, TimeSpan};
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
        TransientLabel { kind: Kind::Decay, part: TimeSpan { start_s, end_s }, enabled: true, ..Default::default() }
    }

    #[test]
    fn known_errors_of_a_channel_are_taken_out() {
        let [delay, gain] = [0.0037, 1.25];
        let wave = |t: f64| (TAU * 3.0 * t).sin() * (-0.2 * t).exp();
        let correction = ChannelCorrection { channel: channel(Quantity::Displacement), delay, gain };
        let run = TransientRun::new(label(None, None), record(|t| gain * wave(t - delay)), &[correction]).unwrap();
        let worst = (3..396).map(|n| (run.samples(0)[n] - wave(run.time()[n])).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-5, "{worst}");
    }

    #[test]
    fn an_exponential_window_is_taken_out() {
        let wave = |t: f64| (TAU * 3.0 * t).sin();
        let label = TransientLabel { exponential_window_s: Some(0.8), ..label(None, None) };
        let run = TransientRun::new(label, record(|t| wave(t) * (-t / 0.8).exp()), &[]).unwrap();
        assert!((0..400).all(|n| (run.samples(0)[n] - wave(run.time()[n])).abs() < 1e-12));
        assert!(run.findings.iter().any(|f| f.flag == Flag::ExponentialWindow));
    }

    #[test]
    fn a_part_without_samples_is_refused() {
        let error = TransientRun::new(label(Some(9.0), None), record(f64::sin), &[]).unwrap_err();
        assert!(error.to_string().starts_with("0 samples lie between start_s and end_s"), "{error}");
        let run = TransientRun::new(label(Some(1.0), Some(2.0)), record(f64::sin), &[]).unwrap();
        assert_eq!((run.len(), run.time()[0], run.range()), (101, 1.0, 100..201));
    }
}
