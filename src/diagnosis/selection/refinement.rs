//! Candidates beside updating parameters: laws regressed at the measured motion, each refined with a model of its own.

use super::search::{View, joined};
use super::short_list::{
    Breadth, is_plain_friction_of, plain_friction_first, without_falling_friction, without_idle_parameters,
};
use super::weighing::{bound_beside, by_simplest_name};
use crate::diagnosis::candidates::friction::friction;
use crate::diagnosis::candidates::start::{UnfittedSet, start};
use crate::diagnosis::localisation::free_force::BesideWhole;
use crate::diagnosis::residual::data::{DiagnosisError, if_possible};
use crate::diagnosis::residual::prediction::SEARCH;
use crate::diagnosis::selection::estimator::Starts;
use crate::diagnosis::selection::fits::STEPS;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::selection::search_result::{agrees, cost};
use crate::diagnosis::selection::solver_settings::settings_for;
use crate::diagnosis::updating::measured_motion::MeasuredMotion;
use crate::diagnosis::updating::parameters::Updating;
use crate::effects::{Effect, Kind, Place, Source, State};
use crate::math::statistics::bayesian_information;
use crate::response::harmonic_balance::Settings;
use crate::response::sensitivity::Unknown;
use faer::c64;
use std::sync::Arc;

/// Most candidates that are refined.
const FOLLOWED: usize = 8;
/// Most of one place.
const AT_ONE_PLACE: usize = 4;
/// Scaled score beyond the best up to which candidates are refined.
const MARGIN: f64 = 60.0;
/// Squared residual per datum of the best from which on candidates of twice that are refined too: what it leaves beyond the
/// noise is the error of the motion between the sensors, which is no law's. Linear laws are refined in no time.
const COARSE: f64 = 3.0;
const COARSE_FOR_LINEAR: f64 = 1.5;
/// Best sets whose limits are refined too, and how many times their score those may leave.
const WITH_LIMITS: usize = 2;
const LIMIT: f64 = 2.0;
/// The same of friction, which is regressed badly where it sticks: plain friction, the hidden one, was not among the candidates of
/// development project 508.
const LIMIT_OF_FRICTION: f64 = 10.0;
/// Candidates that are refined to the end.
const FINALISTS: usize = 4;
/// Times that a model is updated beside its candidate.
const UPDATES: usize = 6;
/// Share of the squared residual of the stated model which a law of the whole structure may leave beside it to be refined from
/// there: a model that is off in frequency by some per cent leaves about as much with as without it.
const STANDS_OUT: f64 = 0.2;
/// How many times what its regression predicts a candidate may leave before shorter steps of the model beside it are tried, and
/// these, as shares of the whole. Both are linear in the model: fits that hold to it leave as much as is predicted, those that had
/// landed on another resonance (development seeds 441 and 522) tens of times as much.
const MISSED: f64 = 3.0;
const SHARES: [f64; 3] = [0.3, 0.1, 0.0];
/// Share of the evidence that a further effect must bring in the end which it must bring by its first fit.
const BROUGHT: f64 = 0.5;

impl<'a> ReferenceModel<'a> {
    /// The candidates among `unfitted`, regressed beside the model as it is, that are worth refining, each fitted with a model
    /// updated beside it.
    pub(crate) fn refined(
        &self,
        unfitted: Vec<UnfittedSet>,
    ) -> Result<Vec<(ReferenceModel<'a>, FittedModel)>, DiagnosisError> {
        let unfitted = without_idle_parameters(without_falling_friction(unfitted), self.count());
        let unfitted = preselected(unfitted, self.count());
        let mut view = self.view(None)?;
        let mut targets = Vec::with_capacity(unfitted.len());
        for unfitted in &unfitted {
            targets.push(self.updated_beside(&mut view, unfitted)?);
        }
        drop(view);
        self.all_refined(&unfitted, f64::INFINITY, |k, most| {
            self.refined_set(&unfitted[k], targets[k].as_deref(), &[], &SEARCH, most)
        })
    }

    /// The law of the whole structure that explains most beside this model, which is as it was stated, with the model then updated
    /// beside it; none where even that leaves much. Free forces at one place stand for damping everywhere so badly that the model
    /// localised beside them may be far off any in which the law would be seen. It is followed so far as its evidence may get near that
    /// of the best of `others`.
    pub(crate) fn refined_whole(
        &self,
        before: f64,
        others: &[(ReferenceModel, FittedModel)],
    ) -> Result<Vec<(ReferenceModel<'a>, FittedModel)>, DiagnosisError> {
        let fits = self.whole(None, STEPS)?;
        let best = fits.into_iter().min_by(|a, b| a.chi_square.total_cmp(&b.chi_square));
        let Some(fit) = best.filter(|fit| fit.chi_square < STANDS_OUT * before) else { return Ok(Vec::new()) };
        let most = others.iter().map(|(reference, fit)| bound_beside(reference, fit)).fold(f64::INFINITY, f64::min);
        Ok(if_possible(self.refined_from(&fit, most))?.into_iter().collect())
    }

    /// The effects of `fit`, which is beside this model as it was stated, with a model updated beside them, so far as their evidence
    /// may get below `most`.
    fn refined_from(&self, fit: &FittedModel, most: f64) -> Result<(ReferenceModel<'a>, FittedModel), DiagnosisError> {
        let (stated, known) = self.predictor.stated();
        let updating = Updating::all(stated, known, self.data);
        let reference = self.updated_as(&updating, &fit.effects, &fit.starts, &SEARCH)?;
        let fit = reference.estimator().fit(&fit.effects, STEPS, &SEARCH, &fit.starts)?;
        reference.converged_below(most, fit, &SEARCH, UPDATES)
    }

    /// The effects of `fit`, as they are there, with a model that is moved beside them from where it was stated on, and then both: a
    /// descent in which model and effects were far off together, as beside friction that sticks, may have ended in a local minimum. They
    /// are followed so far as their evidence may get near what it was.
    pub(super) fn begun_again(
        &self,
        fit: &FittedModel,
    ) -> Result<Option<(ReferenceModel<'a>, FittedModel)>, DiagnosisError> {
        let settings = settings_for(fit, self.count(), &SEARCH);
        let Some((reference, again)) = self.moved_from_stated(fit, settings)? else { return Ok(None) };
        reference.converged_below(bound_beside(self, fit), again, &SEARCH, UPDATES).map(Some)
    }

    /// The same fitted on fundamentals alone first, then on all harmonics: one that falls into a resonance above the band is not linear in
    /// the model, and quiet as sensors are it weighs more than all fundamentals do.
    pub(super) fn begun_by_fundamentals(
        &self,
        fit: &FittedModel,
    ) -> Result<Option<(ReferenceModel<'a>, FittedModel)>, DiagnosisError> {
        let settings = settings_for(fit, self.count(), &SEARCH);
        let Some((reference, begun)) = self.of_fundamentals().moved_from_stated(fit, settings)? else {
            return Ok(None);
        };
        let (there, begun) = reference.converged(begun, &SEARCH, UPDATES)?;
        let all = self.updated_as(&there.linearisation.updating, &begun.effects, &begun.starts, settings)?;
        let again = all.refitted(&begun, settings)?;
        all.converged(again, &SEARCH, UPDATES).map(Some)
    }

    /// The model moved beside the effects of `fit` from where it was stated on, and these then fitted beside it; none where there is no such
    /// model.
    pub(super) fn moved_from_stated(
        &self,
        fit: &FittedModel,
        settings: &Settings,
    ) -> Result<Option<(ReferenceModel<'a>, FittedModel)>, DiagnosisError> {
        let (stated, known) = self.predictor.stated();
        let updating = Updating::all(stated, known, self.data);
        let stepped = self.stepped(updating, &fit.effects, &fit.starts, settings)?;
        let Some((_, reference)) = stepped else { return Ok(None) };
        let fitted = reference.refitted(fit, settings)?;
        Ok(Some((reference, fitted)))
    }

    /// The candidates refined a little, the best of them to the end; none whose evidence is not below `bound` by then. The first is the
    /// likeliest: what gets nowhere near it is not refined, nor friction that falls where it is plain friction that leaves noise alone.
    fn all_refined<'s>(
        &self,
        unfitted: &[UnfittedSet],
        bound: f64,
        refine: impl Fn(usize, f64) -> Result<(ReferenceModel<'s>, FittedModel), DiagnosisError> + Sync,
    ) -> Result<Vec<(ReferenceModel<'s>, FittedModel)>, DiagnosisError> {
        // What further effects there are is worth no more time than there is.
        let begin = |k: usize, most: f64| {
            if bound < f64::INFINITY && self.control.is_late() { Ok(None) } else { if_possible(refine(k, most)) }
        };
        let first = if unfitted.is_empty() { None } else { begin(0, bound)? };
        let most = first.as_ref().map_or(bound, |(reference, fit)| bound_beside(reference, fit).min(bound));
        let settled = first.as_ref().filter(|(reference, fit)| agrees(reference, fit.chi_square, fit.parameters));
        let plain =
            |set: &UnfittedSet| settled.is_some_and(|(_, fit)| is_plain_friction_of(&fit.effects, &set.effects));
        let others: Vec<usize> = (1..unfitted.len()).filter(|&k| !plain(&unfitted[k])).collect();
        let others = self.control.map(others.len(), |k| begin(others[k], most));
        let others = others.into_iter().collect::<Result<Vec<_>, _>>()?;
        let begun = by_simplest_name(first.into_iter().chain(others.into_iter().flatten()).collect())?.into_iter();
        let mut begun: Vec<_> = begun.filter(|(r, fit)| cost(r, Some(fit)) < bound).collect();
        begun.sort_by(|a, b| cost(&a.0, Some(&a.1)).total_cmp(&cost(&b.0, Some(&b.1))));
        let near = begun.first().map_or(0.0, |(reference, fit)| bound_beside(reference, fit));
        let finalists = begun.iter().take(FINALISTS).take_while(|(reference, fit)| cost(reference, Some(fit)) < near);
        let rest = begun.split_off(finalists.count());
        let further = |k: usize| {
            let (reference, fit) = &begun[k];
            reference.with_scales(reference.linearisation.updating.scales).converged(fit.clone(), &SEARCH, UPDATES - 1)
        };
        let mut fits = self.control.map(begun.len(), further).into_iter().collect::<Result<Vec<_>, _>>()?;
        fits.extend(rest);
        Ok(fits)
    }

    /// The candidates for one effect beside those of `from`, each fitted with a model updated beside it; none where none
    /// would bring `evidence`.
    pub(crate) fn refined_beside(
        &self,
        from: &FittedModel,
        evidence: f64,
    ) -> Result<Vec<(ReferenceModel<'a>, FittedModel)>, DiagnosisError> {
        let mut view = self.view(Some(from))?;
        let bound = view.screen.nothing() - evidence;
        let mut unfitted = self.unfitted(&mut view, &from.effects, Breadth::All)?;
        drop(view);
        unfitted.retain(|d| d.score < bound);
        unfitted.sort_by(|a, b| a.score.total_cmp(&b.score));
        let unfitted = preselected(without_falling_friction(unfitted), self.count());
        // On the same footing as what they are beside.
        let settings = settings_for(from, self.count(), &SEARCH);
        self.all_refined(&unfitted, cost(self, Some(from)) - BROUGHT * evidence, |k, most| {
            self.refined_set(&unfitted[k], None, &from.effects, settings, most)
        })
    }

    /// A candidate fitted on the response, then with the updating parameters beside it, which start at `target`, so far as its
    /// evidence may get below `most`.
    fn refined_set(
        &self,
        unfitted: &UnfittedSet,
        target: Option<&[f64]>,
        others: &[Source],
        settings: &Settings,
        most: f64,
    ) -> Result<(ReferenceModel<'a>, FittedModel), DiagnosisError> {
        let effects = joined(others, &unfitted.effects);
        let sources = self.predictor.sources(&effects);
        let runs = self.data.runs.iter().zip(unfitted.fields.iter());
        let starts: Starts = runs.map(|(run, field)| start(&sources, run.omega, field)).collect();
        let begun = |u: &[f64]| {
            let reference = self.updated_as(&self.linearisation.updating.at(u), &effects, &starts, settings)?;
            let fit = reference.estimator().fit(&effects, STEPS, settings, &starts)?;
            Ok((reference, fit))
        };
        let here = self.linearisation.updating.standardised();
        let whole = begun(target.unwrap_or(&here))?;
        let left = MISSED * unfitted.score.max(self.count() as f64);
        let (reference, fit) = match target {
            Some(target) if whole.1.chi_square > left && !self.control.is_late() => {
                shortened(whole, &here, target, begun)?
            }
            _ => whole,
        };
        reference.converged_below(most, fit, &SEARCH, 1)
    }

    /// The laws of the whole structure, regressed at the measured motion beside the updating parameters as free forces at one
    /// place are, and these.
    pub(crate) fn whole_sets(&self, view: &View) -> Vec<(UnfittedSet, Vec<f64>)> {
        let Some(seen) = MeasuredMotion::new(&self.predictor, self.data, &self.predictions, 1, self.control) else {
            return Vec::new();
        };
        let sum = [(Unknown::Source { source: 0, parameter: 0 }, 1.0)];
        let unfitted = |effect: Effect| {
            let unit = Source { effect, place: Place::Whole(None), state: State::Known, parameters: vec![1.0] };
            if !self.data.allows(&unit) {
                return None;
            }
            let column = |r: usize| {
                let slope = seen.slope(r, std::slice::from_ref(&unit), &sum);
                self.noise.runs[r].apply(1, |c| slope[c][0])
            };
            let columns: Vec<Vec<c64>> = (0..self.data.runs.len()).map(column).collect();
            let BesideWhole { value, chi_square, updated } = view.screen.beside_whole(&columns)?;
            let source = Source { parameters: vec![value], ..unit };
            let score = bayesian_information(chi_square, 1, self.count());
            let set = UnfittedSet { effects: vec![source], score, fields: Arc::default() };
            effect.parameters()[0].allows(value).then_some((set, updated))
        };
        Effect::ALL.into_iter().filter(|e| matches!(e.kind(), Kind::Whole(_))).filter_map(unfitted).collect()
    }

    /// Whitened derivative of all runs by the parameter of a linear law.
    pub(super) fn linear_rows(&self, seen: &MeasuredMotion, unit: &Source) -> Vec<f64> {
        let mut rows = Vec::with_capacity(self.count());
        let sum = [(Unknown::Source { source: 0, parameter: 0 }, 1.0)];
        for r in 0..self.data.runs.len() {
            let slope = seen.slope(r, std::slice::from_ref(unit), &sum);
            self.estimator().whitened(r, &mut rows, |c, h| slope[c][h - 1]);
        }
        rows
    }
}

/// The candidate of the step, `whole` or a share of it from `here` to `target`, or of the model as it is stated, that leaves least with
/// the model where it begins: the whole is right where the response is as linear in the model as it is at the measured motion.
fn shortened<'a>(
    whole: (ReferenceModel<'a>, FittedModel),
    here: &[f64],
    target: &[f64],
    begun: impl Fn(&[f64]) -> Result<(ReferenceModel<'a>, FittedModel), DiagnosisError>,
) -> Result<(ReferenceModel<'a>, FittedModel), DiagnosisError> {
    let left = |(reference, fit): &(ReferenceModel, FittedModel)| {
        let predictions = reference.predictions_with(&fit.effects, &fit.starts, &SEARCH)?;
        Ok::<f64, DiagnosisError>(reference.cost_at_reference(&predictions))
    };
    let mut least = left(&whole)?;
    let mut best = whole;
    let share_of_step =
        |share: f64| -> Vec<f64> { here.iter().zip(target).map(|(u, to)| u + share * (to - u)).collect() };
    let stated = vec![0.0; here.len()];
    for part in SHARES.map(share_of_step).into_iter().chain([stated]) {
        let Some(tried) = if_possible(begun(&part))? else { continue };
        let then = left(&tried)?;
        if then < least {
            (best, least) = (tried, then);
        }
    }
    Ok(best)
}

/// The best sets, no more than a few at one place, plain friction before friction that falls.
fn preselected(unfitted: Vec<UnfittedSet>, count: usize) -> Vec<UnfittedSet> {
    let Some(best) = unfitted.first().map(|d| d.score) else { return unfitted };
    let scale = (best / count.max(1) as f64).max(1.0);
    // Where even the best leaves much, the motion between the sensors is not known well enough to tell them apart.
    let margin = |d: &UnfittedSet| {
        let linear = d.effects.iter().all(|e| e.effect.is_linear());
        let coarse = if linear { COARSE_FOR_LINEAR } else { COARSE };
        if scale > coarse { best } else { MARGIN * scale }
    };
    let near: Vec<&UnfittedSet> = unfitted.iter().filter(|d| d.score < best + margin(d)).collect();
    let mut kept: Vec<UnfittedSet> = Vec::new();
    for &unfitted in &near {
        let here = kept.iter().filter(|k| k.effects[0].place == unfitted.effects[0].place).count();
        if here < AT_ONE_PLACE && kept.len() < FOLLOWED {
            kept.push(unfitted.clone());
        }
    }
    // Where hardly another place may be it, more of its laws.
    for &unfitted in &near {
        let known = |k: &UnfittedSet| k.effects[0].is_same(&unfitted.effects[0]);
        if kept.len() < FOLLOWED && !kept.iter().any(known) {
            kept.push(unfitted.clone());
        }
    }
    plain_friction_first(with_limits(kept, &unfitted))
}

/// The best sets with the simpler laws that they contain as limits, from all `unfitted`.
fn with_limits(mut kept: Vec<UnfittedSet>, unfitted: &[UnfittedSet]) -> Vec<UnfittedSet> {
    for set in kept.clone().iter().take(WITH_LIMITS) {
        let (effect, place) = (set.effects[0].effect, &set.effects[0].place);
        for simpler in effect.limits() {
            let is = |d: &&UnfittedSet| d.effects[0].effect == simpler && d.effects[0].place.is_same(place);
            let most = if friction(effect).is_some() { LIMIT_OF_FRICTION } else { LIMIT };
            let near = |d: &&UnfittedSet| d.score < most * set.score.abs();
            if !kept.iter().any(|d| is(&d)) {
                kept.extend(unfitted.iter().find(is).filter(near).cloned());
            }
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::diagnosis::selection::stated_chain::{hidden, with_stated};

    /// Far from the law that acts and from the ground spring there is, fundamentals lead to both.
    #[test]
    fn a_fit_begun_by_fundamentals_arrives_where_all_harmonics_are_explained() {
        let start = Source { parameters: vec![0.3 * hidden().parameters[0]], ..hidden() };
        with_stated(std::slice::from_ref(&start), |reference| {
            let fit = reference.estimator().fit(std::slice::from_ref(&start), 0, &SEARCH, &Vec::new()).unwrap();
            let (there, fit) = reference.begun_by_fundamentals(&fit).unwrap().unwrap();
            assert!(!there.linearisation.of_fundamentals);
            assert!((fit.effects[0].parameters[0] / hidden().parameters[0] - 1.0).abs() < 0.01, "{:?}", fit.effects);
            assert!(fit.chi_square < 2.0 * there.count() as f64, "{} of {}", fit.chi_square, there.count());
        });
    }
}
