//! The search with updating parameters free beside effects: corrections alone, one change in place of many corrections, laws.

use crate::diagnosis::channels::ChannelFault;
use crate::diagnosis::residual::data::{DiagnosisError, if_possible};
use crate::diagnosis::residual::prediction::{FINAL, SEARCH};
use crate::diagnosis::selection::conclusion::{self, Outcome, TOLERATED};
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::found::{
    DOUBTFUL, EVIDENCE, FittedSets, Found, MOST_EFFECTS, agrees, distinct, nearly,
};
use crate::diagnosis::selection::left_out::{exceeds, groups};
use crate::diagnosis::selection::reference_model::{ReferenceModel, scale_of};
use crate::diagnosis::selection::updated::REFITTED;
use crate::diagnosis::selection::weighing::{Weighed, cost, is_open, weighed};
use crate::diagnosis::updating::detuning::is_likely;
use crate::effects::{Kind, Source};

/// The same beside corrections, whose freedom has its cost already: having been chosen among some thousand.
const CHOSEN: f64 = 16.0;
/// The same of one spring or mass in place of many corrections: having been chosen among some sixty places, each the likelier by
/// none of the corrections being larger than models are wrong by.
const CHANGED: f64 = 6.0;
/// What it must promise to be followed.
const PROMISED: f64 = 4.0;
/// The same of a further effect there, real models lack a little everywhere, and of a spring or a mass, which is like a
/// correction itself.
const FURTHER: f64 = 100.0;
/// Squared residual per datum of corrections as they are first found, over that of the best effect, from which on they are no
/// rival.
const RIVALLED: f64 = 4.0;
/// Times that a model is settled beside the effects that are left when another is taken away.
const UPDATES: usize = 6;
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
    // Before candidates are followed, which takes long: what differs from run to run may be more than tests usually differ by.
    let corrected = bare.likely()?;
    let (mut here, first) = match first_fits((&reference, before), &bare, &corrected.0)? {
        First::Fits(here, fits) => (here, fits),
        First::None(likely) => {
            found.agrees = agrees(&likely, likely.misfit() * likely.count() as f64, 0);
            return Ok(Ok(Outcome { reference: likely, found }));
        }
        First::Unreliable(fault) => return Ok(Err(fault)),
    };
    let mut first = Some(first);
    let (mut likely, mut least) = corrected;
    let mut told_alone = false;
    let by_modes = bare.linearisation.updating.is_by_modes();
    while found.by_size.len() < MOST_EFFECTS && (found.by_size.is_empty() || !here.control.is_late()) {
        let from = found.by_size.last().map(|fitted_sets| fitted_sets.fits[0].clone());
        let fits = match (&from, first.take()) {
            (None, Some(fits)) => fits,
            (Some(from), _) => here.followed_beside(from, FURTHER)?,
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
            && let Some(better) = in_another_valley(&fits, from, least)?
        {
            found.by_size.pop();
            (likely, least) = taken(&mut found, better);
            here = likely.with_scales(likely.linearisation.updating.scales);
            continue;
        }
        let Some(mut weighed) = weighed(fits)? else { break };
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
        // What only lowers the error because every run has a stiffness of its own is nothing that could be added.
        let raises = best.error > from.as_ref().map_or(stated, |from| RAISED * from.error);
        let known = best.parameters < weighed.reference.count();
        if raises || !known || (least - weighed.least) / scale < evidence_needed(best, by_modes) {
            break;
        }
        if (told_alone || from.is_some()) && !predicts_better(&weighed, (&likely, from.as_ref()))? {
            break;
        }
        (likely, least) = taken(&mut found, weighed);
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
    let likely = without_open(likely, &mut found)?;
    Ok(Ok(Outcome { reference: likely, found }))
}

/// Makes a weighed set what was found last; its model and its evidence.
fn taken<'a>(found: &mut Found, weighed: Weighed<'a>) -> (ReferenceModel<'a>, f64) {
    let Weighed { reference, fits, probabilities, least } = weighed;
    found.agrees = agrees(&reference, fits[0].chi_square, fits[0].parameters);
    let scale = scale_of(&fits, reference.count());
    found.by_size.push(FittedSets { scale, noise: reference.noise.clone(), fits, probabilities });
    (reference, least)
}

/// The effects of `from`, whose evidence is `least`, in the model of the best of the candidates for one effect more, where they have
/// their evidence there without it: what it brought was another valley of the same effects, such as other branches of a resonance.
fn in_another_valley<'a>(
    candidates: &[(ReferenceModel<'a>, FittedModel)],
    from: &FittedModel,
    least: f64,
) -> Result<Option<Weighed<'a>>, DiagnosisError> {
    let evidence = |(reference, fit): &(ReferenceModel, FittedModel)| cost(reference, Some(fit));
    let best = candidates.iter().min_by(|a, b| evidence(a).total_cmp(&evidence(b)));
    let Some((reference, fit)) = best else { return Ok(None) };
    let is_known = |effect: &&Source| from.effects.iter().any(|known| known.is_same(effect));
    let same: Vec<Source> = fit.effects.iter().filter(is_known).cloned().collect();
    let own = reference.with_scales(reference.linearisation.updating.scales);
    let begun = own.estimator().fit(&same, REFITTED, &SEARCH, &fit.starts)?;
    if same.len() < from.effects.len() || cost(&own, Some(&begun)) > least - EVIDENCE {
        return Ok(None);
    }
    let better = weighed(vec![own.settled(begun, &SEARCH, UPDATES)?])?;
    Ok(better.filter(|better| better.fits[0].effects.len() == same.len() && better.least < least - EVIDENCE))
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
/// evidence beside them, none is followed but what one change explains instead of them.
fn first_fits<'a>(
    (reference, before): (&ReferenceModel<'a>, f64),
    bare: &ReferenceModel<'a>,
    likely: &ReferenceModel<'a>,
) -> Result<First<'a>, DiagnosisError> {
    let changes = if bare.misfit() < TOLERATED { bare.single_changes(PROMISED)? } else { Vec::new() };
    let mut promises = bare.misfit() >= DOUBTFUL || bare.promises(CHOSEN)?;
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
        fits = localised.followed(unfitted)?;
        fits.extend(reference.followed_whole(before)?);
        here = localised;
    }
    let follow = |k: usize| bare.followed_change(&changes[k]);
    fits.extend(bare.control.map(changes.len(), follow).into_iter().collect::<Result<Vec<_>, _>>()?);
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
    let near = bare.misfit() < RIVALLED * scale || doubtful;
    if near {
        (likely, least) = alone((likely, least), bare, weighed)?;
    }
    if is_hollow(&likely, best, stated)? {
        return Ok(((likely, f64::INFINITY), false));
    }
    Ok(((likely, least), near))
}

/// The model with corrections alone, as likely as they make it, and its evidence: they may have ended in another valley than
/// those beside the effect. Springs and masses are moved into the parts that they act on as well.
fn alone<'a>(
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

/// Whether the corrections of `likely` alone are no rival of the effects of `best`: they predict the tests worse than the model as it
/// was stated, with the relative error `stated`, which the effects at least halve. They then lower the squared residual only by
/// what is free from run to run, and by scaling stiffness, mass and force together.
fn is_hollow(likely: &ReferenceModel, best: &FittedModel, stated: f64) -> Result<bool, DiagnosisError> {
    Ok(best.error < HALVED * stated && likely.error_of_structure(&[], &Vec::new())? > stated)
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
    if channel || (is_single_change(best) && !by_modes) {
        return Ok(true);
    }
    let groups = groups(likely.data);
    Ok(exceeds(&weighed.reference.left_out(Some(best), &groups)?, &likely.left_out(before, &groups)?))
}

/// Evidence that the last effect of a fit must bring beside `likely`, the model with corrections and the effects before it.
fn evidence_needed(fit: &FittedModel, by_modes: bool) -> f64 {
    match fit.effects.len() {
        1 if is_single_change(fit) && by_modes => FURTHER,
        1 if is_single_change(fit) => CHANGED,
        1 => CHOSEN,
        _ => FURTHER,
    }
}

/// Whether a fit is one spring or mass, which corrections can stand for.
fn is_single_change(fit: &FittedModel) -> bool {
    matches!(fit.effects.as_slice(), [only] if only.effect.is_mass_or_spring())
}

/// Drops effects that the last set of a search no longer needs, now that the others are there.
fn pruned(reference: &ReferenceModel, found: &mut Found) -> Result<(), DiagnosisError> {
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

/// The model without the effects of the last set of a search that have a parameter which the data do not know, and without which what
/// corrections do instead has no less evidence: the model is settled beside the others, for corrections beside the whole set are not
/// those beside fewer.
fn without_open<'a>(reference: ReferenceModel<'a>, found: &mut Found) -> Result<ReferenceModel<'a>, DiagnosisError> {
    let mut reference = reference;
    while let Some(best) = found.by_size.last().map(|sets| sets.fits[0].clone()).filter(|fit| fit.effects.len() > 1) {
        let open = |k: &usize| is_open(&best.deviations[*k], &best.effects[*k]);
        let Some(k) = (0..best.effects.len()).find(open).filter(|_| !reference.control.is_late()) else { break };
        let mut fewer = best.effects.clone();
        fewer.remove(k);
        let own = reference.with_scales(reference.linearisation.updating.scales);
        let begun = own.estimator().fit(&fewer, REFITTED, &SEARCH, &best.starts)?;
        let Some(weighed) = weighed(vec![own.settled(begun, &SEARCH, UPDATES)?])? else { break };
        if weighed.least > cost(&reference, Some(&best)) + EVIDENCE || weighed.fits[0].effects.len() != fewer.len() {
            break;
        }
        found.by_size.pop();
        found.by_size.retain(|sets| sets.fits[0].effects.len() < fewer.len());
        (reference, _) = taken(found, weighed);
    }
    Ok(reference)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::{source, three_masses};
    use crate::common::runs::{channel, run};
    use crate::control::Control;
    use crate::diagnosis::Problem;
    use crate::diagnosis::residual::data::Data;
    use crate::diagnosis::residual::prediction::Predictor;
    use crate::diagnosis::result::Suggestion;
    use crate::diagnosis::updating::parameters::Updating;
    use crate::effects::{Effect, Source};
    use crate::measurement::{Quantity, Run};
    use crate::response::harmonic_balance::{Excitation, ForwardModel};
    use faer::c64;
    use std::sync::Arc;

    fn known() -> Source {
        source(Effect::Viscous, &[0], &[0.8])
    }

    fn hidden() -> Source {
        source(Effect::CubicStiffness, &[2], &[4e6])
    }

    /// Runs at two levels about the first mode of a chain whose ground spring is 2 % stiffer than stated and which hides a cubic spring.
    fn runs() -> Vec<Run> {
        let (structure, deviation) = (three_masses([1.02, 1.0, 1.0]), 1e-7);
        let model = ForwardModel::new(&structure, &[known()]).unwrap();
        let measured_run = |(omega, force): (f64, f64)| {
            let amplitude = c64::new(force, 0.0);
            let excitation = Excitation::sine(omega, 2, amplitude);
            let (sources, control) = ([known(), hidden()], Control::unattended());
            let response = model.at(omega).respond(&sources, &excitation, &FINAL, None, &control).unwrap();
            let motion = |dof: usize| (1..=3).map(|h| response.amplitude(dof, h)).collect();
            let zero = c64::new(0.0, 0.0);
            let mut channels = vec![channel(Quantity::Force, 2, vec![amplitude, zero, zero], deviation)];
            channels.extend((0..3).map(|dof| channel(Quantity::Displacement, dof, motion(dof), deviation)));
            run(format!("{omega} rad/s, {force} N"), omega, channels)
        };
        [46.0, 48.0, 50.0, 52.0].into_iter().flat_map(|omega| [(omega, 1.0), (omega, 2.0)]).map(measured_run).collect()
    }

    /// The effects that are left of a set of which the data know the parameters of those in `open` not, and the factor on the ground
    /// spring of the model beside them.
    fn left_of(effects: &[Source], open: &[usize]) -> (Vec<Source>, f64) {
        let (stated, sources, runs) = (three_masses([1.0; 3]), vec![known()], runs());
        let data = Data::new(&Problem { structure: &stated, sources: &sources, runs: &runs }).unwrap();
        let predictor = Arc::new(Predictor::new(&stated, sources.clone(), &data).unwrap());
        let (control, early) = (Control::unattended(), |_: &[Suggestion]| {});
        let model = ReferenceModel::new(predictor, &data, &control, &early).unwrap();
        let updating = Updating::all(&stated, &sources, &data);
        let reference = model.updated(&updating, effects, &Vec::new()).unwrap();
        let mut fit = reference.estimator().fit(effects, REFITTED, &SEARCH, &Vec::new()).unwrap();
        open.iter().for_each(|&k| fit.deviations[k].fill(f64::NAN));
        let noise = reference.noise.clone();
        let sets = FittedSets { fits: vec![fit], scale: 1.0, noise, probabilities: vec![1.0] };
        let mut found = Found { updated: true, by_size: vec![sets], agrees: false, before: f64::INFINITY };
        let settled = without_open(reference, &mut found).unwrap();
        let ground = settled.linearisation.updating.structure(&stated).matrices().unwrap().stiffness[(0, 0)] - 1e4;
        (found.by_size.pop().unwrap().fits.remove(0).effects, ground / 2e4)
    }

    /// The model is settled beside what is left: its spring has moved to where the records have it.
    #[test]
    fn an_effect_that_the_data_do_not_know_goes_from_a_set_and_the_model_settles() {
        let idle = source(Effect::Coulomb, &[1], &[1e-6]);
        let (left, ground) = left_of(&[hidden(), idle], &[1]);
        assert!(matches!(left.as_slice(), [only] if only.is_same(&hidden())), "{left:?}");
        assert!((left[0].parameters[0] / 4e6 - 1.0).abs() < 0.02, "{left:?}");
        assert!((ground - 1.02).abs() < 2e-3, "{ground}");
    }

    #[test]
    fn an_effect_that_corrections_cannot_stand_for_stays() {
        let dashpot = source(Effect::Viscous, &[1], &[1e-3]);
        assert_eq!(left_of(&[hidden(), dashpot], &[0]).0.len(), 2);
    }
}
