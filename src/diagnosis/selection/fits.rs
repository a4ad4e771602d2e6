//! Fits of sets on the response: all of them a little, those that may become the best to the end, the best with all harmonics.

use crate::diagnosis::candidates::special_cases::is_limit;
use crate::diagnosis::candidates::start::{UnfittedSet, start};
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::residual::prediction::{FINAL, SEARCH};
use crate::diagnosis::selection::estimator::{Estimator, Starts};
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::{ReferenceModel, scale_of};
use crate::diagnosis::selection::search::joined;
use crate::diagnosis::selection::search_result::same_set;
use crate::diagnosis::updating::noise_model::NoiseModel;
use crate::effects::{Effect, Place, Source, State, WholeLaw};
use std::sync::Arc;

/// Of these, sets that are fitted with all harmonics that matter.
const POLISHED: usize = 6;
/// The same where even the best leaves more than this of its squared residual per datum: there, all harmonics are not what
/// is missing.
const ROUGHLY: usize = 2;
const COARSE: f64 = 30.0;
/// The same from which on no simpler law is fitted beside the best.
const TOO_COARSE: f64 = 1e3;
/// Steps of a fit on the response: of all sets, and of those that may still become the best.
pub(crate) const FIRST_STEPS: usize = 4;
pub(crate) const STEPS: usize = 20;
/// Gain of the squared residual, in units of what the best leaves per datum, that is worth going on for.
const LEFT: f64 = 0.1;
/// Share of its squared residual that a fit has to go from which on it has not arrived.
const FAR: f64 = 0.1;
/// Share of its squared residual that a fit under way is expected to gain at most.
const GAIN: f64 = 0.9;
/// Evidence by which a fit under way may be expected to end behind the best and still be refined.
const MOST_BEHIND: f64 = 60.0;

impl ReferenceModel<'_> {
    /// Fits the sets on the response: all of them a little, those that may still become the best to the end.
    pub(crate) fn fit_all(&self, unfitted: &[UnfittedSet]) -> Result<Vec<FittedModel>, DiagnosisError> {
        self.finished(self.begun(unfitted)?)
    }

    /// First steps of a fit of every set, from the motion that the data show.
    pub(crate) fn begun(&self, unfitted: &[UnfittedSet]) -> Result<Vec<FittedModel>, DiagnosisError> {
        let first = |k: usize| {
            let unfitted = &unfitted[k];
            let sources = self.predictor.sources(&unfitted.effects);
            let runs = self.data.runs.iter().zip(unfitted.fields.iter());
            let starts: Starts = runs.map(|(run, field)| start(&sources, run.omega, field)).collect();
            self.estimator().fit(&unfitted.effects, FIRST_STEPS, &SEARCH, &starts)
        };
        self.control.map(unfitted.len(), first).into_iter().collect()
    }

    /// The fits that may still become the best, refined to the end; the others as they are. Valleys of the misfit are long where
    /// corrections are free beside effects much like them: those that are still expected to be the best go on once more.
    pub(crate) fn finished(&self, begun: Vec<FittedModel>) -> Result<Vec<FittedModel>, DiagnosisError> {
        let once = self.refined_once(begun)?;
        self.refined_once(once)
    }

    fn refined_once(&self, begun: Vec<FittedModel>) -> Result<Vec<FittedModel>, DiagnosisError> {
        let scale = scale_of(&begun, self.count());
        let best = begun.iter().map(|r| self.evidence(r, scale)).fold(f64::INFINITY, f64::min);
        let expected = |r: &FittedModel| self.evidence(r, scale) - r.descent.to_go.min(GAIN * r.chi_square) / scale;
        let go_on = |k: usize| {
            let fit = &begun[k];
            if fit.descent.to_go < LEFT * scale || expected(fit) > best + MOST_BEHIND {
                return Ok(fit.clone());
            }
            self.estimator().fit(&fit.effects, STEPS, &SEARCH, &fit.starts)
        };
        self.control.map(begun.len(), go_on).into_iter().collect()
    }

    /// The laws of the whole structure, from a light start.
    pub(crate) fn whole(&self, from: Option<&FittedModel>, steps: usize) -> Result<Vec<FittedModel>, DiagnosisError> {
        let effects = from.map_or(&[][..], |fit| &fit.effects);
        let omega = self.data.runs.iter().map(|r| r.omega.ln()).sum::<f64>() / self.data.runs.len() as f64;
        let omega = omega.exp();
        let light = |(effect, law): (Effect, &dyn WholeLaw)| {
            // The same share of the force of the springs at the mean frequency, whatever the law multiplies.
            let square = omega * omega;
            let unit = square / (law.basis().of_mode(square) * law.factor(1.0, omega).norm());
            Source { effect, place: Place::Whole(None), state: State::Known, parameters: vec![3e-3 * unit] }
        };
        let sets: Vec<Vec<Source>> = Effect::of_whole_structures()
            .filter(|(effect, _)| !effects.iter().any(|e| e.effect == *effect))
            .map(light)
            .filter(|source| self.data.allows(source))
            .map(|source| joined(effects, &[source]))
            .collect();
        let fit = |k: usize| self.estimator().fit(&sets[k], steps, &SEARCH, &[]);
        self.control.map(sets.len(), fit).into_iter().collect()
    }

    /// The sets of `fits` in which a law is all but a simpler one, with that in its stead.
    fn by_simpler_laws(&self, fits: &[FittedModel]) -> Result<Vec<FittedModel>, DiagnosisError> {
        let named = |fit: &FittedModel| -> Option<Vec<Source>> {
            let mut plain = fit.effects.clone();
            fit.all_but_simpler().for_each(|(k, simpler)| plain[k] = simpler);
            (plain != fit.effects).then_some(plain)
        };
        let fresh = |effects: &Vec<Source>| {
            !fits.iter().any(|r| same_set(&r.effects, effects)) && effects.iter().all(|e| self.data.allows(e))
        };
        let sets: Vec<Vec<Source>> = fits.iter().filter_map(named).filter(fresh).collect();
        let fit = |k: usize| self.estimator().fit(&sets[k], STEPS, &SEARCH, &[]);
        self.control.map(sets.len(), fit).into_iter().collect()
    }

    /// Fits the best of `fits` again with all harmonics that matter and the noise of the best of them, truncation
    /// included; the others follow as they are.
    pub(crate) fn polished(
        &self,
        fits: Vec<FittedModel>,
    ) -> Result<(Vec<FittedModel>, Arc<NoiseModel>), DiagnosisError> {
        let mut best = fits;
        let scale = scale_of(&best, self.count());
        let bound = best.first().map_or(0.0, |r| self.evidence(r, scale)) + MOST_BEHIND;
        let near = best.iter().take_while(|r| self.evidence(r, scale) < bound).count();
        let most = if scale > COARSE { ROUGHLY } else { POLISHED };
        let mut rest = best.split_off(near.clamp(1, most).min(best.len()));
        // Few harmonics speak for laws that can bend to what they lack: the simpler ones are fitted as well.
        if let Some(set) = best.first().filter(|_| scale < TOO_COARSE).map(|r| r.effects.clone()) {
            let (simpler, others) = rest.into_iter().partition(|r| is_limit(&r.effects, &set));
            best.extend::<Vec<FittedModel>>(simpler);
            rest = others;
        }
        best.extend(self.by_simpler_laws(&best)?);
        let mut noise = self.noise.clone();
        for steps in [8, 4] {
            let estimator = Estimator { noise: &noise, ..self.estimator() };
            let again = |k: usize| {
                let fit = &best[k];
                let arrived = fit.descent.to_go < FAR * fit.chi_square;
                let steps = if arrived { steps } else { STEPS };
                estimator.fit(&fit.effects, steps, &FINAL, &fit.starts)
            };
            let fits = self.control.map(best.len(), again).into_iter().collect::<Result<Vec<_>, _>>()?;
            best = self.ranked(fits);
            let Some(first) = best.first() else { break };
            let predictions = self.estimator().predict(&first.effects, &FINAL, &first.starts)?;
            noise = Arc::new(self.noise_of(&first.effects, &predictions)?);
        }
        best.extend(rest);
        Ok((best, noise))
    }
}
