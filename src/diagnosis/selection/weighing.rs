//! Candidates with models of their own: ordered by their evidence (what they leave, what their parameters and the freedom of the
//! model beside them cost), with probabilities by how well they predict runs that are left out.

use super::candidate_order::{COARSE, Candidate, is_open, likeliest_first, nearest_first, simplest_first};
use super::cross_validation::groups;
use super::sessions_alike::with_sessions_alike;
use crate::diagnosis::channels::fault::is_ordinary_gain;
use crate::diagnosis::residual::data::{DiagnosisError, if_possible};
use crate::diagnosis::residual::prediction::{FINAL, SEARCH};
use crate::diagnosis::selection::conclusion::{TOLERATED, UNEXPLAINED};
use crate::diagnosis::selection::fits::{FIRST_STEPS, STEPS};
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::{ReferenceModel, scale_of};
use crate::diagnosis::selection::search_result::{FittedSets, SearchResult, agrees, cost, same_set};
use crate::diagnosis::selection::solver_settings::has_friction;
use crate::diagnosis::selection::successive_linearisation::CONVERGED;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::diagnosis::updating::part_error::{is_within_part, part_of, takes_away};
use crate::diagnosis::updating::scales::Scales;
use crate::effects::{Constant, Range, Source};
use crate::structure::Part;

/// Weighed candidates.
pub(super) struct Weighed<'a> {
    /// The model with the scales of the best.
    pub reference: ReferenceModel<'a>,
    /// Best first.
    pub fits: Vec<FittedModel>,
    /// Of each of them.
    pub probabilities: Vec<f64>,
    /// Evidence of the best.
    pub least: f64,
}

impl<'a> Weighed<'a> {
    /// Makes it what was found last; its model and its evidence.
    pub(super) fn taken_into(self, found: &mut SearchResult) -> (ReferenceModel<'a>, f64) {
        let Self { reference, fits, probabilities, least } = self;
        found.agrees = agrees(&reference, fits[0].chi_square, fits[0].parameters);
        let scale = scale_of(&fits, reference.count());
        found.by_size.push(FittedSets { scale, noise: reference.noise.clone(), fits, probabilities });
        (reference, least)
    }
}

/// Times that model, effects and scales of the best are settled in turn.
const SETTLED_AGAIN: usize = 2;
/// Rounds of each.
const UPDATES: usize = 6;
/// Evidence behind the best, with the scales of the search, beyond which no other scales would make a candidate the best.
pub(super) const LIGHT: f64 = 300.0;
/// How many times what the best leaves, where that is no noise, others may leave which are weighed too.
const HEAVY: f64 = 2.0;
/// Candidates whose scales are estimated.
const WEIGHED: usize = 6;
/// Laws that the best may have been taken for which are weighed, and rounds in which model and law are settled for each.
const WIDER: usize = 2;
const WIDER_UPDATES: usize = 3;
/// Share of the error of a candidate below which another of the same effects leaves less of the response.
const LESS: f64 = 0.8;
/// Candidates that are settled to the end: where the best turns out to be nothing, the next.
const FINISHED: usize = 2;

/// Weighs fitted candidates, each with the model that was updated beside it; those that leave more than the error `most`, as `compare`
/// shows it, are none: what lowers the squared residual by what is free from run to run alone is nothing that could be added.
pub(super) fn weighed(
    fits: Vec<(ReferenceModel<'_>, FittedModel)>,
    most: f64,
) -> Result<Option<Weighed<'_>>, DiagnosisError> {
    let mut all = with_likely_scales(by_simplest_name(fits)?)?;
    all.retain(|candidate| candidate.fit.error <= most);
    begin_again(&mut all)?;
    let wider = all.first().map_or(Ok(Vec::new()), generalisations_of)?;
    let fresh = |w: &Candidate| !all.iter().any(|c| c.cost < w.cost && same_set(&w.fit.effects, &c.fit.effects));
    let wider: Vec<Candidate> = wider.into_iter().filter(fresh).collect();
    all.retain(|c| !wider.iter().any(|w| same_set(&w.fit.effects, &c.fit.effects)));
    all.extend(wider);
    all.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let limits = all.first().map_or(Ok(Vec::new()), limits_of)?;
    all.retain(|c| !limits.iter().any(|l| l.cost < c.cost && same_set(&l.fit.effects, &c.fit.effects)));
    let fresh = |l: &Candidate| !all.iter().any(|c| same_set(&l.fit.effects, &c.fit.effects));
    let fresh: Vec<Candidate> = limits.into_iter().filter(fresh).collect();
    all.extend(fresh);
    all.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    simplest_first(&mut all);
    let unit = nearest_first(&mut all);
    for _ in 0..FINISHED.min(all.len()) {
        let probabilities = likeliest_first(&mut all, unit);
        let Candidate { reference, fit, .. } = all.remove(0);
        let (reference, mut fit) = finished(reference, fit)?;
        fit.error = error_of(&reference, &fit)?;
        let least = cost(&reference, Some(&fit));
        if !is_effect(&reference, &fit) {
            continue;
        }
        let mut fits = vec![with_told_deviations(&reference, fit)?];
        fits.extend(all.into_iter().map(|candidate| candidate.fit));
        return Ok(Some(Weighed { reference, fits, probabilities, least }));
    }
    Ok(None)
}

/// The candidates that may be the best, each with the scales that are most likely beside it, best first.
fn with_likely_scales(mut fits: Vec<(ReferenceModel<'_>, FittedModel)>) -> Result<Vec<Candidate<'_>>, DiagnosisError> {
    fits.retain(|(reference, fit)| is_effect(reference, fit));
    fits.sort_by(|a, b| cost(&a.0, Some(&a.1)).total_cmp(&cost(&b.0, Some(&b.1))));
    let Some((first, best)) = fits.first() else { return Ok(Vec::new()) };
    let (control, near) = (first.control, bound_beside(first, best));
    let most = if control.is_late() { FINISHED } else { WEIGHED };
    let count = fits.iter().take(most).take_while(|(reference, fit)| cost(reference, Some(fit)) < near).count();
    let mut all = control.map(count, |k| scaled(&fits[k])).into_iter().collect::<Result<Vec<_>, _>>()?;
    all.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    // One set that was refined from two starts is one hypothesis.
    let mut distinct: Vec<Candidate> = Vec::new();
    for candidate in all {
        if !distinct.iter().any(|known| same_set(&known.fit.effects, &candidate.fit.effects)) {
            distinct.push(candidate);
        }
    }
    Ok(distinct)
}

/// A candidate with the scales that are most likely beside it, where they bring evidence.
fn scaled<'a>((own, fit): &(ReferenceModel<'a>, FittedModel)) -> Result<Candidate<'a>, DiagnosisError> {
    let (reference, scaled) = own.with_likely_scales(Some(fit), &SEARCH)?;
    let scaled = scaled.unwrap_or_else(|| fit.clone());
    if cost(&reference, Some(&scaled)) < cost(own, Some(fit)) {
        return candidate(reference, scaled);
    }
    candidate(own.with_scales(own.linearisation.updating.scales), fit.clone())
}

/// The best of the candidates, where it leaves more than a model of this structure would, in its stead as it is when it is begun again
/// beside the model as it was stated, or by fundamentals, where that leaves less. Where nothing agrees with the data the squared residual
/// may be all of harmonics in resonances above the band: then that is better which leaves less of the response.
fn begin_again(all: &mut Vec<Candidate>) -> Result<(), DiagnosisError> {
    let Some(best) = all.first_mut() else { return Ok(()) };
    let left = best.fit.chi_square / best.reference.count() as f64;
    if left < TOLERATED || best.reference.control.is_late() {
        return Ok(());
    }
    let (reference, fit) = (&best.reference, &best.fit);
    let begun = |k: usize| if k == 0 { reference.begun_again(fit) } else { reference.begun_by_fundamentals(fit) };
    let begun = reference.control.map(2, |k| if_possible(begun(k)));
    let mut most = f64::INFINITY;
    for begun in begun {
        let Some(again) = begun?.flatten() else { continue };
        let again = scaled(&again)?;
        let (least, less) = (LESS * best.fit.error, again.fit.error < LESS * best.fit.error);
        let likelier = again.cost < best.cost && LESS * again.fit.error < best.fit.error;
        if (less || likelier) && is_effect(&again.reference, &again.fit) {
            most = if less { least } else { most };
            *best = again;
        }
    }
    all.retain(|candidate| candidate.fit.error < most);
    Ok(())
}

/// Evidence, with the scales of the search, beyond which no other scales would make a candidate the best beside `best`.
pub(super) fn bound_beside(reference: &ReferenceModel, best: &FittedModel) -> f64 {
    // Where even the best leaves much with the scales of the search, these say little of the order.
    let coarse = best.chi_square > COARSE * reference.count() as f64;
    cost(reference, Some(best)) + if coarse { LIGHT.max(HEAVY * best.chi_square) } else { LIGHT }
}

/// The fits in which no law is all but a simpler one on the motion at its place: with that in its stead, fitted beside the same
/// model. Taken for itself, the law would run away to where no data hold it, and answer ever more slowly.
pub(super) fn by_simplest_name(
    fits: Vec<(ReferenceModel<'_>, FittedModel)>,
) -> Result<Vec<(ReferenceModel<'_>, FittedModel)>, DiagnosisError> {
    let mut named: Vec<(ReferenceModel, FittedModel)> = Vec::new();
    for (reference, fit) in fits {
        let mut effects = fit.effects.clone();
        fit.all_but_simpler().for_each(|(k, simpler)| effects[k] = simpler);
        if effects == fit.effects || !effects.iter().all(|effect| reference.data.allows(effect)) {
            named.push((reference, fit));
        } else if !named.iter().any(|(_, other)| same_set(&other.effects, &effects)) {
            let simpler = reference.estimator().fit(&effects, STEPS, &SEARCH, &fit.starts)?;
            named.push((reference, simpler));
        }
    }
    Ok(named)
}

/// Relative error of the model with the effects of `fit`. On which branch each run is takes as long as a fit.
fn error_of(reference: &ReferenceModel, fit: &FittedModel) -> Result<f64, DiagnosisError> {
    if reference.control.is_late() {
        return reference.error_of_followed(&fit.effects, &fit.starts);
    }
    reference.error_of_structure(&fit.effects, &fit.starts)
}

fn candidate(reference: ReferenceModel<'_>, fit: FittedModel) -> Result<Candidate<'_>, DiagnosisError> {
    let error = error_of(&reference, &fit)?;
    let densities = reference.cross_validated(Some(&fit), &groups(reference.data))?;
    Ok(Candidate { cost: cost(&reference, Some(&fit)), fit: FittedModel { error, ..fit }, densities, reference })
}

/// The laws that the best may have been taken for, in its stead and each with a model settled beside it: where the best is linear,
/// whose neighbours are fitted in no time, or leaves more than noise is expected to leave, as a simple law does that was easier to refine:
/// corrections beside it hide much of what it lacks.
fn generalisations_of<'a>(best: &Candidate<'a>) -> Result<Vec<Candidate<'a>>, DiagnosisError> {
    let (reference, left) = (&best.reference, best.fit.chi_square / best.reference.count() as f64);
    let linear = best.fit.effects.iter().all(|e| e.effect.is_linear());
    let doubtful = best.fit.chi_square > best.reference.count().saturating_sub(best.fit.parameters) as f64;
    if reference.control.is_late() || left > UNEXPLAINED || !(linear || doubtful) {
        return Ok(Vec::new());
    }
    let mut fits = reference.generalisations(&best.fit, |effect| doubtful || effect.is_linear())?;
    fits.sort_by(|a, b| cost(reference, Some(a)).total_cmp(&cost(reference, Some(b))));
    let bound = |fit: &FittedModel| match doubtful {
        // Friction is judged with more harmonics than it is fitted with here.
        true if has_friction(&fit.effects) => HEAVY * best.cost,
        true => best.cost,
        false => best.cost + LIGHT,
    };
    let mut wider: Vec<Candidate> = Vec::new();
    for fit in fits {
        let known = wider.iter().any(|c| same_set(&c.fit.effects, &fit.effects));
        let near = cost(reference, Some(&fit)) < bound(&fit) && is_effect(reference, &fit);
        if !known && near && wider.len() < WIDER {
            let own = reference.with_scales(reference.linearisation.updating.scales);
            let converged = own.converged_below(bound(&fit), fit, &SEARCH, WIDER_UPDATES)?;
            for (there, converged) in by_simplest_name(vec![converged])? {
                wider.push(candidate(there, converged)?);
            }
        }
    }
    Ok(wider)
}

/// The sets in which one effect of the best is the simpler law that it contains as a limit, fitted beside the same model: a
/// simpler law that was refined by itself may have ended in another local minimum.
fn limits_of<'a>(best: &Candidate<'a>) -> Result<Vec<Candidate<'a>>, DiagnosisError> {
    let mut limits = Vec::new();
    let late = best.reference.control.is_late();
    for (k, source) in best.fit.effects.iter().enumerate() {
        // A parameter that the data do not know is told of no law, however late it is.
        let tried = !late || is_open(&best.fit.deviations[k], source);
        for simpler in source.limits().filter(|s| tried && s.parameters.iter().all(|p| p.is_normal())) {
            let mut effects = best.fit.effects.clone();
            effects[k] = simpler;
            if !best.reference.data.allows(&effects[k]) {
                continue;
            }
            let reference = best.reference.with_scales(best.reference.linearisation.updating.scales);
            let begun = reference.estimator().fit(&effects, FIRST_STEPS, &SEARCH, &best.fit.starts)?;
            if cost(&reference, Some(&begun)) > best.cost + LIGHT {
                continue;
            }
            let fit = reference.estimator().fit(&begun.effects, STEPS, &SEARCH, &begun.starts)?;
            if is_effect(&reference, &fit) {
                limits.push(candidate(reference, fit)?);
            }
        }
    }
    Ok(limits)
}

/// A candidate with its model, settled in turn with the most likely scales.
fn finished(
    reference: ReferenceModel<'_>,
    fit: FittedModel,
) -> Result<(ReferenceModel<'_>, FittedModel), DiagnosisError> {
    let (mut reference, mut fit) = (reference, fit);
    for _ in 0..SETTLED_AGAIN {
        if reference.control.is_late() {
            break;
        }
        let before = cost(&reference, Some(&fit));
        let (there, converged) = reference.converged(fit, &SEARCH, UPDATES)?;
        let (likely, again) = there.with_likely_scales(Some(&converged), &SEARCH)?;
        let again = again.unwrap_or_else(|| converged.clone());
        let better = cost(&likely, Some(&again)) < cost(&there, Some(&converged));
        (reference, fit) = if better { (likely, again) } else { (there, converged) };
        if before - cost(&reference, Some(&fit)) < CONVERGED {
            break;
        }
    }
    let (reference, fit) = reference.converged(fit, &FINAL, UPDATES)?;
    with_sessions_alike(reference, fit)
}

/// Whether both are the same coupling read from either end.
fn is_reverse(a: Part, b: Part) -> bool {
    matches!((a, b), (Part::Coupling([i, j]), Part::Coupling([k, l])) if i == l && j == k)
}

/// A fit with the deviations that hold where nothing is known better than laboratories know it: what is common to all gains
/// and all of the model no data tell, so that the likeliest scales are too small for it. All derivatives are taken at the fit: what
/// only a common factor of forces and motions tells apart would seem known from derivatives of two points.
fn with_told_deviations(reference: &ReferenceModel, fit: FittedModel) -> Result<FittedModel, DiagnosisError> {
    let scales = reference.linearisation.updating.scales.at_least(&Scales::SEARCH);
    let updating = reference.linearisation.updating.with_scales(scales);
    let there = reference.updated(&updating, &fit.effects, &fit.starts)?;
    let told = there.estimator().fit(&fit.effects, 0, &FINAL, &fit.starts)?;
    Ok(FittedModel { deviations: told.deviations, ..fit })
}

/// Relative size of an added spring or mass up to which it is an error of the one that is there.
const OF_THE_PART: f64 = 0.05;

/// Whether every effect of a fit is of a size that the data know, and more than an error of a part of the model.
fn is_effect(reference: &ReferenceModel, fit: &FittedModel) -> bool {
    let within = |(source, deviations): (&Source, &Vec<f64>)| {
        let simpler = source.simpler(&Range::UNKNOWN);
        let deviation = if simpler.is_some() { 0.0 } else { deviations[0] };
        let source = &simpler.unwrap_or_else(|| source.clone());
        if takes_away(source) {
            return true;
        }
        if is_ordinary_gain(source) {
            return true;
        }
        let Some(part) = part_of(source) else { return false };
        let parameters = &reference.linearisation.updating.parameters;
        let updated = parameters.iter().any(|p| match p {
            UpdatingParameter::Structure(other) => *other == part || is_reverse(*other, part),
            _ => false,
        });
        (updated || source.effect.adds_to(Constant::Mass))
            && is_within_part(reference.predictor.structure(), source, deviation, part, OF_THE_PART)
    };
    !reference.ranked(vec![fit.clone()]).is_empty() && !fit.effects.iter().zip(&fit.deviations).any(within)
}
