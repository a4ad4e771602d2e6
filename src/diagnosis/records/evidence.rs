//! What a fit is worth: its misfit, and its evidence on the scale of what the best fit leaves.

use super::data::Records;
use super::fitted::FittedRecords;

/// Misfit up to which a model agrees.
pub(super) const AGREES: f64 = 1.15;

/// Gain of evidence from which on an effect is kept.
pub(super) const GAIN: f64 = 12.0;

/// Periods of the dominant motion over which the error of a model stays alike: with 3 parameters of the development projects
/// (laboratory records, seeds 0 to 7) scatter by 1.2 of what is told, with 1 by 1.7.
const PERIODS: f64 = 3.0;
/// The same of a body that floats, which is moved anew with every stroke.
const PERIODS_FLOATING: f64 = 0.25;

/// Squared residual a sample, over the noise.
pub(super) fn misfit(fit: &FittedRecords) -> f64 {
    fit.chi_square / fit.count.max(1) as f64
}

/// Number of parameters of the effects of a fit.
pub(super) fn parameters(fit: &FittedRecords) -> usize {
    fit.effects.iter().map(|e| e.parameters.len()).sum()
}

/// What every parameter of a law beyond its first costs besides its information criterion: where one law contains another,
/// the simpler wins unless the data demand the other (as for steady runs).
const EXTRA: f64 = 8.0;

/// What one unit of evidence is worth in squared residual: the misfit of a fit times the samples over which what it leaves
/// stays alike, at least 1.
pub(super) fn scale(fit: &FittedRecords) -> f64 {
    let (mut own, mut next) = (0.0, 0.0);
    for channel in fit.residual.iter().flatten() {
        own += channel.iter().map(|e| e * e).sum::<f64>();
        // The envelope of what is left decides, not its phase: squares of neighbours beside their mean.
        let squares: Vec<f64> = channel.windows(2).map(|e| e[0].hypot(e[1])).collect();
        next += squares.windows(2).map(|e| e[0].min(e[1]).powi(2)).sum::<f64>() / 2.0;
    }
    let alike = if own > 0.0 { (next / own).clamp(0.0, 0.98) } else { 0.0 };
    let length = if misfit(fit) > 2.0 { ((1.0 + alike) / (1.0 - alike)).max(1.0) } else { 1.0 };
    misfit(fit).max(1.0) * length.max(fit.alike)
}

/// Samples, of the used `share` of some records, over which what a model leaves stays alike: noise differs from sample to sample, the
/// error of a model stays what it is over some periods of the motion.
pub(super) fn alike(records: &Records, share: f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    let alike = if records.floats() { PERIODS_FLOATING } else { PERIODS };
    for record in &records.list {
        let used = ((share * record.len() as f64) as usize).max(1);
        let periods = (alike / (record.dominant_hz * record.step)).max(1.0);
        for (sigma, noise) in record.sigma.iter().zip(&record.noise) {
            let of_model = |s: &f64| 1.0 - (noise / s).powi(2).min(1.0);
            sum += periods * sigma.iter().take(used).map(of_model).sum::<f64>();
            count += used as f64;
        }
    }
    1.0 + sum / f64::max(count, 1.0)
}

/// What one parameter more costs.
pub(super) fn information(fit: &FittedRecords, scale: f64) -> f64 {
    (fit.count as f64 / scale.sqrt()).max(2.0).ln()
}

/// Evidence (smaller is better) on the scale of the best fit: what corrections cost by what is known of them is part of it, so
/// that a known source of three times its size does not stand for what is missing.
pub(super) fn evidence(fit: &FittedRecords, scale: f64) -> f64 {
    let extra: usize = fit.effects.iter().map(|e| e.parameters.len().saturating_sub(1)).sum();
    fit.chi_square / scale + fit.prior + parameters(fit) as f64 * information(fit, scale) + EXTRA * extra as f64
}
