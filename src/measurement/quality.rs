//! Quality of a record: what an engineer should know before trusting it.
//!
//! Nothing is corrected here; every finding says why in numbers. Thresholds are named, with their reasons.

use super::finding::{Finding, Flag};
use super::fit::{ChannelFit, HarmonicFit};
use super::record::Record;
use super::signal::references;
use super::{decay, settling, slips, stuck};
use faer::c64;

/// Noise over signal from which a run is called noisy. The thesis works with 5 %; at 20 % a record of 1000 samples
/// still gives amplitudes to 1 %, but more is a fault of cabling or range rather than of the sensor.
pub const NOISY: f64 = 0.2;

/// Change of the energy by one degree of phase from which a run is called phase-sensitive: sensors of good quality are
/// matched to about a degree, and a tenth of the damping is more than noise does.
pub const PHASE_SENSITIVE: f64 = 0.1;

/// Probability with which noise alone shows harmonics that pass for a signal.
const DEAD_BY_CHANCE: f64 = 1e-3;

/// What takes the record to see; the fit is that of the record as it is, known errors not corrected.
pub(super) fn assess_record(record: &Record, fit: &HarmonicFit, frequency_hz: Option<f64>) -> Vec<Finding> {
    let slip = frequency_hz.and_then(|given| slips::wrong_frequency(record, fit, given));
    // A free decay has a frequency that moves; a record at another frequency shows drift everywhere, and the frequency is
    // what has to be mended.
    let free = if fit.force_channels().is_empty() { decay::free_decay(record, fit) } else { None };
    let mut findings: Vec<Finding> = match (free, slip) {
        (Some(free), _) => vec![free],
        (None, Some(slip)) => vec![slip],
        (None, None) => decay::not_periodic(fit).or_else(|| settling::not_settled(record, fit)).into_iter().collect(),
    };
    findings.extend(stuck::clipped(record, fit));
    findings.extend(stuck::missing_samples(record, fit));
    findings
}

/// What the harmonics alone show.
pub(super) fn assess_harmonics(fit: &HarmonicFit) -> Vec<Finding> {
    let mut findings: Vec<Finding> = fit.channels.iter().filter_map(dead).collect();
    findings.extend(noisy(fit));
    findings.extend(phase_sensitive(fit));
    findings
}

/// The channels whose noise is large beside their signal, dead ones apart.
fn noisy(fit: &HarmonicFit) -> Option<Finding> {
    let ratios = fit.channels.iter().zip(references(fit)).filter(|(channel, _)| dead(channel).is_none());
    let (channel, ratio) =
        ratios.map(|(channel, reference)| (channel, channel.noise / reference)).max_by(|a, b| a.1.total_cmp(&b.1))?;
    (ratio > NOISY).then(|| {
        let reason = format!("the noise of {} is {:.0} % of its signal", channel.channel, 100.0 * ratio);
        Finding::of_channel(Flag::Noisy, &channel.channel, reason)
    })
}

/// A channel that shows nothing, or nothing that noise alone would not.
fn dead(channel: &ChannelFit) -> Option<Finding> {
    let finding = |reason: String| Some(Finding::of_channel(Flag::DeadChannel, &channel.channel, reason));
    if channel.amplitudes.iter().all(|y| y.re == 0.0 && y.im == 0.0) {
        return finding(format!("{} does not move at all", channel.channel));
    }
    if !channel.has_deviation() {
        return None;
    }
    let squares: f64 = channel
        .amplitudes
        .iter()
        .enumerate()
        .map(|(h, y)| (y.re * y.re + y.im * y.im) / channel.deviation(h + 1).powi(2))
        .sum();
    let limit = crate::math::statistics::chi_square_quantile(1.0 - DEAD_BY_CHANCE, 2 * channel.amplitudes.len());
    if squares > limit {
        return None;
    }
    finding(format!("{} shows nothing above its noise of {:.2e} (SI units)", channel.channel, channel.noise))
}

/// Power that the exciter puts in per radian and its reactive part, `sum V^H F`, at the fundamental; `None` where no
/// driven DOF is measured.
pub fn drive_power(fit: &HarmonicFit) -> Option<c64> {
    let mut power = None;
    for c in fit.force_channels() {
        let dof = fit.channels[c].channel.dof;
        let (Some(force), Some(motion)) = (fit.force(dof), fit.displacement(dof)) else { continue };
        let (Some(f), Some(x)) = (force.amplitudes.first(), motion.amplitudes.first()) else { continue };
        let velocity = x * c64::new(0.0, fit.omega);
        *power.get_or_insert(c64::new(0.0, 0.0)) += velocity.conj() * f;
    }
    power
}

/// Relative change of the energy by one degree of phase error at the drive point, `(pi/180) / tan(loss angle)`; `None`
/// where no driven DOF is measured.
pub fn phase_sensitivity(fit: &HarmonicFit) -> Option<f64> {
    let power = drive_power(fit)?;
    let sensitivity = (power.im / power.re).abs().to_radians();
    if sensitivity.is_nan() { None } else { Some(sensitivity) }
}

fn phase_sensitive(fit: &HarmonicFit) -> Option<Finding> {
    let sensitivity = phase_sensitivity(fit)?;
    (sensitivity > PHASE_SENSITIVE).then(|| {
        let reason = format!(
            "one degree of phase error at the drive point changes the energy by {:.0} %",
            (100.0 * sensitivity).min(9999.0)
        );
        Finding::of_record(Flag::PhaseSensitive, reason)
    })
}
