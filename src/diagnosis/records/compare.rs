//! The model's records against the measured ones: by channel, by part of time (and so by amplitude), by band, and their
//! amplitude curves by one estimator.

use super::amplitude::{AmplitudePoint, Band, amplitude_curve, peaks};
use super::data::{RecordData, RecordDiagnosisError, Records};
use super::decays::{decays, telling};
use super::errors::channel_errors;
use super::fitted::FittedRecords;
use super::problem::{FitProblem, Free};
use crate::control::Control;
use crate::effects::Source;
use crate::math::statistics::root_mean_square;
use crate::measurement::Kind;
use dashpot_numerics::RealTransform;

/// Parts of time and bands of frequency.
const PARTS: usize = 8;
/// Steps of the fit of initial states to the first periods.
const FIRST_STEPS: usize = 3;
/// Gain of a step, as a share of what is left, below which a fit of initial states has ended: the error then changes by less.
const LEAST_GAIN: f64 = 1e-5;
/// Share of the largest force of a blow above which it acts.
const STRUCK: f64 = 0.05;
/// Width of the band about a mode where a record shows several.
const MODE_BAND: f64 = 0.3;

/// A part of a record, in s or Hz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordPart {
    /// Where it begins and ends.
    pub range: [f64; 2],
    /// Root mean square of what was measured there over that of the whole record.
    pub size: f64,
    /// Relative error there: of the root mean square of the part for times, of the whole record for bands.
    pub error: f64,
}

/// Curves of one mode in one channel.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeCurve {
    /// Channel, such as `acc@7`.
    pub channel: String,
    /// Frequency near which the mode lies, Hz.
    pub frequency_hz: f64,
    /// As measured.
    pub measured: Vec<AmplitudePoint>,
    /// Of the model's record.
    pub model: Vec<AmplitudePoint>,
    /// Of the model over all amplitudes that were measured, least first: from its record and from decays that begin louder and
    /// quieter.
    pub model_over_amplitude: Vec<AmplitudePoint>,
}

/// One record.
#[derive(Debug, Clone, PartialEq)]
pub struct OneRecord {
    /// Number among the transient runs of the project.
    pub index: usize,
    /// Relative error, root mean square over the channels.
    pub error: f64,
    /// What noise alone would leave.
    pub noise_floor: f64,
    /// Channel, its error and its noise floor.
    pub channels: Vec<(String, [f64; 2])>,
    /// By time.
    pub times: Vec<RecordPart>,
    /// By frequency.
    pub bands: Vec<RecordPart>,
    /// Instants at which they are compared, s.
    pub time: Vec<f64>,
    /// What was measured then, one list a channel of motion, SI units.
    pub measured: Vec<Vec<f64>>,
    /// The same of the model.
    pub model: Vec<Vec<f64>>,
    /// Amplitude curves of the modes that stand out in the channel of greatest response.
    pub curves: Vec<ModeCurve>,
}

/// All records.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordComparison {
    /// Root mean square over records and channels.
    pub error: f64,
    /// What noise alone would leave.
    pub noise_floor: f64,
    /// One entry a record that is used.
    pub records: Vec<OneRecord>,
}

/// Compares the model, with `effects` added, from the measured forces and initial states that are fitted with it.
///
/// # Errors
/// [`RecordDiagnosisError`]: laws without a force in time, models that run away.
pub fn compare_records(
    records: &Records,
    effects: &[Source],
    control: &Control,
) -> Result<RecordComparison, RecordDiagnosisError> {
    let fitted = started(records, effects, control)?;
    let compare_record = |(r, record): (usize, &RecordData)| -> Result<OneRecord, RecordDiagnosisError> {
        let model = fitted.predict(records, r, record.len(), &[])?.channels;
        let louder = |factor: f64, c: usize| {
            let mut start = fitted.clone();
            start.initial[r].iter_mut().for_each(|y| *y *= factor);
            start.predict(records, r, record.len(), &[]).ok().map(|mut decay| decay.channels.swap_remove(c))
        };
        Ok(compared(records, record, model, &|factor, c| (!control.is_late()).then(|| louder(factor, c)).flatten()))
    };
    let list: Vec<OneRecord> = records.list.iter().enumerate().map(compare_record).collect::<Result<_, _>>()?;
    let over = |value: &dyn Fn(&OneRecord) -> f64| root_mean_square(&list.iter().map(value).collect::<Vec<f64>>());
    Ok(RecordComparison { error: over(&|r| r.error), noise_floor: over(&|r| r.noise_floor), records: list })
}

/// The model with initial states only fitted, short parts first.
pub(crate) fn started(
    records: &Records,
    effects: &[Source],
    control: &Control,
) -> Result<FittedRecords, RecordDiagnosisError> {
    started_from(records, FittedRecords::start(records, effects), control)
}

/// A model with initial states only fitted, short parts first.
pub(crate) fn started_from(
    records: &Records,
    start: FittedRecords,
    control: &Control,
) -> Result<FittedRecords, RecordDiagnosisError> {
    let fit = |records: &Records, start: &FittedRecords, share: f64, iterations: usize| {
        FitProblem { records, free: Free::nothing(), share, control }.improve_to(start, iterations, LEAST_GAIN)
    };
    let mut fitted = first_states(records, start, control)?;
    let first = short(records);
    let longer = [(first, 4), (0.4_f64.max(first), 3)];
    for (share, iterations) in longer.into_iter().filter(|(share, _)| *share < 1.0) {
        fitted = fit(records, &fitted, share, iterations)?;
    }
    fit(records, &fitted, 1.0, 6)
}

/// `start` with the initial states that the first periods of the records show, before a model that is off has lost the phase; those
/// of a nonlinear model begin with what its linear part shows, for friction may hold a start at rest fast, or as they are, for a
/// linear part is bent to what a law does under a blow, or, of a body that floats, at rest where it lies: whichever ends nearest.
pub(super) fn first_states(
    records: &Records,
    start: FittedRecords,
    control: &Control,
) -> Result<FittedRecords, RecordDiagnosisError> {
    let fit = |records: &Records, start: &FittedRecords| {
        let share = earliest(records);
        FitProblem { records, free: Free::nothing(), share, control }.improve(start, FIRST_STEPS)
    };
    let mut fitted = start;
    let linear = |s: &Source| s.effect.is_linear();
    if records.known.iter().chain(&fitted.effects).all(linear) {
        return fit(records, &fitted);
    }
    let kept: Vec<usize> = (0..records.known.len()).filter(|&k| linear(&records.known[k])).collect();
    let plain = Records { known: kept.iter().map(|&k| records.known[k].clone()).collect(), ..records.clone() };
    let bare = FittedRecords {
        effects: fitted.effects.iter().filter(|s| linear(s)).cloned().collect(),
        known: kept.iter().map(|&k| fitted.known[k]).collect(),
        ..fitted.clone()
    };
    let at_rest = records.floats().then(|| FittedRecords { initial: records.at_rest(), ..fitted.clone() });
    let as_it_is = fit(records, &fitted);
    if let Ok(bare) = fit(&plain, &bare) {
        fitted.initial = bare.initial;
    }
    let nearer = |one, other| match (one, other) {
        (Ok(one), Ok(other)) => Ok(nearer_of(one, other)),
        (one, other) => Result::or(one, other),
    };
    let found = nearer(as_it_is, fit(records, &fitted));
    at_rest.into_iter().map(|start| fit(records, &start)).fold(found, nearer)
}

/// The fit that leaves less.
fn nearer_of(one: FittedRecords, other: FittedRecords) -> FittedRecords {
    if one.chi_square < other.chi_square { one } else { other }
}

/// Share of every record that holds the first periods: two of its dominant motion, one and a half of the lowest mode.
fn earliest(records: &Records) -> f64 {
    let lowest =
        records.modes.omega.iter().copied().find(|w| *w > 0.0).map_or(0.0, |w| 1.5 * std::f64::consts::TAU / w);
    let share = |r: &RecordData| {
        let seconds = (2.0 / r.dominant_hz).max(lowest).max(8.0 * records.kept as f64 * r.step);
        let blow = struck(r).unwrap_or(0.0);
        blow + seconds / (r.step * r.len() as f64)
    };
    records.list.iter().map(share).fold(0.0, f64::max).min(1.0)
}

/// Share of every record that holds eight periods of its dominant motion after a blow; half of one that is driven all along,
/// whose force holds the phase.
pub(crate) fn short(records: &Records) -> f64 {
    let share = |r: &RecordData| {
        let periods = 8.0 / (r.dominant_hz * r.step * r.len() as f64);
        match (r.kind, struck(r)) {
            (Kind::Transient, None) => periods.max(0.5),
            (Kind::Transient, Some(end)) => periods + end,
            _ => periods,
        }
    };
    records.list.iter().map(share).fold(0.0, f64::max).min(1.0)
}

/// Share of a record after which no force acts, where that is its first part.
pub(super) fn struck(record: &RecordData) -> Option<f64> {
    let loudest = record.forces.iter().flatten().fold(0.0_f64, |m, f| m.max(f.abs()));
    let acts = |n: &usize| record.forces.iter().any(|list| list[*n].abs() > STRUCK * loudest);
    let samples = record.forces.first().map_or(record.len(), Vec::len);
    let end = (0..samples).rev().find(acts).unwrap_or(0) as f64 / samples as f64;
    (end < 0.25).then_some(end)
}

/// What noise would leave of all records, root mean square over channels, as [`compare_records`] tells it of the same model.
pub(super) fn noise_floor(records: &Records, fitted: &FittedRecords) -> Result<f64, RecordDiagnosisError> {
    let mut all = Vec::new();
    for (r, record) in records.list.iter().enumerate() {
        let model = fitted.predict(records, r, record.len(), &[])?.channels;
        let own = floors(record, &records.deviations(record, &left(record, &model)));
        all.push(root_mean_square(&own));
    }
    Ok(root_mean_square(&all))
}

/// What a model leaves of every sample, one list a channel.
fn left(record: &RecordData, model: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let rest = |(y, m): (&Vec<f64>, &Vec<f64>)| y.iter().zip(m).map(|(y, m)| y - m).collect();
    record.samples.iter().zip(model).map(rest).collect()
}

/// A channel of the model's record from initial states that are so many times as large.
type Louder<'a> = dyn Fn(f64, usize) -> Option<Vec<f64>> + 'a;

fn compared(records: &Records, record: &RecordData, model: Vec<Vec<f64>>, louder: &Louder) -> OneRecord {
    let deviations = records.deviations(record, &left(record, &model));
    let errors = channel_errors(record, &model, 0..record.len());
    let floors = floors(record, &deviations);
    let names = record.channels.iter().map(ToString::to_string);
    let channels = names.zip(errors.iter().zip(&floors).map(|(e, f)| [*e, *f])).collect();
    OneRecord {
        index: record.index,
        error: root_mean_square(&errors),
        noise_floor: root_mean_square(&floors),
        channels,
        times: times(record, &model),
        bands: bands(record, &model),
        curves: curves(record, &model, louder),
        time: record.run.time().to_vec(),
        measured: record.as_measured(&record.samples),
        model: record.as_measured(&model),
    }
}

/// Deviation of the samples over the signal of every channel, by the measure of [`channel_errors`].
fn floors(record: &RecordData, deviations: &[Vec<f64>]) -> Vec<f64> {
    let clean = |c: usize| record.samples[c].iter().zip(&deviations[c]).map(|(y, s)| y - s).collect::<Vec<f64>>();
    let shifted: Vec<Vec<f64>> = (0..record.channels.len()).map(clean).collect();
    channel_errors(record, &shifted, 0..record.len())
}

fn times(record: &RecordData, model: &[Vec<f64>]) -> Vec<RecordPart> {
    let length = record.len() / PARTS;
    let whole = |c: usize| root_mean_square(&record.samples[c]);
    let part = |k: usize| {
        let range = k * length..(k + 1) * length;
        let errors = channel_errors(record, model, range.clone());
        let sizes: Vec<f64> = (0..record.channels.len())
            .map(|c| root_mean_square(&record.samples[c][range.clone()]) / whole(c).max(f64::MIN_POSITIVE))
            .collect();
        let time_at_sample = |n: usize| record.first_s + n as f64 * record.step;
        RecordPart {
            range: [time_at_sample(range.start), time_at_sample(range.end)],
            size: root_mean_square(&sizes),
            error: root_mean_square(&errors),
        }
    };
    if length < 4 { Vec::new() } else { (0..PARTS).map(part).collect() }
}

/// Octaves below the Nyquist frequency.
fn bands(record: &RecordData, model: &[Vec<f64>]) -> Vec<RecordPart> {
    let n = record.len();
    let transform = RealTransform::new(n);
    let square = |y: &[f64], from: usize, to: usize| -> f64 {
        let mut work = y.to_vec();
        let lines = transform.forward(&mut work);
        lines[from..to.min(lines.len())].iter().map(nalgebra::Complex::norm_sqr).sum()
    };
    let lines = n / 2 + 1;
    let mut parts = Vec::new();
    let mut to = lines;
    for _ in 0..PARTS {
        let from = if parts.len() + 1 == PARTS { 1 } else { (to / 2).max(1) };
        let shares_in_band = |c: usize| {
            let left: Vec<f64> = record.samples[c].iter().zip(&model[c]).map(|(y, m)| y - m).collect();
            let whole = square(&record.samples[c], 1, lines).max(f64::MIN_POSITIVE);
            [square(&left, from, to) / whole, square(&record.samples[c], from, to) / whole]
        };
        let all: Vec<[f64; 2]> = (0..record.channels.len()).map(shares_in_band).collect();
        let mean = |k: usize| (all.iter().map(|x| x[k]).sum::<f64>() / all.len() as f64).sqrt();
        let hz = |k: usize| k as f64 / (n as f64 * record.step);
        parts.push(RecordPart { range: [hz(from), hz(to)], size: mean(1), error: mean(0) });
        to = from;
        if to <= 1 {
            break;
        }
    }
    parts.reverse();
    parts
}

fn curves(record: &RecordData, model: &[Vec<f64>], louder: &Louder) -> Vec<ModeCurve> {
    let over = |c: &usize| root_mean_square(&record.samples[*c]) / record.noise[*c];
    let Some(c) = (0..record.channels.len()).max_by(|a, b| over(a).total_cmp(&over(b))) else { return Vec::new() };
    // Where a force acts, the motion is not that of a decay: only what follows its end is read.
    let loudest = record.forces.iter().flatten().fold(0.0_f64, |m, f| m.max(f.abs()));
    let acts = |n: &usize| record.forces.iter().any(|list| list[*n].abs() > 0.02 * loudest);
    let first = (0..record.len()).rev().find(acts).map_or(0, |n| n + 1);
    let rest = record.len() - first;
    if rest < 64 || (first > 0 && rest < record.len() / 4) {
        return Vec::new();
    }
    let found = peaks(&record.samples[c][first..], record.step, 0.05, 4);
    let width = if found.len() > 1 { MODE_BAND } else { 0.0 };
    let start = record.first_s + first as f64 * record.step;
    let read =
        |y: &[f64], frequency_hz: f64| amplitude_curve(&y[first..], record.step, start, Band { frequency_hz, width });
    let channel = record.channels[c].to_string();
    let curve = |&frequency_hz: &f64| {
        let [measured, model] = [&record.samples[c], &model[c]].map(|y| read(y, frequency_hz));
        ModeCurve { channel: channel.clone(), frequency_hz, measured, model, model_over_amplitude: Vec::new() }
    };
    let mut curves: Vec<ModeCurve> = found.iter().map(curve).collect();
    // What follows a force begins as that has left it.
    let louder = |factor: f64| if first == 0 { louder(factor, c) } else { None };
    let other = curves
        .first()
        .map_or_else(Vec::new, |main| decays([&main.measured, &main.model], &louder, &|y| read(y, main.frequency_hz)));
    for curve in &mut curves {
        let further = other.iter().flat_map(|y| telling(read(y, curve.frequency_hz)));
        let mut all: Vec<AmplitudePoint> = telling(curve.model.clone()).into_iter().chain(further).collect();
        all.sort_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
        curve.model_over_amplitude = all;
    }
    curves
}
