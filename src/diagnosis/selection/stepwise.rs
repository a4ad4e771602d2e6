//! Stepwise selection of effects, from the model as it is to one that agrees with the data: one at a time or by pairs;
//! where effects alone do not get there, beside corrections.

use super::beside_corrections::beside_updating;
use super::search_result::{
    AGREES, DOUBTFUL, EVIDENCE, FittedSets, LAST, MOST_EFFECTS, SearchResult, distinct, fits_well, same_set, small,
};
use crate::diagnosis::candidates::special_cases::is_limit;
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::selection::conclusion::{self, Outcome};
use crate::diagnosis::selection::fits::STEPS;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::{ReferenceModel, scale_of};
use crate::diagnosis::selection::unreliable::Unreliable;

/// Deviations within which it agrees so well that no further effect is looked for.
const SETTLED: f64 = 1.5;
/// Evidence that an effect must bring where the model agrees without it.
const CONFIRMED: f64 = 50.0;
/// The same for a law that another contains.
const PLAIN: f64 = 1e-4;
const PLAIN_ERROR: f64 = 1e-3;
/// How many times the squared residual of noise free forces may leave where the laws behind them may still explain it.
const REACH: f64 = 4.0;
/// How many times that the best law regressed on the free forces may leave: where two parameters of friction that sticks are
/// those of a grid, it leaves some times what its fit on the response will.
const NEAR: f64 = 20.0;
/// Scaled squared residual within which places are worth trying with a law that was found elsewhere.
const ELSEWHERE: f64 = 40.0;
/// Squared residual per datum that the law nearest to the free forces leaves from which on the model is not exact.
const INEXACT: f64 = 30.0;

/// One effect more where a set agrees with the data, if it has overwhelming evidence: the sum of squares alone may hide
/// an effect that others stand in for.
fn confirm(reference: &ReferenceModel, found: &mut SearchResult) -> Result<(), DiagnosisError> {
    let Some(last) = found.by_size.last().filter(|_| found.by_size.len() < MOST_EFFECTS) else { return Ok(()) };
    let best = &last.fits[0];
    let (n, parameters) = (reference.count() as f64, best.parameters);
    let settled = |fit: &FittedModel| fit.chi_square <= n - parameters as f64 + SETTLED * (2.0 * n).sqrt();
    if settled(best) || best.chi_square > DOUBTFUL * n {
        return Ok(());
    }
    let quiet = ReferenceModel { noise: last.noise.clone(), ..reference.clone() };
    let (fits, noise) = quiet.polished(quiet.singles(Some(best))?)?;
    let Some(more) = fits.first() else { return Ok(()) };
    if reference.evidence(more, 1.0) + CONFIRMED < reference.evidence(best, 1.0) && settled(more) {
        let scale = scale_of(&fits, reference.count());
        found.by_size.push(FittedSets { probabilities: reference.probabilities(&fits), fits, scale, noise });
    }
    Ok(())
}

/// The search: with the model as it is, so far as free forces at one place or two could explain the data at all, then
/// with its updating parameters free.
pub(crate) fn explain(
    reference: ReferenceModel<'_>,
    before: f64,
) -> Result<Result<Outcome<'_>, Unreliable>, DiagnosisError> {
    if !reference.data.doubted.is_empty() {
        return beside_updating(reference, before);
    }
    let none = || SearchResult { updated: false, by_size: Vec::new(), agrees: false, before, without: 0.0 };
    let mut exact = none();
    let reach = reference.reach()?;
    let n = reference.count() as f64;
    let noise = REACH * (n + AGREES * (2.0 * n).sqrt());
    let within = |least: f64| least <= noise || least - n < LAST * (before - n);
    let single = if within(reach.single) { reference.regressed_within(NEAR * noise, before)? } else { None };
    if let Some(unfitted) = single {
        add_size(&reference, &mut exact, reference.fitted_singles(unfitted, None)?, (before, 0))?;
    } else {
        add_size(&reference, &mut exact, reference.ranked(reference.whole(None, STEPS)?), (before, 0))?;
        exact = if exact.agrees { exact } else { none() };
    }
    if exact.agrees {
        confirm(&reference, &mut exact)?;
        return Ok(Ok(Outcome { reference, found: exact }));
    }
    // Free forces at two places explain whatever two sensors see.
    let enough = reference.data.runs.iter().all(|run| run.alive.len() > 2);
    if enough && !within(reach.single) && reach.pair <= noise && two_at_once(&reference, &mut exact)? {
        confirm(&reference, &mut exact)?;
        return Ok(Ok(Outcome { reference, found: exact }));
    }
    // Where time is up, what was found on the model as it is is the best so far.
    if !exact.by_size.is_empty() && reference.control.is_late() {
        return Ok(Ok(Outcome { reference, found: exact }));
    }
    let stated = reference.clone();
    let found = beside_updating(reference, before)?;
    let doubtful = |outcome: &Outcome| !outcome.reference.linearisation.updating.is_plausible();
    // Corrections that no model needs stand in for a second effect: two may agree with the model as it is.
    if enough && found.as_ref().is_ok_and(doubtful) && !stated.control.is_late() && two_at_once(&stated, &mut exact)? {
        confirm(&stated, &mut exact)?;
        return Ok(Ok(Outcome { reference: stated, found: exact }));
    }
    Ok(found)
}

/// Whether two effects at once agree with the data; then they are what was found.
fn two_at_once(reference: &ReferenceModel, found: &mut SearchResult) -> Result<bool, DiagnosisError> {
    let (fits, noise) = reference.polished(distinct(reference.pairs()?))?;
    let fits = plainest(reference, found, fits);
    found.agrees = fits.first().is_some_and(|best| fits_well(reference, found, best));
    if found.agrees {
        found.by_size.push(FittedSets {
            scale: scale_of(&fits, reference.count()),
            probabilities: reference.probabilities(&fits),
            fits,
            noise,
        });
    }
    Ok(found.agrees)
}

/// Adds the sets of these fits if the best of them has the evidence.
pub(crate) fn add_size(
    reference: &ReferenceModel,
    found: &mut SearchResult,
    fits: Vec<FittedModel>,
    last: (f64, usize),
) -> Result<bool, DiagnosisError> {
    if found.by_size.is_empty() {
        (reference.early)(&conclusion::early(reference, &fits));
    }
    let (mut fits, mut noise) = reference.polished(fits)?;
    let Some(best) = fits.first() else { return Ok(false) };
    // Beside a model that is not exact none of them agrees: other laws and places are then looked at beside corrections.
    let inexact = best.chi_square > INEXACT * reference.count() as f64;
    if !inexact && !fits_well(reference, found, best) {
        let more = reference.generalisations(best, |_| true)?;
        fits.extend(more);
        (fits, noise) = reference.polished(distinct(reference.ranked(fits)))?;
    }
    let Some(best) = fits.first() else { return Ok(false) };
    if let Some(source) = best.effects.last().filter(|_| !inexact) {
        let quiet = ReferenceModel { noise: noise.clone(), ..reference.clone() };
        let margin = ELSEWHERE * scale_of(&fits, reference.count());
        let fresh = |r: &FittedModel| !fits.iter().any(|known| same_set(&known.effects, &r.effects));
        let moved: Vec<FittedModel> = quiet.elsewhere(best, source, margin)?.into_iter().filter(fresh).collect();
        if !moved.is_empty() {
            fits.extend(moved);
            (fits, noise) = quiet.polished(reference.ranked(fits))?;
        }
    }
    let fits = plainest(reference, found, fits);
    let Some(best) = fits.first() else { return Ok(false) };
    if best.parameters >= reference.count() {
        return Ok(false);
    }
    let scale = scale_of(&fits, reference.count());
    let penalty = best.parameters.saturating_sub(last.1) as f64 * (reference.count() as f64).ln();
    let gain = (last.0 - best.chi_square) / scale - penalty;
    if gain < EVIDENCE {
        return Ok(false);
    }
    found.agrees = fits_well(reference, found, best);
    found.by_size.push(FittedSets { probabilities: reference.probabilities(&fits), fits, scale, noise });
    Ok(true)
}

/// Without the sets whose laws contain simpler ones that leave no more than records and integrators are wrong by: what
/// little such laws explain beyond is as likely an error of those.
fn plainest(reference: &ReferenceModel, found: &SearchResult, mut fits: Vec<FittedModel>) -> Vec<FittedModel> {
    let enough = |fit: &FittedModel| small(reference, fit, found.before, [PLAIN, PLAIN_ERROR]);
    let contains = |set: &FittedModel, simple: &FittedModel| {
        simple.parameters < set.parameters && is_limit(&simple.effects, &set.effects) && enough(simple)
    };
    while let Some(best) = fits.first() {
        let Some(simple) = fits.iter().find(|r| contains(best, r)).cloned() else { break };
        fits.retain(|set| !contains(set, &simple));
    }
    fits
}
