//! Whether the frequency that the user gave is that of the record.
//!
//! The force's phase must not slip against the given frequency over the record; the given frequency must not leave a
//! residual that another explains; and the force must have something at it, not only at its multiples.

use super::channel::Quantity;
use super::finding::{Finding, Flag};
use super::fit::{HarmonicFit, solve};
use super::frequency::{Frequency, coarse, leading, refine};
use super::record::Record;
use std::f64::consts::TAU;

/// Slip of the phase over the record, rad, that matters: it lowers a fitted amplitude by a sixth of a per cent.
pub(super) const SLIP: f64 = 0.2;

/// Deviations by which the slip must exceed its own.
const SLIP_DEVIATIONS: f64 = 5.0;

/// Share of a leading channel's variance in the residual from which another frequency is looked for.
const UNEXPLAINED: f64 = 0.1;

/// Factor by which another frequency must lower the residual to be believed.
const BETTER: f64 = 0.5;

/// Share of its largest harmonic that a force has at least at its fundamental: exciters distort, but not so.
const LEAST_FUNDAMENTAL: f64 = 0.05;

/// The finding that `given_hz` is not the frequency of the record.
pub(super) fn wrong_frequency(record: &Record, fit: &HarmonicFit, given_hz: f64) -> Option<Finding> {
    let lead = leading(record);
    let reason = slip(record, fit, given_hz, &lead)
        .or_else(|| other(record, fit, given_hz, &lead))
        .or_else(|| multiple(fit, given_hz));
    reason.map(|reason| Finding::of_record(Flag::WrongFrequency, reason))
}

/// A small error of the frequency: the phase slips over the record.
fn slip(record: &Record, fit: &HarmonicFit, given_hz: f64, lead: &[usize]) -> Option<String> {
    let Frequency { omega, deviation } = refine(record, fit.omega, fit.harmonics(), lead).ok()?;
    let slip = (omega - fit.omega).abs() * record.duration();
    // Beyond a line of the spectrum the refinement may have run into a neighbouring local minimum.
    if !(SLIP..=TAU).contains(&slip) || slip < SLIP_DEVIATIONS * deviation * record.duration() {
        return None;
    }
    Some(format!(
        "at the given {given_hz} Hz the phase slips by {:.0} degrees over the record; {:.6} Hz fits it",
        slip.to_degrees(),
        omega / TAU
    ))
}

/// Another frequency: the given one leaves much that the other explains.
fn other(record: &Record, fit: &HarmonicFit, given_hz: f64, lead: &[usize]) -> Option<String> {
    let unexplained = unexplained(record, fit.omega, fit.harmonics(), lead)?;
    if unexplained < UNEXPLAINED {
        return None;
    }
    let start = coarse(record, fit.harmonics()).ok()?;
    let found = refine(record, start, fit.harmonics(), lead).ok()?.omega;
    let apart = (found - fit.omega).abs() * record.duration();
    let remaining = self::unexplained(record, found, fit.harmonics(), lead)?;
    (apart > SLIP && remaining < BETTER * unexplained).then(|| {
        format!(
            "the given {given_hz} Hz leaves {:.0} % of the signal unexplained, {:.6} Hz only {:.2} %",
            100.0 * unexplained.sqrt(),
            found / TAU,
            100.0 * remaining.sqrt()
        )
    })
}

/// Share of the variance of the leading channels that a fit leaves, mean over them.
fn unexplained(record: &Record, omega: f64, harmonics: usize, lead: &[usize]) -> Option<f64> {
    let values: Vec<&[f64]> = lead.iter().map(|&c| record.samples(c)).collect();
    let solved = solve(record.time(), &values, omega, harmonics).ok()?;
    let shares: Vec<f64> = values
        .iter()
        .enumerate()
        .filter_map(|(i, samples)| {
            let mean = samples.iter().sum::<f64>() / samples.len() as f64;
            let total = samples.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / samples.len() as f64;
            (total > 0.0).then(|| solved.residual_variance(i) / total)
        })
        .collect();
    (!shares.is_empty()).then(|| shares.iter().sum::<f64>() / shares.len() as f64)
}

/// A given frequency that the force has only multiples of.
fn multiple(fit: &HarmonicFit, given_hz: f64) -> Option<String> {
    let force = fit.channels.iter().find(|c| c.channel.quantity == Quantity::Force)?;
    let sizes: Vec<f64> = force.amplitudes.iter().map(|y| y.re.hypot(y.im)).collect();
    let (h, largest) = sizes.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    let significant = *largest > SLIP_DEVIATIONS * force.deviation(h + 1);
    (h > 0 && significant && sizes[0] < LEAST_FUNDAMENTAL * largest)
        .then(|| format!("{} has nothing at the given {given_hz} Hz, but at {} times that", force.channel, h + 1))
}
