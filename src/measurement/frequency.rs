//! Estimates the fundamental frequency of a record.
//!
//! First the highest line of the windowed spectrum of the force (without one: of all channels), which is the
//! fundamental even where a resonance lifts a harmonic of the response. Then Gauss-Newton on
//! `min_omega sum_c w_c |y_c - B(omega) B^+(omega) y_c|^2`, jointly over all channels, with
//!
//! ```text
//! d omega = sum_c w_c J_c^T r_c / sum_c w_c |P J_c|^2,    J_c = d(fit)/d omega = sum_h h tau (b_h cos - a_h sin)
//! ```
//!
//! where `P` takes out what the columns `B` explain (variable projection: amplitudes follow the frequency).
//!
//! Of a long record the spectrum is the mean of those of its parts, and the frequency of its loudest part is refined on
//! ever longer parts around it: the steps over the whole record, which cost most, are then one or two.

use super::channel::Quantity;
use super::fit::{FitError, Solved, resolvable, solve};
use super::noise::Lag;
use super::record::Record;
use super::slope::Slope;
use crate::math::spectrum::Spectrum;
use dashpot_numerics::dot;
use std::f64::consts::TAU;
use std::ops::Range;

/// Most steps of the refinement; four are usual.
const MOST_STEPS: usize = 30;

/// Largest phase that a step may turn over half of the record, rad: beyond, the linearisation is worth nothing.
const LARGEST_TURN: f64 = 1.0;

/// Phase over half of the record below which the frequency stands still, rad.
const STANDSTILL: f64 = 1e-13;

/// Roundings of the phase at the ends of the record below which it stands still: of many periods they are more than that.
const ROUNDINGS: f64 = 2.0;

/// Periods below which lines of the spectrum are too broad to start from: the neighbourhood is scanned instead.
const FEW_PERIODS: f64 = 8.0;

/// Share of the highest line at which a line at a half, a third ... of its frequency is the fundamental.
const SUBHARMONIC: f64 = 0.02;

/// Samples from which on a record is long: it is looked at in parts of this length first.
const LONG: usize = 1 << 20;

/// Factor by which the part grows whose frequency is refined. The phase over the longer part is then known to a fraction
/// of a turn from the shorter one.
const GROWTH: usize = 8;

/// Step of the refinement over the deviation of the frequency below which it changes nothing that can be seen.
const NEGLIGIBLE: f64 = 1e-4;

/// How far such a line must stand out of those around it.
const PROMINENCE: f64 = 8.0;

/// Lowest share of the highest line that is tried: the highest may be the fifth harmonic.
const LOWEST_SHARE: usize = 5;

/// A frequency found in a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frequency {
    /// Circular frequency, rad/s.
    pub omega: f64,
    /// Its standard deviation, rad/s.
    pub deviation: f64,
}

/// Finds the fundamental frequency of a record with up to `harmonics` harmonics.
pub fn estimate(record: &Record, harmonics: usize) -> Result<Frequency, FitError> {
    let start = coarse(record, harmonics)?;
    let start = if record.len() > LONG { grown(record, start, harmonics) } else { start };
    refine(record, start, harmonics, &all(record))
}

/// A frequency of a long record that is good to a fraction of a line of the whole of it, from its loudest part outwards.
fn grown(record: &Record, start: f64, harmonics: usize) -> f64 {
    let channels = all(record);
    let (mut omega, mut length) = (start, LONG);
    let middle = loudest(record, &leading(record)) + LONG / 2;
    while length < record.len() {
        let from = middle.saturating_sub(length / 2).min(record.len() - length);
        let found = refine_part(record, from..from + length, omega, harmonics, &channels);
        // A part that says nothing, such as one without motion, changes nothing.
        let line = TAU / (record.step() * length as f64);
        omega = found.map_or(omega, |found| found.omega).clamp(omega - line, omega + line);
        length *= GROWTH;
    }
    omega
}

/// First sample of the part of [`LONG`] samples in which the given channels are largest, each over its own largest.
fn loudest(record: &Record, channels: &[usize]) -> usize {
    let parts: Vec<Range<usize>> = parts(record.len()).collect();
    let mut sizes = vec![0.0; parts.len()];
    for &c in channels {
        let square = |part: &Range<usize>| dot(&record.samples(c)[part.clone()], &record.samples(c)[part.clone()]);
        let squares: Vec<f64> = parts.iter().map(square).collect();
        let most = squares.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        sizes.iter_mut().zip(&squares).for_each(|(size, square)| *size += square / most);
    }
    (0..parts.len()).max_by(|&a, &b| sizes[a].total_cmp(&sizes[b])).map_or(0, |part| parts[part].start)
}

/// Parts of [`LONG`] samples that cover a long record, the last ones overlapping where it is no multiple of them.
fn parts(samples: usize) -> impl Iterator<Item = Range<usize>> {
    let count = samples.div_ceil(LONG).max(2);
    (0..count).map(move |k| k * (samples - LONG) / (count - 1)).map(|from| from..from + LONG)
}

/// Numbers of all channels.
pub(super) fn all(record: &Record) -> Vec<usize> {
    (0..record.channels().len()).collect()
}

/// Numbers of the force channels, or of all where no force oscillates.
pub(super) fn leading(record: &Record) -> Vec<usize> {
    let forces = all(record).into_iter().filter(|&c| record.channels()[c].quantity == Quantity::Force);
    let moving: Vec<usize> = forces.filter(|&c| record.samples(c).iter().any(|y| *y != record.samples(c)[0])).collect();
    if moving.is_empty() { all(record) } else { moving }
}

/// The fundamental within a fraction of a line of the spectrum, rad/s.
pub(super) fn coarse(record: &Record, harmonics: usize) -> Result<f64, FitError> {
    let channels = leading(record);
    let spectra = spectra(record, &channels);
    let highest = spectra.iter().filter_map(Spectrum::highest_peak).fold(0.0_f64, |f, peak| f.max(peak.amplitude));
    let Some(first) = spectra.first().filter(|_| highest > 0.0) else { return Err(FitError::NoOscillation) };
    // Channels of different units count by their own largest line.
    let mut lines = vec![0.0; first.amplitude.len()];
    for spectrum in &spectra {
        let scale = spectrum.highest_peak().map_or(0.0, |peak| 1.0 / peak.amplitude);
        for (line, amplitude) in lines.iter_mut().zip(&spectrum.amplitude) {
            *line += (scale * amplitude).powi(2);
        }
    }
    lines.iter_mut().for_each(|line| *line = line.sqrt());
    let joint = Spectrum { resolution_hz: first.resolution_hz, amplitude: lines };
    let peak = joint.highest_peak().ok_or(FitError::NoOscillation)?;
    let omega = TAU * fundamental(&joint, peak.frequency_hz, peak.amplitude);
    if omega * record.duration() < FEW_PERIODS * TAU { scan(record, omega, harmonics, &channels) } else { Ok(omega) }
}

/// Spectra of channels; of a long record their mean over its parts, where these hold periods enough.
fn spectra(record: &Record, channels: &[usize]) -> Vec<Spectrum> {
    let (time, samples) = (record.time(), |c: usize| record.samples(c));
    if record.len() > LONG {
        let mean_spectrum =
            |c: usize| Spectrum::mean(parts(record.len()).map(|part| spectrum(&time[part.clone()], &samples(c)[part])));
        let means: Vec<Spectrum> = channels.iter().filter_map(|&c| mean_spectrum(c)).collect();
        let slow = |mean: &Spectrum| {
            mean.highest_peak().is_some_and(|peak| peak.frequency_hz < FEW_PERIODS * mean.resolution_hz)
        };
        if !means.iter().any(slow) {
            return means;
        }
    }
    channels.iter().filter_map(|&c| spectrum(time, samples(c))).collect()
}

/// Spectrum of samples without their mean and trend, at even time steps.
fn spectrum(time: &[f64], values: &[f64]) -> Option<Spectrum> {
    let step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let mut at = 0;
    let even: Vec<f64> = (0..time.len())
        .map(|n| {
            let t = time[0] + n as f64 * step;
            while at + 2 < time.len() && time[at + 1] < t {
                at += 1;
            }
            let length = time[at + 1] - time[at];
            let share = if length > 0.0 { ((t - time[at]) / length).clamp(0.0, 1.0) } else { 0.0 };
            values[at] + share * (values[at + 1] - values[at])
        })
        .collect();
    let n = even.len() as f64;
    let (centre, mean) = (0.5 * (n - 1.0), even.iter().sum::<f64>() / n);
    let spread: f64 = (0..even.len()).map(|i| (i as f64 - centre).powi(2)).sum();
    let slope = even.iter().enumerate().map(|(i, y)| (i as f64 - centre) * y).sum::<f64>() / spread;
    let level: Vec<f64> = even.iter().enumerate().map(|(i, y)| y - mean - slope * (i as f64 - centre)).collect();
    Spectrum::new(&level, step)
}

/// The lowest of a half, a third ... of the highest line's frequency where a line stands out; else that frequency.
fn fundamental(spectrum: &Spectrum, frequency_hz: f64, amplitude: f64) -> f64 {
    let found = (2..=LOWEST_SHARE).rev().find_map(|share| {
        let line = (frequency_hz / share as f64 / spectrum.resolution_hz).round() as usize;
        if line < 4 || line + 8 >= spectrum.amplitude.len() {
            return None;
        }
        let around: Vec<f64> = (line.saturating_sub(8).max(1)..line + 9)
            .filter(|k| k.abs_diff(line) > 3)
            .map(|k| spectrum.amplitude[k])
            .collect();
        let near = (line - 1..=line + 1).map(|k| spectrum.amplitude[k]).fold(0.0, f64::max);
        let floor = crate::math::statistics::median(&around);
        (near > SUBHARMONIC * amplitude && near > PROMINENCE * floor).then_some(frequency_hz / share as f64)
    });
    found.unwrap_or(frequency_hz)
}

/// The frequency within 1.2 lines around `omega` that leaves the least of the channels, by trial in tenths of a line.
fn scan(record: &Record, omega: f64, harmonics: usize, channels: &[usize]) -> Result<f64, FitError> {
    let line = TAU / record.duration();
    let trials = (-12..=12).map(|k| omega + 0.1 * f64::from(k) * line);
    let span = Span::new(record, 0..record.len(), channels);
    let best = trials
        .filter_map(|omega| {
            let solved = span.solve(omega, harmonics).ok()?;
            Some((omega, span.cost((0..channels.len()).map(|i| solved.squares(i)))))
        })
        .min_by(|a, b| a.1.total_cmp(&b.1));
    match best {
        Some((omega, _)) => Ok(omega),
        None => resolvable(record.time(), omega, harmonics).and(Err(FitError::NoOscillation)),
    }
}

/// A part of the channels by which a frequency is refined.
struct Span<'a> {
    time: &'a [f64],
    values: Vec<&'a [f64]>,
    /// Squared residual of every channel that rounding leaves.
    rounding: Vec<f64>,
}

impl<'a> Span<'a> {
    fn new(record: &'a Record, range: Range<usize>, channels: &[usize]) -> Self {
        let values: Vec<&[f64]> = channels.iter().map(|&c| &record.samples(c)[range.clone()]).collect();
        let rounding = |values: &&[f64]| (f64::EPSILON.powi(2) * dot(values, values)).max(f64::MIN_POSITIVE);
        Self { time: &record.time()[range], rounding: values.iter().map(rounding).collect(), values }
    }

    fn solve(&self, omega: f64, harmonics: usize) -> Result<Solved<'a>, FitError> {
        solve(self.time, &self.values, omega, resolvable(self.time, omega, harmonics)?)
    }

    /// Log-likelihood of channels whose noise is unknown, but for its sign and a constant: `sum_c ln |r_c|^2`.
    fn cost(&self, squares: impl Iterator<Item = f64>) -> f64 {
        squares.zip(&self.rounding).map(|(squares, rounding)| squares.max(*rounding).ln()).sum()
    }

    /// The step of every channel's residual at a fit.
    fn gradient(&self, solved: &Solved<'_>) -> Gradient {
        let slopes = (0..self.values.len()).map(|i| solved.slope(i)).zip(&self.rounding);
        let information = |(slope, rounding): (Slope, &f64)| {
            let explained = dot(&solved.design.solve(&slope.products), &slope.products);
            let weight = 1.0 / slope.squares.max(*rounding);
            ([weight, slope.along, (slope.length - explained).max(0.0)], slope.squares)
        };
        let (channels, squares): (Vec<[f64; 3]>, Vec<f64>) = slopes.map(information).unzip();
        Gradient { channels, cost: self.cost(squares.into_iter()) }
    }
}

/// What a fit says of its frequency.
struct Gradient {
    /// Of every channel its weight `1 / |r|^2`, `J^T r`, and `|P J|^2`.
    channels: Vec<[f64; 3]>,
    cost: f64,
}

impl Gradient {
    /// `sum w |P J|^2`.
    fn information(&self) -> f64 {
        self.channels.iter().map(|[weight, _, free]| weight * free).sum()
    }

    /// One step of Gauss-Newton.
    fn step(&self) -> f64 {
        self.channels.iter().map(|[weight, along, _]| weight * along).sum::<f64>() / self.information()
    }
}

/// Refines `omega` (rad/s, within a fraction of a line of the truth) by least squares over the given channels.
pub(super) fn refine(record: &Record, start: f64, harmonics: usize, channels: &[usize]) -> Result<Frequency, FitError> {
    refine_part(record, 0..record.len(), start, harmonics, channels)
}

fn refine_part(
    record: &Record,
    range: Range<usize>,
    start: f64,
    harmonics: usize,
    channels: &[usize],
) -> Result<Frequency, FitError> {
    let span = Span::new(record, range, channels);
    let samples = span.time.len();
    let half = 0.5 * (span.time[samples - 1] - span.time[0]);
    let mut omega = start;
    let mut solved = span.solve(omega, harmonics)?;
    let mut here = span.gradient(&solved);
    for _ in 0..MOST_STEPS {
        let step = here.step().clamp(-LARGEST_TURN / half, LARGEST_TURN / half);
        // With residuals as noise the variance of the frequency is 1 / (n sum w |P J|^2).
        let negligible = NEGLIGIBLE / (samples as f64 * here.information()).sqrt();
        let standstill = STANDSTILL.max(ROUNDINGS * f64::EPSILON * omega * half);
        if !step.is_finite() || (step * half).abs() < standstill || step.abs() < negligible {
            break;
        }
        let next = span.solve(omega + step, harmonics)?;
        let there = span.gradient(&next);
        // At the floor of rounding the cost no longer falls; the step is then below the deviation.
        if there.cost > here.cost {
            break;
        }
        (omega, solved, here) = (omega + step, next, there);
    }
    Ok(Frequency { omega, deviation: deviation(&span, &solved, &here, omega) })
}

/// Standard deviation of the frequency: `sqrt(sum w^2 s^2 |P J|^2) / sum w |P J|^2` with the noise `s` of each channel.
fn deviation(span: &Span<'_>, solved: &Solved<'_>, gradient: &Gradient, omega: f64) -> f64 {
    let lag = Lag::new(span.time, TAU / omega);
    let noise =
        |i: usize| lag.as_ref().map_or_else(|| solved.residual_variance(i), |l| l.variance(&solved.residual(i)));
    let channels = gradient.channels.iter().enumerate();
    let variance: f64 = channels.map(|(i, [weight, _, free])| weight * weight * noise(i) * free).sum();
    let information = gradient.information();
    if information > 0.0 { variance.sqrt() / information } else { 0.0 }
}
