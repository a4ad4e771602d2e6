//! The search with corrections of the model free beside the effects.

use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::residual::prediction::{FINAL, SEARCH};
use crate::diagnosis::selection::fits::STEPS;
use crate::diagnosis::selection::fitted_model::Refit;
use crate::diagnosis::selection::search::{Base, scale_of};
use crate::diagnosis::selection::stepwise::{
    Found, MOST_EFFECTS, Rung, add_rung, agrees, climb, distinct, fits_well, level, nearly,
};
use crate::diagnosis::updating::parameters::{Knob, Tuning};
use crate::effects::{Effect, Place, Source};

/// Prior deviations up to which a correction is believed without looking for an effect.
const LIKELY: f64 = 3.0;

/// The model with its corrections fitted and without effects; with `each` also those of single modes or springs.
pub(crate) fn corrected(base: &Base, each: bool) -> Result<Refit, DiagnosisError> {
    base.bare(&base.predictor.free_tuning(each), &FINAL)
}

/// The search with the corrections of the model free, from `bare` on, which has them alone; `before` are sets of one effect
/// found with fewer of them, `first` is the squared residual of the model as it is.
pub(crate) fn with_corrections(
    base: &Base,
    before: Option<&Rung>,
    bare: Refit,
    first: f64,
) -> Result<Found, DiagnosisError> {
    let free = bare.tuning.with(&vec![0.0; bare.tuning.values.len()]);
    let bench = base.bench();
    let mut found = Found {
        agrees: agrees(base, bare.chi_square, bare.tuning.knobs.len()) && likely(&bare),
        bare: Some(bare.clone()),
        rungs: Vec::new(),
        before: first,
    };
    if found.agrees {
        return Ok(found);
    }
    // Effects that explain much without corrections, with them; then places again, seen from the corrected model.
    let mut refits = Vec::new();
    for refit in before.iter().flat_map(|rung| &rung.refits).take(4) {
        refits.push(bench.refit(&refit.effects, &free, STEPS, &SEARCH, &refit.starts)?);
    }
    refits.extend(faults_of_forces(base, &bare, &free)?);
    refits.extend(beside_known(base, &bare, &free)?);
    refits = distinct(base.ranked(refits));
    let done = refits.first().is_some_and(|best| fits_well(base, &found, best));
    let mut from = bare.clone();
    for _ in 0..if done { 0 } else { 2 } {
        refits.extend(corrected_singles(base, &from)?);
        refits = distinct(base.ranked(refits));
        let Some(best) = refits.first() else { break };
        let moved = best.tuning.values.iter().zip(&from.tuning.values).any(|(a, b)| (a - b).abs() > 2e-4);
        if agrees(base, best.chi_square, best.parameters) || nearly(base, best, first) || !moved {
            break;
        }
        from = Refit { effects: Vec::new(), ..best.clone() };
    }
    add_rung(base, &mut found, refits, level(&bare))?;
    if let (false, Some(rung)) = (found.agrees, found.rungs.last()) {
        let last = level(&rung.refits[0]);
        climb(base, &mut found, last, MOST_EFFECTS - 1)?;
    }
    if found.rungs.is_empty() {
        found.agrees = agrees(base, bare.chi_square, bare.tuning.knobs.len()) && plausible(&bare);
    }
    Ok(found)
}

/// The effects found, with the corrections of the model free beside them.
pub(crate) fn same_with_corrections(base: &Base, exact: &Found) -> Result<Found, DiagnosisError> {
    let free = base.predictor.free_tuning(false);
    let mut found = Found { bare: None, rungs: Vec::new(), agrees: false, before: exact.before };
    let Some(last) = exact.rungs.last() else { return Ok(found) };
    let best = last.refits.iter().take(2);
    let fit = |refit: &Refit| base.bench().refit(&refit.effects, &free, STEPS, &SEARCH, &refit.starts);
    let refits = best.map(fit).collect::<Result<Vec<_>, _>>()?;
    let (refits, noise) = base.polished(base.ranked(refits))?;
    let Some(best) = refits.first() else { return Ok(found) };
    let all = best.parameters + best.tuning.knobs.len();
    found.agrees = agrees(base, best.chi_square, all) || nearly(base, best, exact.before);
    found.rungs.push(Rung { scale: scale_of(&refits, base.count()), refits, noise });
    Ok(found)
}

/// Whether no correction is farther from nothing than models are wrong: else an effect may pass for a correction.
pub(crate) fn likely(bare: &Refit) -> bool {
    let priors = bare.tuning.knobs.iter().map(Knob::deviation);
    bare.tuning.values.iter().zip(priors).all(|(v, s)| v.abs() <= LIKELY * s)
}

/// Whether corrections that agree with the data may be believed where no effect does better.
fn plausible(bare: &Refit) -> bool {
    let priors = bare.tuning.knobs.iter().map(Knob::deviation);
    bare.tuning.values.iter().zip(priors).all(|(v, s)| v.abs() <= 2.0 * LIKELY * s)
}

/// Errors of the force channels beside the corrections, where these go further than models are wrong by: a force read too
/// large looks like a structure of less stiffness, mass and damping.
fn faults_of_forces(base: &Base, bare: &Refit, free: &Tuning) -> Result<Vec<Refit>, DiagnosisError> {
    if likely(bare) {
        return Ok(Vec::new());
    }
    let [_, forces] = base.data.channel_names();
    let fault = |name: &String| Source::known(Effect::Gain, Place::Channel(name.clone()), &[1.02]);
    let fit = |name: &String| base.bench().refit(&[fault(name)], free, STEPS, &SEARCH, &[]);
    forces.iter().filter(|name| base.data.allows(&fault(name))).map(fit).collect()
}

/// Effects seen from a model whose known sources are as stated, where their corrections go further than known sizes are
/// wrong by: what is missing may act where something known does, which would grow in its stead.
fn beside_known(base: &Base, bare: &Refit, free: &Tuning) -> Result<Vec<Refit>, DiagnosisError> {
    let known = |knob: &Knob| matches!(knob, Knob::Known(_));
    let grown = |(knob, v): (&Knob, &f64)| known(knob) && v.abs() > LIKELY * knob.deviation();
    if !bare.tuning.knobs.iter().zip(&bare.tuning.values).any(grown) {
        return Ok(Vec::new());
    }
    let as_stated = free.only(|knob| !known(knob));
    let from = base.bench().refit(&[], &as_stated, STEPS, &SEARCH, &[])?;
    let seen = corrected_singles(base, &from)?;
    let freed =
        |refit: &Refit| base.bench().refit(&refit.effects, &refit.tuning.within(free), STEPS, &SEARCH, &refit.starts);
    seen.iter().take(4).map(freed).collect()
}

/// Single effects at the places that the model with the corrections of `from` shows.
fn corrected_singles(base: &Base, from: &Refit) -> Result<Vec<Refit>, DiagnosisError> {
    let predictor = base.predictor.tuned(&from.tuning)?;
    let mut tuned = Base::new(&predictor, base.data, from.tuning.clone(), base.control)?;
    tuned.noise.clone_from(&base.noise);
    tuned.singles(None)
}
