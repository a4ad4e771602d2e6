//! The search with updating parameters free beside effects: corrections alone, one change in place of many corrections, laws.

use crate::diagnosis::channels::ChannelFault;
use crate::diagnosis::residual::data::{DiagnosisError, if_possible};
use crate::diagnosis::selection::backward_elimination::{pruned, without_addition, without_needless_effects};
use crate::diagnosis::selection::conclusion::{self, Outcome, TOLERATED};
use crate::diagnosis::selection::cross_validation::{exceeds, groups};
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::found::{DOUBTFUL, Found, MOST_EFFECTS, agrees, explains_by_scatter};
use crate::diagnosis::selection::reference_model::{ReferenceModel, scale_of};
use crate::diagnosis::selection::weighing::{Weighed, weighed};
use crate::diagnosis::updating::detuning::is_likely;
use crate::effects::{Kind, Source};

/// The same beside corrections, whose freedom has its cost already: having been chosen among some thousand.
const CHOSEN: f64 = 16.0;
/// The same of one spring or mass in place of many corrections: having been chosen among some sixty places, each the likelier by
/// none of the corrections being larger than models are wrong by.
const CHANGED: f64 = 6.0;
/// What it must promise to be refined.
const PROMISED: f64 = 4.0;
/// The same of a further effect there, real models lack a little everywhere, and of a spring or a mass, which is like a
/// correction itself.
const FURTHER: f64 = 100.0;
/// Squared residual per datum of corrections as they are first found, over that of the best effect, from which on they are no
/// rival.
const RIVALLED: f64 = 4.0;
/// How many times the error of the effects before it, as `compare` shows it, a further effect may leave: errors that the runs have of their
/// own scatter by that.
const RAISED: f64 = 1.1;
/// Share of the error of the stated model that effects may leave where corrections that raise it are no rival of theirs: further
/// than chance or one run on another branch would bring them.
const HALVED: f64 = 0.5;

/// The search with the updating parameters free: at each stage the candidates seen from the model as it was updated last,
/// then the model updated beside the best of them, and the candidates again.
pub(super) fn beside_updating(
    reference: ReferenceModel<'_>,
    before: f64,
) -> Result<Result<Outcome<'_>, ChannelFault>, DiagnosisError> {
    let mut found = Found { updated: true, by_size: Vec::new(), agrees: false, before };
    let stated = reference.estimator().error(&reference.predictions);
    let bare = reference.bare()?;
    // Before candidates are refined, which takes long: what differs from run to run may be more than tests usually differ by.
    let corrected = bare.likely()?;
    let (mut here, first) = match first_candidates((&reference, before), &bare, &corrected.0)? {
        First::Fits(here, fits) => (here, fits),
        First::None(likely) => {
            found.agrees = agrees(&likely, likely.misfit() * likely.count() as f64, 0);
            return Ok(Ok(Outcome { reference: likely, found }));
        }
        First::Unreliable(fault) => return Ok(Err(fault)),
    };
    let mut first = Some(first);
    let ((mut likely, mut least), mut told_alone) = (corrected, false);
    let by_modes = bare.linearisation.updating.is_by_modes();
    while found.by_size.len() < MOST_EFFECTS && (found.by_size.is_empty() || !here.control.is_late()) {
        let from = found.by_size.last().map(|fitted_sets| fitted_sets.fits[0].clone());
        let fits = match (&from, first.take()) {
            (None, Some(fits)) => fits,
            (Some(from), _) => here.refined_beside(from, FURTHER)?,
            (None, None) => Vec::new(),
        };
        if found.by_size.is_empty() {
            let fits: Vec<FittedModel> = fits.iter().map(|(_, fit)| fit.clone()).collect();
            (here.early)(&conclusion::early(&here, &here.ranked(fits)));
        }
        if from.is_some() && here.control.is_late() {
            break;
        }
        if let Some(from) = &from
            && let Some(better) = without_addition(&fits, from, least)?
        {
            found.by_size.pop();
            (likely, least) = better.taken_into(&mut found);
            here = likely.with_scales(likely.linearisation.updating.scales);
            continue;
        }
        let most = from.as_ref().map_or(f64::INFINITY, |from| RAISED * from.error);
        let Some(mut weighed) = weighed(fits, most)? else { break };
        if from.is_none()
            && let Some(two) = here.two_laws_for(&weighed)?
        {
            weighed = two;
        }
        let best = &weighed.fits[0];
        let scale = scale_of(&weighed.fits, weighed.reference.count());
        if from.is_none() {
            ((likely, least), told_alone) = rival((likely, least), &bare, &weighed, stated)?;
        }
        let raises = raises_error(best.error, from.as_ref().map(|from| from.error), stated);
        let known = best.parameters < weighed.reference.count();
        if raises || !known || (least - weighed.least) / scale < evidence_needed(&best.effects, by_modes) {
            break;
        }
        if (told_alone || from.is_some()) && !predicts_better(&weighed, (&likely, from.as_ref()))? {
            break;
        }
        (likely, least) = weighed.taken_into(&mut found);
        here =
            ReferenceModel { predictions: likely.predictions.clone(), noise: likely.noise.clone(), ..likely.shallow() };
        // Corrections beyond what models are wrong by may stand in for one effect more.
        if found.agrees && is_likely(&likely) {
            break;
        }
    }
    if found.by_size.is_empty() {
        found.agrees = agrees(&likely, likely.misfit() * likely.count() as f64, 0);
    }
    pruned(&likely, &mut found)?;
    let likely = without_needless_effects(likely, &mut found)?;
    Ok(Ok(Outcome { reference: likely, found }))
}

/// What a search beside corrections begins with.
enum First<'a> {
    /// The model from which candidates were seen, and these fitted.
    Fits(ReferenceModel<'a>, Vec<(ReferenceModel<'a>, FittedModel)>),
    /// Nothing: corrections alone, as likely as they make the model.
    None(ReferenceModel<'a>),
    /// A channel that is not to be relied on.
    Unreliable(ChannelFault),
}

/// The first candidates beside the corrections of `bare`. Where corrections alone agree with the data and no law would bring its
/// evidence beside them, none is refined but what one change explains instead of them.
fn first_candidates<'a>(
    (reference, before): (&ReferenceModel<'a>, f64),
    bare: &ReferenceModel<'a>,
    likely: &ReferenceModel<'a>,
) -> Result<First<'a>, DiagnosisError> {
    let changes = if bare.misfit() < TOLERATED { bare.single_changes(PROMISED)? } else { Vec::new() };
    let mut promises = bare.misfit() >= DOUBTFUL || bare.promises(CHOSEN)? || likely.is_scatter()?;
    if !promises && changes.is_empty() {
        if !likely.promises(CHOSEN)? {
            return Ok(First::None(likely.with_scales(likely.linearisation.updating.scales)));
        }
        promises = true;
    }
    let (mut here, mut fits) = (bare.with_scales(bare.linearisation.updating.scales), Vec::new());
    if promises {
        let (localised, unfitted) = match reference.localised()? {
            Ok(localised) => localised,
            Err(fault) => return Ok(First::Unreliable(fault)),
        };
        fits = localised.refined(unfitted)?;
        fits.extend(reference.refined_whole(before)?);
        here = localised;
    }
    let refine = |k: usize| bare.refined_change(&changes[k]);
    fits.extend(bare.control.map(changes.len(), refine).into_iter().collect::<Result<Vec<_>, _>>()?);
    Ok(First::Fits(here, fits))
}

/// The model with corrections alone that the effects of `weighed` are to be better than, its evidence, and whether it is near
/// enough for both to be judged by what they predict.
fn rival<'a>(
    (mut likely, mut least): (ReferenceModel<'a>, f64),
    bare: &ReferenceModel<'a>,
    weighed: &Weighed<'a>,
    stated: f64,
) -> Result<((ReferenceModel<'a>, f64), bool), DiagnosisError> {
    let best = &weighed.fits[0];
    let scale = scale_of(&weighed.fits, weighed.reference.count());
    let doubtful = best.effects.iter().any(|e| e.effect.is_mass_or_spring()) || scale > DOUBTFUL;
    let mut near = bare.misfit() < RIVALLED * scale || doubtful;
    if near {
        (likely, least) = corrections_alone((likely, least), bare, weighed)?;
    }
    if let Some(modes) = damping_of_modes_alone(bare, weighed)?.filter(|(_, cost)| *cost < least) {
        ((likely, least), near) = (modes, true);
    }
    if overfits(&likely, best, stated)? {
        return Ok(((likely, f64::INFINITY), false));
    }
    Ok(((likely, least), near))
}

/// The model with corrections alone, as likely as they make it, and its evidence: they may have ended in another local minimum than
/// those beside the effect. Springs and masses are moved into the parts that they act on as well.
fn corrections_alone<'a>(
    (likely, least): (ReferenceModel<'a>, f64),
    bare: &ReferenceModel<'a>,
    weighed: &Weighed<'a>,
) -> Result<(ReferenceModel<'a>, f64), DiagnosisError> {
    let beside = &weighed.reference.linearisation.updating;
    let mut starts = vec![beside.clone()];
    starts.extend(beside.absorbing(bare.predictor.stated().0, &weighed.fits[0].effects));
    let mut best = (likely, least);
    for start in starts {
        let Some(moved) = if_possible(bare.updated(&start, &[], &Vec::new()))? else { continue };
        let (estimated, cost) = moved.estimated()?;
        if cost < best.1 {
            best = (estimated, cost);
        }
    }
    Ok(best)
}

/// The model with corrections alone, the law of the whole structure of `weighed` moved into factors on the damping of modes, and its
/// evidence; none where another effect is among them, or a correction is larger than is likely. Beside a law that is stated the two say
/// the same of the modes in the band.
fn damping_of_modes_alone<'a>(
    bare: &ReferenceModel<'a>,
    weighed: &Weighed<'a>,
) -> Result<Option<(ReferenceModel<'a>, f64)>, DiagnosisError> {
    let (structure, known) = bare.predictor.stated();
    let beside = &weighed.reference.linearisation.updating;
    let Some(start) = beside.absorbing_damping(structure, known, &weighed.fits[0].effects) else { return Ok(None) };
    let Some(moved) = if_possible(bare.updated(&start, &[], &Vec::new()))? else { return Ok(None) };
    Ok(Some(moved.estimated()?).filter(|(estimated, _)| is_likely(estimated)))
}

/// Whether the corrections of `likely` alone overfit, and are no rival of the effects of `best`: they predict the tests worse than the
/// model as it was stated, with the relative error `stated`, which the effects at least halve; or they leave most of the response to
/// what is free from run to run, of which the effects leave less than half. They then lower the squared residual only by that freedom,
/// and by scaling stiffness, mass and force together.
fn overfits(likely: &ReferenceModel, best: &FittedModel, stated: f64) -> Result<bool, DiagnosisError> {
    if best.error >= HALVED * stated {
        return Ok(false);
    }
    let error = likely.error_of_structure(&[], &Vec::new())?;
    Ok(error > stated || (best.error < HALVED * error && explains_by_scatter(error, likely.floor())))
}

impl ReferenceModel<'_> {
    /// Whether this model, corrected and without any effect, explains the runs by what is free from run to run alone.
    fn is_scatter(&self) -> Result<bool, DiagnosisError> {
        Ok(explains_by_scatter(self.error_of_structure(&[], &Vec::new())?, self.floor()))
    }

    fn floor(&self) -> f64 {
        self.noise_floor(&[], &self.predictions)
    }
}

/// Whether the best of the candidates predicts runs that are left out better than the model with corrections and the effects
/// before it, by more than may be by chance. A channel that is read wrongly, and a spring or
/// mass that corrections can stand for, predict little better: they are told by their evidence alone.
fn predicts_better(
    weighed: &Weighed,
    (likely, before): (&ReferenceModel, Option<&FittedModel>),
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

/// Evidence that the last of the effects of a fit must bring beside `likely`, the model with corrections and the effects before it.
fn evidence_needed(effects: &[Source], by_modes: bool) -> f64 {
    match effects.len() {
        1 if is_single_change(effects) && by_modes => FURTHER,
        1 if is_single_change(effects) => CHANGED,
        1 => CHOSEN,
        _ => FURTHER,
    }
}

/// Whether the effects of a fit are one spring or mass, which corrections can stand for.
fn is_single_change(effects: &[Source]) -> bool {
    matches!(effects, [only] if only.effect.is_mass_or_spring())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::three_masses;
    use crate::common::runs::{channel, run};
    use crate::control::Control;
    use crate::diagnosis::residual::prediction::FINAL as EXACT;
    use crate::diagnosis::result::Verdict;
    use crate::diagnosis::{Problem, diagnose};
    use crate::effects::{Effect, Place};
    use crate::measurement::{Quantity, Run};
    use crate::response::harmonic_balance::{Excitation, ForwardModel};
    use crate::structure::Part;
    use faer::c64;

    /// Modes that are damped a little unlike the stated law, on a model that is 5 % too soft, lack no other law of the whole structure.
    #[test]
    fn modes_that_are_damped_unlike_the_stated_law_are_a_correction() {
        let stated = three_masses([1.0; 3]);
        let parts = [(Part::Stiffness, 1.05), (Part::ModeDamping(1), 1.4), (Part::ModeDamping(2), 0.8)];
        let truth = stated.with_factors(&parts);
        let sources = [Source::known(Effect::LossFactor, Place::Whole(None), &[0.01])];
        let model = ForwardModel::new(&truth, &sources).unwrap();
        let measured = |omega: f64| -> Run {
            let (zero, control) = (c64::new(0.0, 0.0), Control::unattended());
            let excitation = Excitation::sine(omega, 2, c64::new(1.0, 0.0));
            let response = model.at(omega).respond(&sources, &excitation, &EXACT, None, &control).unwrap();
            let motion = |dof: usize| {
                let x = response.amplitude(dof, 1);
                channel(Quantity::Displacement, dof, vec![x, zero, zero], 1e-3 * x.norm())
            };
            let force = channel(Quantity::Force, 2, vec![c64::new(1.0, 0.0), zero, zero], 1e-3);
            run(format!("{omega}"), omega, std::iter::once(force).chain((0..3).map(motion)).collect())
        };
        let omegas = truth.modes().unwrap().omega.clone();
        let runs: Vec<Run> =
            omegas.iter().flat_map(|w| [0.985, 0.995, 1.0, 1.005, 1.02].map(|r| measured(r * w))).collect();
        let problem = Problem { structure: &stated, sources: &sources, runs: &runs };
        let found = diagnose(&problem, &Control::unattended()).unwrap();
        assert_eq!(found.verdict, Verdict::Detuned, "{:?}", found.suggestions);
    }

    /// The first effect has to lower the error of the stated model; a further one may scatter by as much as errors of runs do.
    #[test]
    fn a_further_effect_may_raise_the_error_by_its_scatter_and_the_first_may_not() {
        assert!(!raises_error(0.099, None, 0.1) && raises_error(0.101, None, 0.1));
        let further = |error: f64| raises_error(error, Some(0.02), 0.1);
        assert!(!further(0.0215) && further(0.0225) && further(0.09));
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
