//! Backward elimination, the other half of stepwise regression: effects that a set no longer needs, for what brought their evidence was
//! another effect that came later, the model moved beside it, or a lower local minimum of those that were there before.

use crate::diagnosis::residual::data::{DiagnosisError, if_possible};
use crate::diagnosis::residual::prediction::{FINAL, SEARCH};
use crate::diagnosis::selection::candidate_order::is_open;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::{ReferenceModel, scale_of};
use crate::diagnosis::selection::search_result::{EVIDENCE, FittedSets, SearchResult, agrees, cost, distinct, nearly};
use crate::diagnosis::selection::updated::REFITTED;
use crate::diagnosis::selection::weighing::{Weighed, weighed};
use crate::effects::Source;

/// Rounds in which a model converges beside the effects that are left when another is taken away.
const UPDATES: usize = 6;
/// Squared residual without an effect over that with it beyond which no other minimum is looked for.
const FAR: f64 = 4.0;

/// The effects of `from`, whose evidence is `least`, in the model of the best of the candidates for one effect more, where they have
/// their evidence there without it: what it brought was a lower local minimum of the same effects, such as other branches of a
/// resonance.
pub(super) fn without_addition<'a>(
    candidates: &[(ReferenceModel<'a>, FittedModel)],
    from: &FittedModel,
    least: f64,
) -> Result<Option<Weighed<'a>>, DiagnosisError> {
    let evidence = |(reference, fit): &(ReferenceModel, FittedModel)| cost(reference, Some(fit));
    let best = candidates.iter().min_by(|a, b| evidence(a).total_cmp(&evidence(b)));
    let Some((reference, fit)) = best else { return Ok(None) };
    let is_known = |effect: &&Source| from.effects.iter().any(|known| known.is_same(effect));
    let same: Vec<Source> = fit.effects.iter().filter(is_known).cloned().collect();
    if same.len() < from.effects.len() {
        return Ok(None);
    }
    let own = reference.with_scales(reference.linearisation.updating.scales);
    let begun = own.estimator().fit(&same, REFITTED, &SEARCH, &fit.starts)?;
    if cost(&own, Some(&begun)) > least - EVIDENCE {
        return Ok(None);
    }
    let better = weighed(vec![own.converged(begun, &SEARCH, UPDATES)?], f64::INFINITY)?;
    Ok(better.filter(|better| better.fits[0].effects.len() == same.len() && better.least < least - EVIDENCE))
}

/// Drops effects that the last set of a search no longer needs, now that the others are there.
pub(super) fn pruned(reference: &ReferenceModel, found: &mut SearchResult) -> Result<(), DiagnosisError> {
    while let Some(best) =
        found.by_size.last().map(|fitted_sets| fitted_sets.fits[0].clone()).filter(|r| r.effects.len() > 1)
    {
        let mut fits = Vec::new();
        for k in 0..best.effects.len() {
            let mut fewer = best.effects.clone();
            fewer.remove(k);
            fits.push(reference.estimator().fit(&fewer, 10, &FINAL, &best.starts)?);
        }
        let (fits, noise) = reference.polished(reference.ranked(fits))?;
        let enough = |r: &FittedModel| reference.evidence(r, 1.0) < reference.evidence(&best, 1.0) + EVIDENCE;
        let Some(first) = fits.first().filter(|r| enough(r)) else { break };
        found.agrees = agrees(reference, first.chi_square, first.parameters) || nearly(reference, first, found.before);
        found.by_size.pop();
        let scale = scale_of(&fits, reference.count());
        let before = found.by_size.pop().map_or_else(Vec::new, |fitted_sets| fitted_sets.fits);
        let fits = distinct(reference.ranked(fits.into_iter().chain(before).collect()));
        found.by_size.push(FittedSets { probabilities: reference.probabilities(&fits), fits, scale, noise });
    }
    Ok(())
}

/// The model without the effects of the last set of a search without which what corrections do instead has no less evidence: the model
/// converges beside the others, for corrections beside the whole set are not those beside fewer, and is begun again as it was stated, for
/// those beside fewer may have ended in another local minimum.
pub(super) fn without_needless_effects<'a>(
    reference: ReferenceModel<'a>,
    found: &mut SearchResult,
) -> Result<ReferenceModel<'a>, DiagnosisError> {
    let mut reference = reference;
    while let Some(fewer) = found.by_size.last().map(|sets| fewer(&reference, sets)).transpose()?.flatten() {
        let left = fewer.fits[0].effects.len();
        found.by_size.retain(|sets| sets.fits[0].effects.len() < left);
        (reference, _) = fewer.taken_into(found);
    }
    Ok(reference)
}

/// The set without one of its effects, if it is no less likely; the effects that the data do not know are the first to go.
fn fewer<'a>(reference: &ReferenceModel<'a>, sets: &FittedSets) -> Result<Option<Weighed<'a>>, DiagnosisError> {
    let best = &sets.fits[0];
    if best.effects.len() < 2 {
        return Ok(None);
    }
    let most = cost(reference, Some(best)) + EVIDENCE * sets.scale;
    let mut order: Vec<usize> = (0..best.effects.len()).rev().collect();
    order.sort_by_key(|&k| !is_open(&best.deviations[k], &best.effects[k]));
    for k in order {
        if reference.control.is_late() {
            break;
        }
        let mut effects = best.effects.clone();
        effects.remove(k);
        let own = reference.with_scales(reference.linearisation.updating.scales);
        let begun = own.estimator().fit(&effects, REFITTED, &SEARCH, &best.starts)?;
        let mut fits = vec![own.converged(begun, &SEARCH, UPDATES)?];
        let (own, converged) = &fits[0];
        if !is_open(&best.deviations[k], &best.effects[k]) {
            if converged.chi_square > FAR * best.chi_square {
                continue;
            }
            fits.extend(if_possible(own.begun_again(converged))?.flatten());
        }
        let Some(weighed) = weighed(fits, f64::INFINITY)? else { continue };
        if weighed.least < most && weighed.fits[0].effects.len() == effects.len() {
            return Ok(Some(weighed));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::source;
    use crate::diagnosis::selection::stated_chain::{hidden, with_stated};
    use crate::effects::{Effect, Source};

    /// The effects that are left of a set of which the data know the parameters of those in `open` not, and the factor on the ground
    /// spring of the model beside them.
    fn left_of(effects: &[Source], open: &[usize]) -> (Vec<Source>, f64) {
        with_stated(effects, |reference| {
            let mut fit = reference.estimator().fit(effects, REFITTED, &SEARCH, &Vec::new()).unwrap();
            open.iter().for_each(|&k| fit.deviations[k].fill(f64::NAN));
            let noise = reference.noise.clone();
            let sets = FittedSets { fits: vec![fit], scale: 1.0, noise, probabilities: vec![1.0] };
            let mut found = SearchResult {
                updated: true,
                by_size: vec![sets],
                agrees: false,
                before: f64::INFINITY,
                without: f64::INFINITY,
            };
            let converged = without_needless_effects(reference, &mut found).unwrap();
            let structure = converged.linearisation.updating.structure(converged.predictor.stated().0);
            let ground = structure.matrices().unwrap().stiffness[(0, 0)] - 1e4;
            (found.by_size.pop().unwrap().fits.remove(0).effects, ground / 2e4)
        })
    }

    /// The model has converged beside what is left: its spring has moved to where the records have it.
    #[test]
    fn an_effect_that_the_data_do_not_know_goes_from_a_set_and_the_model_settles() {
        let idle = source(Effect::Coulomb, &[1], &[1e-6]);
        let (left, ground) = left_of(&[hidden(), idle], &[1]);
        assert!(matches!(left.as_slice(), [only] if only.is_same(&hidden())), "{left:?}");
        assert!((left[0].parameters[0] / 4e6 - 1.0).abs() < 0.02, "{left:?}");
        assert!((ground - 1.02).abs() < 2e-3, "{ground}");
    }

    /// A fit whose model has gone astray, begun again from the model as it was stated, settles where the records have it.
    #[test]
    fn a_fit_that_is_begun_again_does_not_depend_on_where_its_model_was() {
        with_stated(&[hidden()], |stated| {
            let mut updating = stated.linearisation.updating.clone();
            updating.values[0] += 0.15;
            let astray = stated.updated(&updating, &[hidden()], &Vec::new()).unwrap();
            let from = astray.estimator().fit(&[hidden()], REFITTED, &SEARCH, &Vec::new()).unwrap();
            let (reference, fit) = astray.begun_again(&from).unwrap().unwrap();
            assert!(cost(&reference, Some(&fit)) < cost(&astray, Some(&from)));
            assert!((fit.effects[0].parameters[0] / 4e6 - 1.0).abs() < 0.02, "{:?}", fit.effects);
            let structure = reference.linearisation.updating.structure(reference.predictor.stated().0);
            let ground = structure.matrices().unwrap().stiffness[(0, 0)] - 1e4;
            assert!((ground / 2e4 - 1.02).abs() < 2e-3, "{ground}");
        });
    }

    /// Though the data are said not to know it; what nothing needs beside it goes.
    #[test]
    fn an_effect_that_corrections_cannot_stand_for_stays() {
        let dashpot = source(Effect::Viscous, &[1], &[1e-3]);
        let (left, _) = left_of(&[hidden(), dashpot], &[0]);
        assert!(matches!(left.as_slice(), [only] if only.is_same(&hidden())), "{left:?}");
    }

    /// The hidden spring and an idle effect more, in the model that has converged beside them: the spring alone has the evidence that it
    /// lacks in the model as it is stated. Where it has that evidence already, or is not among the effects, there is nothing to take.
    #[test]
    fn what_one_effect_more_brought_by_another_minimum_is_taken_without_it() {
        with_stated(&[hidden()], |stated| {
            let fitted = |reference: &ReferenceModel, effects: &[Source]| {
                reference.estimator().fit(effects, REFITTED, &SEARCH, &Vec::new()).unwrap()
            };
            let from = fitted(&stated, &[hidden()]);
            let stated_cost = cost(&stated, Some(&from));
            let idle = source(Effect::Coulomb, &[1], &[1e-6]);
            let (converged, only) = stated.converged(from.clone(), &SEARCH, UPDATES).unwrap();
            let least = cost(&converged, Some(&only));
            assert!(least < stated_cost, "{least} {stated_cost}");
            let before = least + 4.0 * EVIDENCE;
            let more = fitted(&converged, &[hidden(), idle.clone()]);
            let another = fitted(&converged, &[idle]);
            let candidates = [(converged, more)];
            let taken = without_addition(&candidates, &from, before).unwrap().unwrap();
            assert!(
                matches!(taken.fits[0].effects.as_slice(), [only] if only.is_same(&hidden())),
                "{:?}",
                taken.fits[0]
            );
            assert!(taken.least < before - EVIDENCE, "{} {before}", taken.least);
            assert!(without_addition(&candidates, &from, least).unwrap().is_none());
            let [(converged, _)] = candidates;
            assert!(without_addition(&[(converged, another)], &from, before).unwrap().is_none());
        });
    }
}
