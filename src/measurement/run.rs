//! One run: a steady-state test under one periodic force.
//!
//! A channel with a known delay `tau` and gain `g` records `g exp(-i h omega tau) Y_h`; its fit is divided by that.
//! Motions are integrated analytically: `X_h = Y_h / (i h omega)^k`, k = 0, 1, 2 for displacements, velocities and
//! accelerations (6.5, 6.6).

use super::channel::{Channel, Quantity};
use super::finding::{Finding, Flag};
use super::fit::{ChannelFit, FitError, HarmonicFit, fit, turn_covariance};
use super::record::Record;
use super::signal::references;
use super::whole_functions::WholeFunctions;
use super::{dead, frequency, quality};
use faer::{Mat, c64};
use std::f64::consts::TAU;
use std::sync::Arc;

/// One run with its fitted harmonics, corrected for the known errors of its channels.
#[derive(Debug, Clone, PartialEq)]
#[allow(clippy::struct_excessive_bools, reason = "each is a fact of its own, and all may be true")]
pub struct Run {
    /// Name of the file (or of the run in a harmonics file), for messages and results.
    pub file: String,
    /// Label of the force level.
    pub level: Option<i64>,
    /// Name of the session it was measured in: what was dismounted or re-seated between two sessions may differ.
    pub session: Option<String>,
    /// Whether the user wants it used.
    pub enabled: bool,
    /// Whether the user says so in so many words (`use = true`), which a flag does not overrule.
    pub insisted: bool,
    /// Time record, where there is one.
    pub record: Option<Arc<Record>>,
    /// Harmonics of every channel.
    pub fit: HarmonicFit,
    /// Noise over signal, root mean square over the channels.
    pub noise_ratio: f64,
    /// What is wrong with the record, each with its reason in words.
    pub findings: Vec<Finding>,
    /// Whether it is a line of a frequency response, per unit force: what depends on amplitude cannot be told from it.
    pub per_unit_force: bool,
    /// The frequency responses that it is a line of, on all their lines.
    pub functions: Option<Arc<WholeFunctions>>,
    /// Whether the structure stood on a moving base: its forces are then loads of its masses, `-M r a`.
    pub on_moving_base: bool,
}

/// The known error of a channel: recorded = gain x true, late by the delay.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelCorrection {
    /// The channel, by quantity and label.
    pub channel: Channel,
    /// How late it is recorded, s.
    pub delay: f64,
    /// How many times too large it reads; not zero.
    pub gain: f64,
}

impl ChannelCorrection {
    /// Whether it is that of a channel.
    pub(crate) fn is_of(&self, channel: &Channel) -> bool {
        self.channel.quantity == channel.quantity && self.channel.label == channel.label
    }

    /// What undoes the error at a circular frequency, `exp(i omega delay) / gain`.
    pub(crate) fn undone(&self, omega: f64) -> c64 {
        let (sin, cos) = (omega * self.delay).sin_cos();
        c64::new(cos, sin) / self.gain
    }
}

/// Harmonics of the displacement or the force at a DOF, with their covariance.
#[derive(Debug, Clone, PartialEq)]
pub struct Amplitudes {
    /// Number of the channel in [`HarmonicFit::channels`]; the first where several were combined.
    pub channel: usize,
    /// Row of the DOF.
    pub dof: usize,
    /// Complex amplitudes of harmonics 1..H, m or N (rad or N m at rotations).
    pub amplitudes: Vec<c64>,
    /// Covariance of `(Re X_1, Im X_1, ...)`, 2H x 2H; zero where the deviations are unknown.
    pub covariance: Mat<f64>,
}

impl Run {
    /// Fits a record: at `frequency_hz`, or at the frequency found in it.
    pub fn from_record(
        file: String,
        level: Option<i64>,
        enabled: bool,
        record: Arc<Record>,
        frequency_hz: Option<f64>,
        harmonics: usize,
        corrections: &[ChannelCorrection],
    ) -> Result<Self, FitError> {
        let raw = fit_at(&record, frequency_hz, harmonics)?;
        let noise_ratio = noise_ratio(&raw);
        let mut findings = quality::assess_record(&record, &raw, frequency_hz);
        let run = Self::from_harmonics(file, level, enabled, raw, corrections);
        findings.extend(run.findings);
        Ok(Self { record: Some(record), noise_ratio, findings, ..run })
    }

    /// Takes harmonics that were fitted elsewhere.
    pub fn from_harmonics(
        file: String,
        level: Option<i64>,
        enabled: bool,
        fit: HarmonicFit,
        corrections: &[ChannelCorrection],
    ) -> Self {
        let fit = corrected(fit, corrections);
        let findings = quality::assess_harmonics(&fit);
        Self {
            noise_ratio: noise_ratio(&fit),
            file,
            level,
            session: None,
            enabled,
            insisted: false,
            record: None,
            fit,
            findings,
            per_unit_force: false,
            functions: None,
            on_moving_base: false,
        }
    }

    /// Whether it takes part in fits and errors: it is wanted, and its record is of a steady motion or is wanted all the
    /// same.
    pub fn is_used(&self) -> bool {
        self.enabled && (self.insisted || self.why_not_steady().is_none())
    }

    /// The finding that keeps it from being used unless it is insisted on: its motion is not steady, or a force is measured
    /// and none acts.
    pub fn why_not_steady(&self) -> Option<&Finding> {
        let unsteady = |finding: &&Finding| matches!(finding.flag, Flag::NotSettled | Flag::NotPeriodic);
        self.findings.iter().find(unsteady).or_else(|| self.why_without_force())
    }

    fn why_without_force(&self) -> Option<&Finding> {
        let forces = self.fit.force_channels();
        let first = &self.fit.channels[*forces.first()?].channel;
        let silent = forces.iter().all(|&c| dead::is_silent(&self.fit.channels[c], self.record.as_deref()));
        let of_force =
            |finding: &&Finding| finding.flag == Flag::DeadChannel && finding.channel.as_ref() == Some(first);
        self.findings.iter().find(of_force).filter(|_| silent)
    }

    /// The run without the channels of motion that stand still over the whole record, which their findings say; as it is
    /// where it is insisted on, or where nothing would be left.
    #[must_use]
    pub fn without_dead_channels(mut self) -> Self {
        let record = self.record.clone();
        let is_dead = |channel: &ChannelFit| {
            !matches!(channel.channel.quantity, Quantity::Force | Quantity::Base)
                && dead::stands_still(channel, record.as_deref())
        };
        let dead: Vec<Channel> = self.fit.channels.iter().filter(|c| is_dead(c)).map(|c| c.channel.clone()).collect();
        if self.insisted || dead.is_empty() || dead.len() >= self.response_channels().len() {
            return self;
        }
        self.fit.channels.retain(|channel| !is_dead(channel));
        for finding in self.findings.iter_mut().filter(|finding| finding.flag == Flag::DeadChannel) {
            if let Some(channel) = finding.channel.as_ref().filter(|channel| dead.contains(channel)) {
                finding.reason = format!(
                    "{channel} does not move at all: the channel is left out (`use = true` at the run keeps it)"
                );
            }
        }
        self.noise_ratio = noise_ratio(&self.fit);
        self
    }

    /// Frequency, Hz.
    pub fn frequency_hz(&self) -> f64 {
        self.fit.omega / TAU
    }

    /// Numbers of the channels that measure motion.
    pub fn response_channels(&self) -> Vec<usize> {
        self.fit.response_channels()
    }
}

impl HarmonicFit {
    /// Numbers of the channels that measure motion.
    pub fn response_channels(&self) -> Vec<usize> {
        (0..self.channels.len()).filter(|&c| self.channels[c].channel.quantity != Quantity::Force).collect()
    }

    /// Numbers of the channels that measure forces.
    pub fn force_channels(&self) -> Vec<usize> {
        (0..self.channels.len()).filter(|&c| self.channels[c].channel.quantity == Quantity::Force).collect()
    }

    /// Displacement that a channel stands for (a force stays a force), `X_h = Y_h / (i h omega)^k`.
    pub fn displacement_of(&self, channel: usize) -> Amplitudes {
        let fit = &self.channels[channel];
        let k = fit.channel.quantity.derivatives().unwrap_or(0);
        let factors: Vec<c64> =
            (1..=fit.amplitudes.len()).map(|h| c64::new(0.0, h as f64 * self.omega).powi(-k)).collect();
        Amplitudes {
            channel,
            dof: fit.channel.dof,
            amplitudes: fit.amplitudes.iter().zip(&factors).map(|(y, z)| y * z).collect(),
            covariance: turn_covariance(&fit.covariance, &factors),
        }
    }

    /// Displacement at a DOF, several channels combined by their variances; `None` where nothing measures it.
    pub fn displacement(&self, dof: usize) -> Option<Amplitudes> {
        let at_dof = self.response_channels().into_iter().filter(|&c| self.channels[c].channel.dof == dof);
        let all: Vec<Amplitudes> = at_dof.map(|c| self.displacement_of(c)).collect();
        combine(all)
    }

    /// Force of the exciter at a DOF; `None` where there is no force channel.
    pub fn force(&self, dof: usize) -> Option<Amplitudes> {
        self.force_channels()
            .into_iter()
            .find(|&c| self.channels[c].channel.dof == dof)
            .map(|c| self.displacement_of(c))
    }
}

/// Mean of measurements of the same, each harmonic weighted by the inverse of its variance; equal weights where a
/// variance is unknown.
fn combine(all: Vec<Amplitudes>) -> Option<Amplitudes> {
    if all.len() < 2 {
        return all.into_iter().next();
    }
    let harmonics = all[0].amplitudes.len();
    let variance = |a: &Amplitudes, h: usize| a.covariance[(2 * h, 2 * h)] + a.covariance[(2 * h + 1, 2 * h + 1)];
    let shares: Vec<Vec<f64>> = (0..harmonics)
        .map(|h| {
            let known = all.iter().all(|a| variance(a, h) > 0.0);
            let weights: Vec<f64> = all.iter().map(|a| if known { 1.0 / variance(a, h) } else { 1.0 }).collect();
            let total: f64 = weights.iter().sum();
            weights.into_iter().map(|w| w / total).collect()
        })
        .collect();
    let mut mean = Amplitudes {
        channel: all[0].channel,
        dof: all[0].dof,
        amplitudes: vec![c64::new(0.0, 0.0); harmonics],
        covariance: Mat::zeros(2 * harmonics, 2 * harmonics),
    };
    for (k, one) in all.iter().enumerate() {
        let factors: Vec<c64> = shares.iter().map(|share| c64::new(share[k], 0.0)).collect();
        for h in 0..harmonics {
            mean.amplitudes[h] += one.amplitudes[h] * factors[h];
        }
        mean.covariance += turn_covariance(&one.covariance, &factors);
    }
    Some(mean)
}

/// Fits at the given frequency, or at that found in the record, whose deviation is then kept.
pub(crate) fn fit_at(record: &Record, frequency_hz: Option<f64>, harmonics: usize) -> Result<HarmonicFit, FitError> {
    if let Some(frequency_hz) = frequency_hz {
        return fit(record, TAU * frequency_hz, harmonics);
    }
    let found = frequency::estimate(record, harmonics)?;
    let fit = fit(record, found.omega, harmonics)?;
    Ok(HarmonicFit { omega_deviation: found.deviation, ..fit })
}

/// The fit with the known errors of its channels taken out.
fn corrected(mut fit: HarmonicFit, corrections: &[ChannelCorrection]) -> HarmonicFit {
    let omega = fit.omega;
    for channel in &mut fit.channels {
        for error in corrections {
            if error.is_of(&channel.channel) {
                correct(channel, error, omega);
            }
        }
    }
    fit
}

/// Divides a channel by the transfer function of its error.
fn correct(channel: &mut ChannelFit, error: &ChannelCorrection, omega: f64) {
    let factors: Vec<c64> = (1..=channel.amplitudes.len()).map(|h| error.undone(h as f64 * omega)).collect();
    for (y, z) in channel.amplitudes.iter_mut().zip(&factors) {
        *y *= z;
    }
    channel.covariance = turn_covariance(&channel.covariance, &factors);
    channel.offset /= error.gain;
    channel.slope /= error.gain;
    channel.noise /= error.gain.abs();
}

/// Noise over signal, root mean square over the channels that show anything.
fn noise_ratio(fit: &HarmonicFit) -> f64 {
    let ratios: Vec<f64> = fit
        .channels
        .iter()
        .zip(references(fit))
        .filter(|(_, reference)| *reference > 0.0)
        .map(|(channel, reference)| channel.noise / reference)
        .collect();
    crate::math::statistics::root_mean_square(&ratios)
}
