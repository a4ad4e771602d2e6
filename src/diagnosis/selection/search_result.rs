//! Fits that a search keeps on its way, and when they agree with the data.

use crate::diagnosis::candidates::special_cases::{is_limit, is_undetermined};
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::updating::noise_model::NoiseModel;
use crate::effects::Source;
use std::sync::Arc;

/// Most effects that are added.
pub(super) const MOST_EFFECTS: usize = 3;
/// Evidence (difference of the information criterion) that an effect must bring: its own, and that of having been
/// chosen among thousands.
pub(super) const EVIDENCE: f64 = 25.0;
/// Squared residual per datum beyond which it is not noise that hides an effect, but what no model matches.
pub(super) const DOUBTFUL: f64 = 1.5;
/// Deviations of the sum of squares within which a model agrees with the data.
pub(super) const AGREES: f64 = 4.0;
/// Share of the squared residual of the model as it is, and error of the response, that nobody's records and integrators
/// are better than: what is left below both is no further effect.
pub(super) const LAST: f64 = 4e-4;
const LAST_ERROR: f64 = 2e-3;

/// Error of the response, and how many noise floors, up to which runs of one structure scatter about any model of it, whose resonances
/// move from run to run. The laboratory projects that are only detuned leave a twentieth.
const SCATTERED: f64 = 0.3;
const SCATTERED_FLOORS: f64 = 10.0;

const RELIED_ON: f64 = 0.1;
const RELIED_ON_FLOORS: f64 = 20.0;

/// Sets of effects of one size, fitted, best first.
pub(crate) struct FittedSets {
    pub fits: Vec<FittedModel>,
    /// Squared residual per datum of the best, at least 1.
    pub scale: f64,
    /// Noise with the truncation of the best.
    pub noise: Arc<NoiseModel>,
    /// Probability of each.
    pub probabilities: Vec<f64>,
}

impl FittedSets {
    /// These without the sets that differ from the best by wider laws of which the data do not know a parameter: they are the best by
    /// another name, and it has their probability.
    pub(super) fn without_needless(&self) -> Self {
        let mut kept =
            Self { fits: Vec::new(), probabilities: Vec::new(), scale: self.scale, noise: self.noise.clone() };
        for (fit, &probability) in self.fits.iter().zip(&self.probabilities) {
            let undetermined = || fit.effects.iter().zip(&fit.deviations).any(|(e, d)| is_undetermined(e, d));
            let wider = |best: &FittedModel| is_limit(&best.effects, &fit.effects) && undetermined();
            if let Some(first) = kept.probabilities.first_mut().filter(|_| wider(&self.fits[0])) {
                *first += probability;
            } else {
                kept.fits.push(fit.clone());
                kept.probabilities.push(probability);
            }
        }
        kept
    }
}

/// What a search ended with.
pub(crate) struct SearchResult {
    /// Whether updating parameters were freed.
    pub updated: bool,
    pub by_size: Vec<FittedSets>,
    /// Whether the largest sets agree with the data.
    pub agrees: bool,
    /// Squared residual of the model as it is.
    pub before: f64,
    /// Squared residual per datum of the corrected model without any effect; zero where it was not corrected.
    pub without: f64,
}

impl SearchResult {
    /// Nothing yet, beside the corrections of `bare`, where the model as it is has the squared residual `before`.
    pub(super) fn beside(bare: &ReferenceModel, before: f64) -> Self {
        Self { updated: true, by_size: Vec::new(), agrees: false, before, without: bare.misfit() }
    }
}

/// Evidence of a model whose updating parameters are free, with the effects of `fit`; the smaller, the better.
pub(super) fn cost(reference: &ReferenceModel, fit: Option<&FittedModel>) -> f64 {
    let fit = match fit {
        Some(fit) => reference.evidence(fit, 1.0),
        None => reference.estimator().residual(&reference.predictions).iter().map(|r| r * r).sum(),
    };
    fit + reference.noise.cost()
}

/// Whether a squared residual with `parameters` fitted is that of noise.
pub(crate) fn agrees(reference: &ReferenceModel, chi_square: f64, parameters: usize) -> bool {
    chi_square <= most_of_noise(reference, parameters)
}

/// Greatest squared residual with `parameters` fitted that noise would leave.
pub(super) fn most_of_noise(reference: &ReferenceModel, parameters: usize) -> f64 {
    let n = reference.count().saturating_sub(parameters) as f64;
    n + AGREES * (2.0 * n).sqrt()
}

/// Whether what a fit leaves is no more than what records and integrators are wrong by, where the model as it is has the
/// squared residual `before`.
pub(crate) fn nearly(reference: &ReferenceModel, fit: &FittedModel, before: f64) -> bool {
    small(reference, fit, before, [LAST, LAST_ERROR])
}

/// Whether what a fit leaves beyond the noise is below a `share` of the squared residual `before`, and below an `error` of
/// the response.
pub(super) fn small(reference: &ReferenceModel, fit: &FittedModel, before: f64, [share, error]: [f64; 2]) -> bool {
    let n = reference.count() as f64;
    let excess = (fit.chi_square - n).max(0.0);
    let beyond_noise = fit.error * (excess / fit.chi_square.max(f64::MIN_POSITIVE)).sqrt();
    excess < share * (before - n) && beyond_noise < error
}

/// Whether a fit agrees with the data, or all but.
pub(crate) fn fits_well(reference: &ReferenceModel, found: &SearchResult, fit: &FittedModel) -> bool {
    agrees(reference, fit.chi_square, fit.parameters) || nearly(reference, fit, found.before)
}

/// Whether a model with this error, all runs alike, explains them by what is free from run to run alone, however small its squared
/// residual is beside that freedom.
pub(super) fn explains_by_scatter(error: f64, noise_floor: f64) -> bool {
    error > SCATTERED && error > SCATTERED_FLOORS * noise_floor
}

/// Whether effects leave more of the response, all runs alike, than one would rely on: 10 % and twenty noise floors, whatever is free from
/// run to run hides. Of development seeds 500 to 599 and of seeds 4000 to 4047 two left so much with a small misfit, and neither had the law
/// that was told.
pub(super) fn leaves_much(error: f64, noise_floor: f64) -> bool {
    error > RELIED_ON && error > RELIED_ON_FLOORS * noise_floor
}

/// The best fit of every set.
pub(crate) fn distinct(fits: Vec<FittedModel>) -> Vec<FittedModel> {
    let mut kept: Vec<FittedModel> = Vec::with_capacity(fits.len());
    for fit in fits {
        if !kept.iter().any(|k| same_set(&k.effects, &fit.effects)) {
            kept.push(fit);
        }
    }
    kept
}

/// Whether two sets are of the same effects at the same places.
pub(crate) fn same_set(a: &[Source], b: &[Source]) -> bool {
    a.len() == b.len() && a.iter().all(|x| b.iter().any(|y| x.is_same(y)))
}

#[cfg(test)]
mod tests {
    use super::{explains_by_scatter, leaves_much};

    /// What laboratories leave that are only detuned is no scatter, how many floors it may be; nor is what is noise.
    #[test]
    fn runs_scatter_by_a_share_of_the_response() {
        assert!(explains_by_scatter(0.806, 0.0066));
        assert!(!explains_by_scatter(0.047, 0.0004) && !explains_by_scatter(0.5, 0.4));
    }

    /// A law that leaves 25 % is not relied on, one of a joint that re-seats, and one beside as much noise, are.
    #[test]
    fn a_law_that_leaves_much_is_not_relied_on() {
        assert!(leaves_much(0.249, 0.0078));
        assert!(!leaves_much(0.06, 0.001) && !leaves_much(0.136, 0.01) && !leaves_much(0.28, 0.11));
    }
}
