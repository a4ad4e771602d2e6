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

use super::fit::{Solved, resolvable, solve};
use super::noise::Lag;
use super::{FitError, Quantity, Record};
use crate::math::spectrum::Spectrum;
use dashpot_numerics::dot;
use std::f64::consts::TAU;

/// Most steps of the refinement; four are usual.
const MOST_STEPS: usize = 30;

/// Largest phase that a step may turn over half of the record, rad: beyond, the linearisation is worth nothing.
const LARGEST_TURN: f64 = 1.0;

/// Phase over half of the record below which the frequency stands still, rad.
const STANDSTILL: f64 = 1e-13;

/// Periods below which lines of the spectrum are too broad to start from: the neighbourhood is scanned instead.
const FEW_PERIODS: f64 = 8.0;

/// Share of the highest line at which a line at a half, a third ... of its frequency is the fundamental.
const SUBHARMONIC: f64 = 0.02;

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
    refine(record, coarse(record, harmonics)?, harmonics, &all(record))
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
    let spectra: Vec<Spectrum> = channels.iter().filter_map(|&c| spectrum(record, c)).collect();
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

/// Spectrum of a channel without its mean and trend, at even time steps.
fn spectrum(record: &Record, channel: usize) -> Option<Spectrum> {
    let (time, values) = (record.time(), record.samples(channel));
    let step = record.step();
    let mut at = 0;
    let even: Vec<f64> = (0..record.len())
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
    let best = trials
        .filter_map(|omega| {
            Some((omega, cost(&solve_channels(record, omega, harmonics, channels).ok()?, record, channels)))
        })
        .min_by(|a, b| a.1.total_cmp(&b.1));
    match best {
        Some((omega, _)) => Ok(omega),
        None => resolvable(record.time(), omega, harmonics).and(Err(FitError::NoOscillation)),
    }
}

fn solve_channels<'a>(
    record: &'a Record,
    omega: f64,
    harmonics: usize,
    channels: &[usize],
) -> Result<Solved<'a>, FitError> {
    let harmonics = resolvable(record.time(), omega, harmonics)?;
    let values: Vec<&[f64]> = channels.iter().map(|&c| record.samples(c)).collect();
    solve(record.time(), &values, omega, harmonics)
}

/// Log-likelihood of channels whose noise is unknown, but for its sign and a constant: `sum_c ln |r_c|^2`.
fn cost(solved: &Solved<'_>, record: &Record, channels: &[usize]) -> f64 {
    channels.iter().enumerate().map(|(i, &c)| squares(solved, record, i, c).ln()).sum()
}

/// Squared residual of a channel, at least that of rounding.
fn squares(solved: &Solved<'_>, record: &Record, i: usize, channel: usize) -> f64 {
    let values = record.samples(channel);
    let rounding = (f64::EPSILON.powi(2) * dot(values, values)).max(f64::MIN_POSITIVE);
    dot(&solved.residuals[i], &solved.residuals[i]).max(rounding)
}

/// Refines `omega` (rad/s, within a fraction of a line of the truth) by least squares over the given channels.
pub(super) fn refine(record: &Record, start: f64, harmonics: usize, channels: &[usize]) -> Result<Frequency, FitError> {
    let half = 0.5 * record.duration();
    let mut omega = start;
    let mut solved = solve_channels(record, omega, harmonics, channels)?;
    let mut lowest = cost(&solved, record, channels);
    for _ in 0..MOST_STEPS {
        let step = step(&solved, record, channels).clamp(-LARGEST_TURN / half, LARGEST_TURN / half);
        if !step.is_finite() || (step * half).abs() < STANDSTILL {
            break;
        }
        let next = solve_channels(record, omega + step, harmonics, channels)?;
        let cost = cost(&next, record, channels);
        // At the floor of rounding the cost no longer falls; the step is then below the deviation.
        if cost > lowest {
            break;
        }
        (omega, solved, lowest) = (omega + step, next, cost);
    }
    Ok(Frequency { omega, deviation: deviation(&solved, record, omega, channels) })
}

/// One step of Gauss-Newton.
fn step(solved: &Solved<'_>, record: &Record, channels: &[usize]) -> f64 {
    let (mut along, mut square) = (0.0, 0.0);
    for (i, &c) in channels.iter().enumerate() {
        let weight = 1.0 / squares(solved, record, i, c);
        let (derivative, free) = derivative(solved, i);
        along += weight * dot(&derivative, &solved.residuals[i]);
        square += weight * free;
    }
    along / square
}

/// Derivative of a channel's fit by the frequency, and its squared length where the columns do not explain it.
fn derivative(solved: &Solved<'_>, i: usize) -> (Vec<f64>, f64) {
    let u = &solved.unknowns[i];
    let mut turned = vec![0.0; u.len()];
    for h in 1..u.len() / 2 {
        turned[2 * h] = -(h as f64) * u[2 * h + 1];
        turned[2 * h + 1] = h as f64 * u[2 * h];
    }
    let derivative = solved.design.times_moment(&turned);
    let products = solved.design.products(&[&derivative]);
    let explained = dot(&solved.design.solve(&products[0]), &products[0]);
    let free = (dot(&derivative, &derivative) - explained).max(0.0);
    (derivative, free)
}

/// Standard deviation of the frequency: `sqrt(sum w^2 s^2 |P J|^2) / sum w |P J|^2` with the noise `s` of each channel.
fn deviation(solved: &Solved<'_>, record: &Record, omega: f64, channels: &[usize]) -> f64 {
    let lag = Lag::new(record.time(), TAU / omega);
    let (mut variance, mut information) = (0.0, 0.0);
    for (i, &c) in channels.iter().enumerate() {
        let weight = 1.0 / squares(solved, record, i, c);
        let noise = lag.as_ref().map_or_else(|| solved.residual_variance(i), |l| l.variance(&solved.residuals[i]));
        let (_, free) = derivative(solved, i);
        variance += weight * weight * noise * free;
        information += weight * free;
    }
    if information > 0.0 { variance.sqrt() / information } else { 0.0 }
}
