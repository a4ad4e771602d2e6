//! What explains the runs of one level, carried to those of all: a joint that sticks at a low level makes a model without it wrong there
//! a thousandfold, which no linearisation of the model or of its residual gets over, while at the level at which the joint slips freely
//! the model is nearly right.

use super::beside_corrections::selected;
use crate::diagnosis::candidates::friction::friction;
use crate::diagnosis::residual::data::{Data, DiagnosisError, Problem, if_possible};
use crate::diagnosis::residual::levels::Levels;
use crate::diagnosis::residual::prediction::{Predictor, SEARCH};
use crate::diagnosis::selection::conclusion::{Outcome, UNEXPLAINED, corrections};
use crate::diagnosis::selection::estimator::Estimator;
use crate::diagnosis::selection::fits::STEPS;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::selection::search_result::{FittedSets, cost};
use crate::diagnosis::selection::solver_settings::has_friction;
use crate::diagnosis::selection::stepwise;
use crate::diagnosis::selection::unreliable::Unreliable;
use crate::diagnosis::updating::correction::{Correction, with_corrections};
use crate::diagnosis::updating::parameters::Updating;
use crate::effects::Source;
use crate::math::statistics::sum_of_squares;
use std::sync::Arc;

/// Fewest runs of a level that is searched alone.
const FEWEST: usize = 4;
/// Error of the model as it is stated, relative, from which on no step of its parameters gets over it, and how many times that of the
/// level at which it is least wrong.
const FAR: f64 = 10.0;
const NEARER: f64 = 3.0;
/// Levels that are tried.
const TRIED: usize = 2;
/// Sets of effects of a level that are carried to all runs.
const CARRIED: usize = 4;
/// Probability from which on they are.
const LIKELY: f64 = 0.01;
/// Rounds in which model and effects are settled.
const UPDATES: usize = 6;
/// Share of the friction found on one level with which it is begun on all.
const LOOSENED: f64 = 0.9;

/// What was found on the runs of one level.
struct OfLevel {
    sets: Vec<Vec<Source>>,
    corrections: Vec<Correction>,
}

/// The search on all runs of `reference`, which is as it was stated, from what explains those of one level on; none where there is but
/// one level or nothing explains any.
pub(crate) fn explain<'a>(
    problem: &Problem,
    reference: &ReferenceModel<'a>,
    before: f64,
) -> Result<Result<Option<Outcome<'a>>, Unreliable>, DiagnosisError> {
    for (_, runs) in levels(problem, reference).into_iter().take(TRIED) {
        let found = match if_possible(on_runs(problem, reference, &runs))? {
            Some(Ok(Some(found))) => found,
            Some(Err(fault)) => return Ok(Err(fault)),
            Some(Ok(None)) | None => continue,
        };
        let carried = |k: usize| if_possible(carried(reference, &found.sets[k], &found.corrections));
        let carried = reference.control.map(found.sets.len(), carried).into_iter().collect::<Result<Vec<_>, _>>()?;
        let fits: Vec<(ReferenceModel, FittedModel)> = carried.into_iter().flatten().collect();
        if fits.is_empty() || reference.control.is_late() {
            continue;
        }
        let bare = reference.bare()?;
        let here = bare.with_scales(bare.linearisation.updating.scales);
        return selected(reference, &bare, before, here, fits, None).map(|outcome| Ok(Some(outcome)));
    }
    Ok(Ok(None))
}

/// Whether the model as it is stated is so far off at one level, and so much nearer at another, that nothing is found from all.
pub(crate) fn is_far_at_one_level(problem: &Problem, reference: &ReferenceModel) -> bool {
    let errors: Vec<f64> = levels(problem, reference).into_iter().map(|(error, _)| error).collect();
    let most = errors.last().copied().unwrap_or(0.0);
    most > FAR && errors.first().is_some_and(|least| NEARER * least < most)
}

/// The runs of each level that has enough, with the error of the model as it is stated, the least first.
fn levels(problem: &Problem, reference: &ReferenceModel) -> Vec<(f64, Vec<usize>)> {
    let data = reference.data;
    if data.per_unit_force {
        return Vec::new();
    }
    let numbers = Levels::new(problem, data).numbers;
    let last = numbers.iter().max().copied().unwrap_or(0);
    let runs_of = |number: usize| (0..numbers.len()).filter(|&r| numbers[r] == number).collect::<Vec<usize>>();
    let error = |runs: &[usize]| {
        let own = Data { runs: runs.iter().map(|&r| data.runs[r].clone()).collect(), ..data.clone() };
        let predictions: Vec<_> = runs.iter().map(|&r| reference.predictions[r].clone()).collect();
        Estimator { data: &own, ..reference.estimator() }.error(&predictions, &[])
    };
    let levels = (0..=last).map(runs_of).filter(|runs| runs.len() >= FEWEST && runs.len() < numbers.len());
    let mut levels: Vec<(f64, Vec<usize>)> = levels.map(|runs| (error(&runs), runs)).collect();
    levels.sort_by(|a, b| a.0.total_cmp(&b.0));
    levels
}

/// What explains `runs` alone; none where no effect does. Or a run or channel that is not to be relied on.
fn on_runs(
    problem: &Problem,
    all: &ReferenceModel,
    runs: &[usize],
) -> Result<Result<Option<OfLevel>, Unreliable>, DiagnosisError> {
    let own = runs.iter().map(|&r| all.data.runs[r].clone()).collect();
    let data = Data { runs: own, sessions: Vec::new(), ..all.data.clone() };
    let predictor = Arc::new(Predictor::new(problem.structure, problem.known(), &data)?);
    let reference = ReferenceModel::new(predictor, &data, all.control, &|_| {})?;
    let before = sum_of_squares(&reference.estimator().residual(&reference.predictions));
    let outcome = match stepwise::explain(reference, before)? {
        Ok(outcome) => outcome,
        Err(fault) => return Ok(Err(fault)),
    };
    let agrees = |top: &&FittedSets| top.fits[0].chi_square <= UNEXPLAINED * outcome.reference.count() as f64;
    let Some(top) = outcome.found.by_size.last().filter(agrees) else { return Ok(Ok(None)) };
    let likely = top.fits.iter().zip(&top.probabilities).enumerate();
    let likely = likely.filter(|(k, (_, probability))| *k == 0 || **probability > LIKELY);
    let sets = likely.take(CARRIED).map(|(_, (fit, _))| fit.effects.clone()).collect();
    Ok(Ok(Some(OfLevel { sets, corrections: corrections(&outcome.reference) })))
}

/// The effects and `corrections` of one level settled on all runs, from where they leave least there: as they are, with friction that lets
/// go where as large as it is everything sticks, which has no derivative, or with the model moved beside the effects from where it was
/// stated on, as friction may be known of a level that says little of the structure.
fn carried<'a>(
    reference: &ReferenceModel<'a>,
    effects: &[Source],
    corrections: &[Correction],
) -> Result<(ReferenceModel<'a>, FittedModel), DiagnosisError> {
    let (stated, known) = reference.predictor.stated();
    let updating = with_corrections(Updating::all(stated, known, reference.data), corrections);
    let begun = |effects: &[Source]| {
        let there = reference.updated_as(&updating, effects, &Vec::new(), &SEARCH)?;
        let fit = there.estimator().fit(effects, STEPS, &SEARCH, &Vec::new())?;
        Ok::<_, DiagnosisError>((there, fit))
    };
    let mut best = begun(effects)?;
    let less = has_friction(effects).then(|| begun(&loosened(effects))).transpose()?;
    let as_found = reference.estimator().fit(effects, 0, &SEARCH, &Vec::new())?;
    for other in less.into_iter().chain(reference.moved_from_stated(&as_found, &SEARCH)?) {
        best = if cost(&other.0, Some(&other.1)) < cost(&best.0, Some(&best.1)) { other } else { best };
    }
    best.0.converged(best.1, &SEARCH, UPDATES)
}

/// The `effects` with friction that slides a little earlier.
fn loosened(effects: &[Source]) -> Vec<Source> {
    let loosened = |source: &Source| {
        let mut source = source.clone();
        let linear = source.effect.parameters().iter().map(|parameter| parameter.linear);
        for (value, linear) in source.parameters.iter_mut().zip(linear) {
            *value *= if linear { LOOSENED } else { 1.0 };
        }
        source
    };
    effects
        .iter()
        .map(|source| if friction(source.effect).is_some() { loosened(source) } else { source.clone() })
        .collect()
}
