//! What is no steady motion at all: a free decay, noise, a sum of sines that one fundamental does not hold.

use super::finding::{Finding, Flag};
use super::fit::HarmonicFit;
use super::ramps::blocks;
use super::record::Record;
use super::signal::references;
use crate::math::statistics::median;

/// Share of its first amplitude to which a motion must have fallen at the end of the record to be a free decay.
const FALLEN: f64 = 0.5;
/// Share of the blocks in which a decay falls: beats rise as often as they fall.
const FALLING: f64 = 0.8;
/// Noise over signal from which a channel is no measurement of a periodic motion: its harmonics hold the smaller part of
/// its power.
pub(super) const NOT_PERIODIC: f64 = 1.0;

/// Least blocks behind the largest in which a decay is seen.
const FEWEST: usize = 4;

/// The finding that a record without a force rings down, from its largest block on: what was before the release does not
/// matter.
pub(super) fn free_decay(record: &Record, fit: &HarmonicFit) -> Option<Finding> {
    let references = references(fit);
    let channel = (0..references.len()).max_by(|&a, &b| references[a].total_cmp(&references[b]))?;
    let (_, blocks) = blocks(record, fit)?;
    let all = &blocks[channel];
    let release = (0..all.len()).max_by(|&a, &b| all[a].total_cmp(&all[b]))?;
    let sizes = &all[release..];
    if sizes.len() < FEWEST {
        return None;
    }
    let falling = sizes.windows(2).filter(|pair| pair[1] < pair[0]).count();
    let (first, last) = (sizes[0], sizes[sizes.len() - 1]);
    let decays = last < FALLEN * first && falling as f64 >= FALLING * (sizes.len() - 1) as f64;
    decays.then(|| Finding::of_record(
        Flag::NotPeriodic,
        format!(
            "{} is a free decay, no steady sine: it falls to {:.0} % of its amplitude without a force; use records under a steady force here",
            fit.channels[channel].channel,
            100.0 * last / first
        ),
    ))
}

/// The finding that the harmonics hold the smaller part of what is recorded: in a force, or in most responses.
pub(super) fn not_periodic(fit: &HarmonicFit) -> Option<Finding> {
    let references = references(fit);
    let ratio = |c: usize| if references[c] > 0.0 { fit.channels[c].noise / references[c] } else { 0.0 };
    let responses = fit.response_channels();
    let ratios: Vec<f64> = responses.iter().map(|&c| ratio(c)).collect();
    let force = fit.force_channels().into_iter().find(|&c| ratio(c) > NOT_PERIODIC);
    let response = responses.iter().copied().max_by(|&a, &b| ratio(a).total_cmp(&ratio(b)));
    let channel = force.or_else(|| response.filter(|_| median(&ratios) > NOT_PERIODIC))?;
    Some(Finding::of_record(
        Flag::NotPeriodic,
        format!(
            "{} is no sine of {:.6} Hz: what does not repeat with its period is {:.0} % of what does (noise, or sines of other frequencies)",
            fit.channels[channel].channel,
            fit.omega / std::f64::consts::TAU,
            (100.0 * ratio(channel)).min(99_999.0)
        ),
    ))
}
