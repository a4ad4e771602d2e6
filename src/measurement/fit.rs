//! Harmonics fitted to a record by linear least squares, with their covariance.
//!
//! `y(t) = y_0 + slope (t - t_mid) + Re sum_h Y_h exp(i h omega t)`, `Y = a - i b` for `a cos + b sin` (6.4).
//!
//! The whole record is used, whether or not it holds whole periods and even time steps. The covariance is the variance
//! of the noise times the inverse normal matrix. The noise is the scatter between periods (`noise.rs`) where the record
//! holds two or more, else the residual over its degrees of freedom.

use super::channel::Channel;
use super::design::Design;
use super::higher_harmonics::{further, leaks};
use super::noise::Lag;
use super::record::Record;
use super::slope::Slope;
use crate::math::numerals::significant;
use dashpot_numerics::dot;
use faer::{Mat, c64};
use std::f64::consts::TAU;

/// Fewest periods whose scatter gives the noise; it is unbiased from the second period on.
const FEWEST_PERIODS_FOR_SCATTER: f64 = 2.0;

/// Fewest samples over unknowns: the noise could not be told from the signal otherwise.
const FEWEST_SAMPLES_PER_UNKNOWN: usize = 2;

/// Rounding of a sample in the last place that it was computed to, relative to the largest.
const ROUNDING: f64 = f64::EPSILON;

/// Why a record cannot be fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum FitError {
    #[error("the frequency is {frequency_hz} Hz; give a positive number of hertz")]
    BadFrequency { frequency_hz: f64 },
    #[error("no harmonic was asked for; set harmonics to 1 or more")]
    NoHarmonics,
    #[error(
        "the record lasts {duration} s, less than one period of {frequency_hz} Hz; record longer or correct the frequency"
    )]
    TooShort { duration: f64, frequency_hz: f64 },
    #[error(
        "{} samples a second cannot resolve {} Hz; sample more than twice a period or correct the frequency",
        significant(*rate_hz, 6), significant(*frequency_hz, 6)
    )]
    Unresolved { rate_hz: f64, frequency_hz: f64 },
    #[error("{samples} samples cannot determine {unknowns} unknowns; record at least {needed} samples")]
    TooFewSamples { samples: usize, unknowns: usize, needed: usize },
    #[error("the samples leave parts of the period of {frequency_hz} Hz unseen; record without gaps")]
    Undetermined { frequency_hz: f64 },
    #[error("no channel oscillates, so the frequency cannot be found; give it, or check the sensors")]
    NoOscillation,
}

/// The harmonics of one channel: `y(t) = offset + slope (t - t_mid) + Re sum_h Y_h exp(i h omega t)`, SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelFit {
    /// The channel.
    pub channel: Channel,
    /// Offset in the middle of the record.
    pub offset: f64,
    /// Slope, per second.
    pub slope: f64,
    /// Complex amplitudes `Y_h` of harmonics 1..H of the recorded quantity (not integrated).
    pub amplitudes: Vec<c64>,
    /// Covariance of `(Re Y_1, Im Y_1, Re Y_2, Im Y_2, ...)`, 2H x 2H.
    pub covariance: Mat<f64>,
    /// Standard deviation of the noise of one sample.
    pub noise: f64,
}

impl ChannelFit {
    /// Standard deviation of the complex amplitude of harmonic `h` (1-based): root of the mean of both variances.
    pub fn deviation(&self, h: usize) -> f64 {
        let i = 2 * (h - 1);
        (0.5 * (self.covariance[(i, i)] + self.covariance[(i + 1, i + 1)])).sqrt()
    }

    /// Whether the deviations are known: false for harmonics that came from a file without them.
    pub fn has_deviation(&self) -> bool {
        (0..self.covariance.nrows()).any(|i| self.covariance[(i, i)] > 0.0)
    }
}

/// The harmonics of all channels of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct HarmonicFit {
    /// Fundamental circular frequency, rad/s.
    pub omega: f64,
    /// Standard deviation of `omega` where it was estimated from the record, else 0.
    pub omega_deviation: f64,
    /// Channels; force channels included.
    pub channels: Vec<ChannelFit>,
}

impl HarmonicFit {
    /// Number of harmonics fitted, H.
    pub fn harmonics(&self) -> usize {
        self.channels.first().map_or(0, |c| c.amplitudes.len())
    }

    /// Period, s.
    pub fn period(&self) -> f64 {
        TAU / self.omega
    }
}

/// A fit with what it leaves of every channel.
#[derive(Debug)]
pub(super) struct Solved<'a> {
    pub(super) design: Design<'a>,
    /// Unknowns of every channel: offset, slope times half of the duration, cos 1, sin 1, ...
    pub(super) unknowns: Vec<Vec<f64>>,
    /// The samples of every channel.
    values: Vec<&'a [f64]>,
    /// Unknowns before digits that an offset or a slope cost were won back.
    first: Vec<Vec<f64>>,
}

/// Fits harmonics 1 to `harmonics` of the circular frequency `omega` (rad/s) to every channel.
///
/// Higher ones that would leak into these are fitted beside them. Harmonics that the sampling cannot resolve are left out:
/// harmonic `h` needs `h f <= f_s/2 - 1/duration`, so that it and its mirror image are at least two lines apart, and the record two
/// samples an unknown.
///
/// # Errors
/// [`FitError`] where not even the first harmonic can be fitted, or the record is shorter than a period.
pub fn fit(record: &Record, omega: f64, harmonics: usize) -> Result<HarmonicFit, FitError> {
    let harmonics = resolvable(record.time(), omega, harmonics)?;
    let values: Vec<&[f64]> = record.samples.iter().map(Vec::as_slice).collect();
    let (solved, noise) = solve_without_leakage(record, &values, omega, harmonics)?;
    let channels = record.channels().iter().enumerate().map(|(c, channel)| {
        let (mut amplitudes, unit_covariance) = solved.amplitudes(c, omega);
        amplitudes.truncate(harmonics);
        let unit_covariance = unit_covariance.submatrix(0, 0, 2 * harmonics, 2 * harmonics).to_owned();
        ChannelFit {
            channel: channel.clone(),
            offset: solved.unknowns[c][0],
            slope: solved.unknowns[c][1] / solved.design.half,
            amplitudes,
            covariance: faer::Scale(noise[c]) * unit_covariance,
            noise: noise[c].sqrt(),
        }
    });
    Ok(HarmonicFit { omega, omega_deviation: 0.0, channels: channels.collect() })
}

/// The fit of harmonics up to `harmonics`, or up to more, so that none that is left out adds to these more than a share of their noise;
/// with the variance of the noise of one sample of every channel.
fn solve_without_leakage<'a>(
    record: &'a Record,
    values: &[&'a [f64]],
    omega: f64,
    harmonics: usize,
) -> Result<(Solved<'a>, Vec<f64>), FitError> {
    let (time, count) = (record.time(), record.len());
    let periods = record.duration() * count as f64 / (count as f64 - 1.0) * omega / TAU;
    let mut fitted = harmonics;
    let mut solved = solve(time, values, omega, fitted)?;
    loop {
        let noise = noise_variances(record, omega, &solved);
        let more = resolvable(time, omega, further(fitted))?;
        let left = |c: usize| solved.squares(c) / count as f64;
        if more <= fitted || !noise.iter().enumerate().any(|(c, noise)| leaks(periods, count, left(c), *noise)) {
            return Ok((solved, noise));
        }
        // Records with gaps may not determine more.
        let Ok(wider) = solve(time, values, omega, more) else { return Ok((solved, noise)) };
        (solved, fitted) = (wider, more);
    }
}

/// The number of harmonics that samples at these times resolve, at most `harmonics`.
pub(super) fn resolvable(time: &[f64], omega: f64, harmonics: usize) -> Result<usize, FitError> {
    let frequency_hz = omega / TAU;
    if !(frequency_hz.is_finite() && frequency_hz > 0.0) {
        return Err(FitError::BadFrequency { frequency_hz });
    }
    if harmonics == 0 {
        return Err(FitError::NoHarmonics);
    }
    let samples = time.len();
    let duration = time[samples - 1] - time[0];
    let step = duration / (samples - 1) as f64;
    // The last sample ends a period as well as the first of the next would.
    if (duration + step) * frequency_hz < 1.0 - 1e-9 {
        return Err(FitError::TooShort { duration, frequency_hz });
    }
    let highest = (0.5 / step - 1.0 / duration) / frequency_hz;
    if highest < 1.0 {
        return Err(FitError::Unresolved { rate_hz: 1.0 / step, frequency_hz });
    }
    let by_count = (samples / FEWEST_SAMPLES_PER_UNKNOWN).saturating_sub(2) / 2;
    if by_count == 0 {
        let needed = 4 * FEWEST_SAMPLES_PER_UNKNOWN;
        return Err(FitError::TooFewSamples { samples, unknowns: 4, needed });
    }
    Ok(harmonics.min(highest as usize).min(by_count))
}

/// Fits slices of channels at slices of times. Where an offset, a slope or a broken period costs digits, the residual is
/// solved again, and they come back.
pub(super) fn solve<'a>(
    time: &'a [f64],
    values: &[&'a [f64]],
    omega: f64,
    harmonics: usize,
) -> Result<Solved<'a>, FitError> {
    let undetermined = FitError::Undetermined { frequency_hz: omega / TAU };
    let design = Design::new(time, omega, harmonics).ok_or(undetermined)?;
    let first: Vec<Vec<f64>> = design.products(values).iter().map(|b| design.solve(b)).collect();
    let mut unknowns = first.clone();
    let lost = (0..values.len()).filter(|&c| loses_digits(&design, &first[c]));
    for c in lost {
        let products = design.products(&[&design.residual(values[c], &first[c])]);
        for (u, correction) in unknowns[c].iter_mut().zip(design.solve(&products[0])) {
            *u += correction;
        }
    }
    Ok(Solved { design, unknowns, values: values.to_vec(), first })
}

/// Whether the amplitudes lose more than a digit to the offset, the slope or columns that resemble each other.
fn loses_digits(design: &Design<'_>, unknowns: &[f64]) -> bool {
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    design.independence < 0.1 || largest(&unknowns[..2]) > 10.0 * largest(&unknowns[2..])
}

impl Solved<'_> {
    /// Amplitudes of a channel at time zero, and their covariance for noise of variance 1.
    pub(super) fn amplitudes(&self, channel: usize, omega: f64) -> (Vec<c64>, Mat<f64>) {
        let unknowns = &self.unknowns[channel];
        let harmonics = unknowns.len() / 2 - 1;
        let turns: Vec<c64> = (1..=harmonics)
            .map(|h| {
                let (sin, cos) = (h as f64 * omega * self.design.middle).sin_cos();
                c64::new(cos, -sin)
            })
            .collect();
        let amplitudes =
            (0..harmonics).map(|h| c64::new(unknowns[2 * h + 2], -unknowns[2 * h + 3]) * turns[h]).collect();
        // (a, -b) are the real and imaginary part in the middle of the record; turning is a rotation of each pair.
        let sign = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        let inverse = &self.design.inverse;
        let middle = Mat::from_fn(2 * harmonics, 2 * harmonics, |i, j| sign(i) * sign(j) * inverse[(i + 2, j + 2)]);
        (amplitudes, turn_covariance(&middle, &turns))
    }

    /// What the fit leaves of a channel. It is made anew at each call: of a long record it is as large as the channel.
    pub(super) fn residual(&self, channel: usize) -> Vec<f64> {
        self.design.residual(self.values[channel], &self.first[channel])
    }

    /// What the fit leaves of a channel beside its derivative by the frequency.
    pub(super) fn slope(&self, channel: usize) -> Slope {
        self.design.slope(self.values[channel], &self.first[channel], &self.unknowns[channel])
    }

    /// Sum of the squares of what the fit leaves of a channel.
    pub(super) fn squares(&self, channel: usize) -> f64 {
        let mut squares = 0.0;
        self.design.each_residual(self.values[channel], &self.first[channel], |_, left| squares += dot(left, left));
        squares
    }

    /// Variance of one sample from the residual over its degrees of freedom.
    pub(super) fn residual_variance(&self, channel: usize) -> f64 {
        let freedom = self.values[channel].len().saturating_sub(self.design.unknowns()).max(1);
        self.squares(channel) / freedom as f64
    }
}

/// Covariance of amplitudes that are each multiplied by a complex number: `B V B^T` with the 2 x 2 blocks of `B`.
pub(super) fn turn_covariance(covariance: &Mat<f64>, factors: &[c64]) -> Mat<f64> {
    let n = covariance.nrows();
    let block = |i: usize| {
        let z = factors[i / 2];
        if i.is_multiple_of(2) { [z.re, -z.im] } else { [z.im, z.re] }
    };
    Mat::from_fn(n, n, |i, j| {
        let (a, b) = (block(i), block(j));
        let (r, c) = (i - i % 2, j - j % 2);
        (0..2).map(|p| (0..2).map(|q| a[p] * covariance[(r + p, c + q)] * b[q]).sum::<f64>()).sum()
    })
}

/// Variance of the noise of one sample of every channel.
fn noise_variances(record: &Record, omega: f64, solved: &Solved<'_>) -> Vec<f64> {
    let period = TAU / omega;
    let periods = record.duration() / period;
    let enough = periods + 1e-9 >= FEWEST_PERIODS_FOR_SCATTER;
    let lag = if enough { Lag::new(record.time(), period) } else { None };
    let variance = |c: usize| {
        let measured = lag.as_ref().map_or_else(|| solved.residual_variance(c), |l| l.variance(&solved.residual(c)));
        let largest = record.samples(c).iter().fold(0.0_f64, |most, y| most.max(y.abs()));
        // Rounding that repeats in every period shows in no scatter, and averaging over periods does not lessen it.
        let rounding = record.resolution(c).powi(2) / 12.0;
        let hidden = (rounding - measured).max(0.0) * periods.max(1.0);
        (measured + hidden).max((ROUNDING * largest).powi(2))
    };
    (0..record.channels().len()).map(variance).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::measurement::channel::Quantity;

    /// 20.4 periods of a fundamental with harmonics 2 to 15 of a tenth each: the three that are asked for are those that are there.
    #[test]
    fn harmonics_above_those_asked_for_do_not_leak_into_them() {
        let (omega, rate) = (TAU, 64.0);
        let time: Vec<f64> = (0..(20.4 * rate) as usize).map(|n| n as f64 / rate).collect();
        let size = |h: usize| if h == 1 { 1.0 } else { 0.1 };
        let value = |t: &f64| (1..=15).map(|h| size(h) * (h as f64 * omega * t).cos()).sum::<f64>();
        let samples = vec![time.iter().map(value).collect()];
        let channel = Channel { quantity: Quantity::Acceleration, dof: 0, label: "1".into() };
        let record = Record::new(time, vec![channel], samples).unwrap();
        let fitted = fit(&record, omega, 3).unwrap();
        assert_eq!(fitted.harmonics(), 3);
        for (i, amplitude) in fitted.channels[0].amplitudes.iter().enumerate() {
            assert!((amplitude - size(i + 1)).norm() < 1e-9, "{amplitude} of harmonic {}", i + 1);
        }
    }
}
