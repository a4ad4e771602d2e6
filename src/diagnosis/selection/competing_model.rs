//! What effects beside corrections are to be better than: the model with corrections alone, then with the effects before them.

use crate::diagnosis::residual::data::{DiagnosisError, if_possible};
use crate::diagnosis::selection::conclusion::UNEXPLAINED;
use crate::diagnosis::selection::cross_validation::{exceeds, groups};
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::{ReferenceModel, scale_of};
use crate::diagnosis::selection::search_result::{DOUBTFUL, explains_by_scatter};
use crate::diagnosis::selection::weighing::{LIGHT, Weighed};
use crate::diagnosis::updating::detuning::is_likely;
use crate::effects::{Kind, Source};

/// Evidence that an effect must bring beside corrections, whose freedom has its cost already: having been chosen among some thousand.
pub(super) const CHOSEN: f64 = 16.0;
/// The same of one spring or mass in place of many corrections: having been chosen among some sixty places, each the likelier by
/// none of the corrections being larger than models are wrong by.
const CHANGED: f64 = 6.0;
/// The same of a further effect there, real models lack a little everywhere, and of a spring or a mass, which is like a
/// correction itself.
pub(super) const FURTHER: f64 = 100.0;
/// Squared residual per datum of corrections as they are first found, over that of the best effect, from which on they do not
/// compete with it.
const COMPETING: f64 = 4.0;
/// How many times the error of the effects before it, as `compare` shows it, a further effect may leave: errors that the runs have of their
/// own scatter by that.
pub(super) const RAISED: f64 = 1.1;
/// Share of the error of the stated model that effects may leave where corrections that raise it do not compete: further
/// than chance or one run on another branch would bring them.
const HALVED: f64 = 0.5;

/// A model with its evidence; the smaller, the better.
type WithEvidence<'a> = (ReferenceModel<'a>, f64);

/// The model that the next effect is to be better than.
pub(super) struct CompetingModel<'a, 'b> {
    /// The model with corrections as large as models are wrong by.
    bare: &'b ReferenceModel<'a>,
    /// Error of the model as it is stated.
    stated: f64,
    /// The model with its evidence: none before corrections alone were looked at.
    model: Option<WithEvidence<'a>>,
    /// Whether it and the effects are near enough to be judged by what they predict.
    near: bool,
}

impl<'a, 'b> CompetingModel<'a, 'b> {
    /// Corrections alone, `corrected` where they were looked at before.
    pub(super) fn new(bare: &'b ReferenceModel<'a>, stated: f64, corrected: Option<WithEvidence<'a>>) -> Self {
        Self { bare, stated, model: corrected, near: false }
    }

    /// Evidence of the model.
    pub(super) fn least(&self) -> f64 {
        self.model.as_ref().map_or(f64::INFINITY, |(_, least)| *least)
    }

    /// Probability of the best of `weighed` against corrections alone, where it is one spring or mass, which they can stand for: what it
    /// brings beyond the evidence for having been chosen are twice the logarithms of the odds. 1 of all else.
    pub(super) fn odds_of_change(&self, weighed: &Weighed) -> f64 {
        if !is_single_change(&weighed.fits[0].effects) || self.bare.linearisation.updating.is_by_modes() {
            return 1.0;
        }
        let scale = scale_of(&weighed.fits, weighed.reference.count());
        odds((self.least() - weighed.least) / scale - CHANGED)
    }

    /// Puts the model with an effect more, whose evidence is `least`, in its place.
    pub(super) fn replace(&mut self, model: ReferenceModel<'a>, least: f64) {
        self.model = Some((model, least));
    }

    /// The model where it was not beaten any more.
    pub(super) fn into_model(self) -> Result<ReferenceModel<'a>, DiagnosisError> {
        match self.model {
            Some((model, _)) => Ok(model),
            None => Ok(self.bare.likely(f64::INFINITY)?.0),
        }
    }

    /// Whether the best of `weighed`, beside the effects `from`, is a better model, by its evidence and by what it predicts.
    pub(super) fn is_beaten_by(
        &mut self,
        weighed: &Weighed<'a>,
        from: Option<&FittedModel>,
    ) -> Result<bool, DiagnosisError> {
        let best = &weighed.fits[0];
        let scale = scale_of(&weighed.fits, weighed.reference.count());
        let raises = self.is_error_raised(weighed, from)?;
        let allowed = !raises && best.parameters < weighed.reference.count();
        let by_modes = self.bare.linearisation.updating.is_by_modes();
        let most = weighed.least + scale * evidence_needed(&best.effects, by_modes);
        if from.is_none() {
            let corrected = self.model.take();
            self.model =
                Some(self.corrections_alone(corrected, weighed, if allowed { most } else { f64::INFINITY })?);
        }
        let Some((model, least)) = &self.model else { return Ok(false) };
        if !allowed || *least < most {
            return Ok(false);
        }
        if (self.near || from.is_some()) && !predicts_better(weighed, model, from)? {
            // Corrections alone were followed only so far as they were to be judged.
            self.model = self.model.take().filter(|_| from.is_some());
            return Ok(false);
        }
        Ok(true)
    }

    /// Whether the best of `weighed` leaves more than what was before it, beyond what a few runs on the other side of a jump do.
    fn is_error_raised(&self, weighed: &Weighed, from: Option<&FittedModel>) -> Result<bool, DiagnosisError> {
        let (best, before) = (&weighed.fits[0], from.map(|from| from.error));
        let raises = |error: f64, _: f64| raises_error(error, before, self.stated);
        weighed.reference.leaves(raises, [best.error, 0.0], &best.effects, &best.starts)
    }

    /// The model with corrections alone, as it was `corrected` before, or not followed where its evidence would stay above `most`.
    fn corrections_alone(
        &mut self,
        corrected: Option<WithEvidence<'a>>,
        weighed: &Weighed<'a>,
        most: f64,
    ) -> Result<WithEvidence<'a>, DiagnosisError> {
        let (bare, best) = (self.bare, &weighed.fits[0]);
        let scale = scale_of(&weighed.fits, weighed.reference.count());
        let doubtful = best.effects.iter().any(|e| e.effect.is_mass_or_spring()) || scale > DOUBTFUL;
        let misfit = bare.misfit();
        self.near = misfit < COMPETING * scale || doubtful;
        let mut alone = match corrected {
            Some(corrected) => corrected,
            // Corrections are fitted as freely as they are likely in `bare` already.
            None if most < f64::INFINITY && misfit > UNEXPLAINED * scale => {
                (bare.with_scales(bare.linearisation.updating.scales), f64::INFINITY)
            }
            // Scales are estimated once more where corrections have ended.
            None => bare.likely(most + LIGHT)?,
        };
        if self.near || alone.1 == f64::INFINITY {
            alone = from_other_starts(alone, bare, weighed, most)?;
        }
        if let Some(modes) = damping_of_modes_alone(bare, weighed, most)?.filter(|(_, cost)| *cost < alone.1) {
            (alone, self.near) = (modes, true);
        }
        if overfits(&alone.0, best, self.stated)? {
            (alone.1, self.near) = (f64::INFINITY, false);
        }
        Ok(alone)
    }
}

/// The model with corrections alone, as likely as they make it, and its evidence: they may have ended in another local minimum than
/// those beside the effect. Springs and masses are moved into the parts that they act on as well. None is followed where its evidence
/// would stay above `most`.
fn from_other_starts<'a>(
    alone: (ReferenceModel<'a>, f64),
    bare: &ReferenceModel<'a>,
    weighed: &Weighed<'a>,
    most: f64,
) -> Result<(ReferenceModel<'a>, f64), DiagnosisError> {
    let beside = &weighed.reference.linearisation.updating;
    let mut starts = vec![beside.clone()];
    starts.extend(beside.absorbing(bare.predictor.stated().0, &weighed.fits[0].effects));
    let mut best = alone;
    for start in starts {
        let Some(moved) = if_possible(bare.updated(&start, &[], &Vec::new()))? else { continue };
        let (estimated, cost) = moved.estimated(most.min(best.1))?;
        if cost < best.1 {
            best = (estimated, cost);
        }
    }
    Ok(best)
}

/// The model with corrections alone, the law of the whole structure of `weighed` moved into factors on the damping of modes, and its
/// evidence; none where another effect is among them, or a correction is larger than is likely though those beside the law are not.
/// Beside a law that is stated the two say the same of the modes in the band. It is not followed where its evidence would stay above
/// `most`.
fn damping_of_modes_alone<'a>(
    bare: &ReferenceModel<'a>,
    weighed: &Weighed<'a>,
    most: f64,
) -> Result<Option<(ReferenceModel<'a>, f64)>, DiagnosisError> {
    let (structure, known) = bare.predictor.stated();
    let beside = &weighed.reference.linearisation.updating;
    let Some(start) = beside.absorbing_damping(structure, known, &weighed.fits[0].effects) else { return Ok(None) };
    let Some(moved) = if_possible(bare.updated(&start, &[], &Vec::new()))? else { return Ok(None) };
    let doubtful = !is_likely(&weighed.reference);
    Ok(Some(moved.estimated(most)?).filter(|(estimated, _)| doubtful || is_likely(estimated)))
}

/// Whether the corrections of `likely` alone overfit, and do not compete with the effects of `best`: they predict the tests worse
/// than the model as it was stated, with the relative error `stated`, which the effects at least halve; or they leave most of the response to
/// what is free from run to run, of which the effects leave less than half. They then lower the squared residual only by that freedom,
/// and by scaling stiffness, mass and force together.
fn overfits(likely: &ReferenceModel, best: &FittedModel, stated: f64) -> Result<bool, DiagnosisError> {
    if best.error >= HALVED * stated {
        return Ok(false);
    }
    let error = likely.error_of_structure(&[], &Vec::new())?;
    Ok(error > stated || (best.error < HALVED * error && explains_by_scatter(error, likely.floor())))
}

/// Whether the best of the candidates predicts runs that are left out better than the model with corrections and the effects
/// before it, by more than may be by chance. A channel that is read wrongly, and a spring or mass that corrections
/// can stand for, predict little better: they are told by their evidence alone.
fn predicts_better(
    weighed: &Weighed,
    likely: &ReferenceModel,
    before: Option<&FittedModel>,
) -> Result<bool, DiagnosisError> {
    let best = &weighed.fits[0];
    let channel = best.effects.last().is_some_and(|e| matches!(e.effect.kind(), Kind::Channel(_)));
    let by_modes = weighed.reference.linearisation.updating.is_by_modes();
    if channel || (is_single_change(&best.effects) && !by_modes) {
        return Ok(true);
    }
    let groups = groups(likely.data);
    Ok(exceeds(&weighed.reference.cross_validated(Some(best), &groups)?, &likely.cross_validated(before, &groups)?))
}

/// Whether effects leave more `error` than those `before` them, the first of them than the model as it is `stated`: what only lowers the
/// squared residual because every run has a stiffness of its own is nothing that could be added.
fn raises_error(error: f64, before: Option<f64>, stated: f64) -> bool {
    error > before.map_or(stated, |before| RAISED * before)
}

/// Evidence that the last of the effects of a fit must bring beside the model with corrections and the effects before it.
fn evidence_needed(effects: &[Source], by_modes: bool) -> f64 {
    match effects.len() {
        1 if is_single_change(effects) && by_modes => FURTHER,
        1 if is_single_change(effects) => CHANGED,
        1 => CHOSEN,
        _ => FURTHER,
    }
}

/// Probability that goes with so much evidence, twice the logarithm of the odds.
fn odds(evidence: f64) -> f64 {
    1.0 / (1.0 + (-0.5 * evidence).exp())
}

/// Whether the effects of a fit are one spring or mass, which corrections can stand for.
fn is_single_change(effects: &[Source]) -> bool {
    matches!(effects, [only] if only.effect.is_mass_or_spring())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::diagnosis::residual::prediction::FINAL;
    use crate::diagnosis::selection::stated_chain::{hidden, with_stated};
    use crate::effects::{Effect, Place};

    /// An effect that jumps, and leaves more than the model as it is stated for one run of eight beyond its jump alone, raises no error; where
    /// nothing jumps, all runs count.
    #[test]
    fn a_run_beyond_a_jump_raises_no_error() {
        let raised = |effects: &[Source]| {
            with_stated(effects, |reference| {
                let fit = reference.estimator().fit(effects, 0, &FINAL, &Vec::new()).unwrap();
                let error = reference.error_of_structure(effects, &fit.starts).unwrap();
                let (bare, fits) = (reference.clone(), vec![FittedModel { error, ..fit }]);
                let weighed = Weighed { reference, fits, probabilities: vec![1.0], least: 0.0 };
                CompetingModel::new(&bare, 0.999 * error, None).is_error_raised(&weighed, None).unwrap()
            })
        };
        assert_eq!([raised(&[]), raised(&[hidden()])], [true, false]);
    }

    /// The first effect has to lower the error of the stated model; a further one may scatter by as much as errors of runs do.
    #[test]
    fn a_further_effect_may_raise_the_error_by_its_scatter_and_the_first_may_not() {
        assert!(!raises_error(0.099, None, 0.1) && raises_error(0.101, None, 0.1));
        let further = |error: f64| raises_error(error, Some(0.02), 0.1);
        assert!(!further(0.0215) && further(0.0225) && further(0.09));
    }

    /// As much evidence as the choice costs leaves even odds, six more 20 to 1.
    #[test]
    fn evidence_beyond_what_the_choice_costs_is_told_as_odds() {
        assert!((odds(0.0) - 0.5).abs() < 1e-12 && (odds(2.0 * 19.0_f64.ln()) - 0.95).abs() < 1e-12);
        assert!((odds(f64::INFINITY) - 1.0).abs() < 1e-12);
    }

    /// One spring or mass, which corrections can stand for, is held to less where they are of parts and to more where they are of modes.
    #[test]
    fn the_evidence_that_is_needed_depends_on_what_corrections_can_stand_for() {
        let effect = |effect: Effect| Source::known(effect, Place::Dofs(vec![0]), &[1.0]);
        let (spring, dashpot) = (effect(Effect::Stiffness), effect(Effect::Viscous));
        let needed = |effects: &[&Source], by_modes: bool| {
            evidence_needed(&effects.iter().copied().cloned().collect::<Vec<_>>(), by_modes)
        };
        assert_eq!([needed(&[&spring], false), needed(&[&spring], true)], [CHANGED, FURTHER]);
        assert_eq!([needed(&[&dashpot], false), needed(&[&dashpot], true)], [CHOSEN, CHOSEN]);
        assert_eq!(needed(&[&dashpot, &spring], false), FURTHER);
    }
}
