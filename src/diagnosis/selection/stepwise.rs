//! Stepwise selection of effects, from the model as it is to one that agrees with the data: one at a time or by pairs,
//! and, where effects alone do not get there, with updating parameters, run nuisance and their scales free beside them.

use crate::diagnosis::candidates::special_cases::is_limit;
use crate::diagnosis::channels::ChannelFault;
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::residual::prediction::FINAL;
use crate::diagnosis::selection::conclusion::{self, Outcome};
use crate::diagnosis::selection::fits::STEPS;
use crate::diagnosis::selection::fitted_model::Refit;
use crate::diagnosis::selection::left_out::{exceeds, groups};
use crate::diagnosis::selection::search::{Base, scale_of};
use crate::diagnosis::selection::weighing::{Weighed, weighed};
use crate::diagnosis::updating::detuning::is_likely;
use crate::diagnosis::updating::noise_model::NoiseModel;
use crate::effects::{Effect, Source, effect::Kind};
use std::sync::Arc;

/// Most effects that are added.
pub(crate) const MOST_EFFECTS: usize = 3;
/// Evidence (difference of the information criterion) that an effect must bring: its own, and that of having been
/// chosen among thousands.
const EVIDENCE: f64 = 25.0;
/// The same beside corrections, whose freedom has its cost already: having been chosen among some thousand.
const CHOSEN: f64 = 16.0;
/// The same of a further effect there, real models lack a little everywhere, and of a spring or a mass, which is like a
/// correction itself.
const FURTHER: f64 = 100.0;
/// Deviations of the sum of squares within which a model agrees with the data.
const AGREES: f64 = 4.0;
/// Deviations within which it agrees so well that no further effect is looked for.
const SETTLED: f64 = 1.5;
/// Squared residual per datum beyond which it is not noise that hides an effect, but what no model matches.
const DOUBTFUL: f64 = 1.5;
/// Squared residual per datum of corrections as they are first found, over that of the best effect, from which on they are no
/// rival.
const RIVALLED: f64 = 4.0;
/// Evidence that an effect must bring where the model agrees without it.
const CONFIRMED: f64 = 50.0;
/// Share of the squared residual of the model as it is, and error of the response, that nobody's records and integrators
/// are better than: what is left below both is no further effect.
const LAST: f64 = 4e-4;
const LAST_ERROR: f64 = 2e-3;
/// The same for a law that another contains.
const PLAIN: f64 = 1e-4;
const PLAIN_ERROR: f64 = 1e-3;
/// How many times the squared residual of noise free forces may leave where the laws behind them may still explain it.
const REACH: f64 = 4.0;
/// Scaled squared residual within which places are worth trying with a law that was found elsewhere.
const ELSEWHERE: f64 = 40.0;
/// Sets of effects of one size, fitted, best first.
pub(crate) struct Rung {
    pub refits: Vec<Refit>,
    /// Squared residual per datum of the best, at least 1.
    pub scale: f64,
    /// Noise with the truncation of the best.
    pub noise: Arc<NoiseModel>,
    /// Probability of each.
    pub probabilities: Vec<f64>,
}

/// Where a search ended.
pub(crate) struct Found {
    /// Whether updating parameters were freed.
    pub updated: bool,
    pub rungs: Vec<Rung>,
    /// Whether the last rung agrees with the data.
    pub agrees: bool,
    /// Squared residual of the model as it is.
    pub before: f64,
}

/// Whether a squared residual with `parameters` fitted is that of noise.
pub(crate) fn agrees(base: &Base, chi_square: f64, parameters: usize) -> bool {
    let n = base.count().saturating_sub(parameters) as f64;
    chi_square <= n + AGREES * (2.0 * n).sqrt()
}

/// Whether what a fit leaves is no more than what records and integrators are wrong by, where the model as it is has the
/// squared residual `before`.
pub(crate) fn nearly(base: &Base, refit: &Refit, before: f64) -> bool {
    small(base, refit, before, [LAST, LAST_ERROR])
}

/// Whether what a fit leaves beyond the noise is below a `share` of the squared residual `before`, and below an `error` of
/// the response.
fn small(base: &Base, refit: &Refit, before: f64, [share, error]: [f64; 2]) -> bool {
    let n = base.count() as f64;
    let excess = (refit.chi_square - n).max(0.0);
    let beyond_noise = refit.error * (excess / refit.chi_square.max(f64::MIN_POSITIVE)).sqrt();
    excess < share * (before - n) && beyond_noise < error
}

/// One effect more where a set agrees with the data, if it has overwhelming evidence: the sum of squares alone may hide
/// an effect that others stand in for.
fn confirm(base: &Base, found: &mut Found) -> Result<(), DiagnosisError> {
    let Some(last) = found.rungs.last().filter(|_| found.rungs.len() < MOST_EFFECTS) else { return Ok(()) };
    let best = &last.refits[0];
    let (n, parameters) = (base.count() as f64, best.parameters);
    let settled = |refit: &Refit| refit.chi_square <= n - parameters as f64 + SETTLED * (2.0 * n).sqrt();
    if settled(best) || best.chi_square > DOUBTFUL * n {
        return Ok(());
    }
    let quiet = Base { noise: last.noise.clone(), predictions: base.predictions.clone(), ..base.shallow() };
    let (refits, noise) = quiet.polished(quiet.singles(Some(best))?)?;
    let Some(more) = refits.first() else { return Ok(()) };
    if base.evidence(more, 1.0) + CONFIRMED < base.evidence(best, 1.0) && settled(more) {
        let scale = scale_of(&refits, base.count());
        found.rungs.push(Rung { probabilities: base.probabilities(&refits), refits, scale, noise });
    }
    Ok(())
}

/// The search: with the model as it is, so far as free forces at one place or two could explain the data at all, then
/// with its updating parameters free.
pub(crate) fn explain(base: Base<'_>, before: f64) -> Result<Result<Outcome<'_>, ChannelFault>, DiagnosisError> {
    if base.data.doubted {
        return beside_updating(base, before);
    }
    let none = || Found { updated: false, rungs: Vec::new(), agrees: false, before };
    let mut exact = none();
    let reach = base.reach()?;
    let n = base.count() as f64;
    let noise = REACH * (n + AGREES * (2.0 * n).sqrt());
    let within = |least: f64| least <= noise || least - n < LAST * (before - n);
    if within(reach.single) {
        climb(&base, &mut exact, (before, 0), 1)?;
    } else {
        add_rung(&base, &mut exact, base.ranked(base.whole(None, STEPS)?), (before, 0))?;
        exact = if exact.agrees { exact } else { none() };
    }
    if exact.agrees {
        confirm(&base, &mut exact)?;
        return Ok(Ok(Outcome { base, found: exact }));
    }
    // Free forces at two places explain whatever two sensors see.
    let telling = base.data.runs.iter().all(|run| run.alive.len() > 2);
    if telling && !within(reach.single) && reach.pair <= noise && two_at_once(&base, &mut exact)? {
        confirm(&base, &mut exact)?;
        return Ok(Ok(Outcome { base, found: exact }));
    }
    // Where time is up, what was found on the model as it is is the best so far.
    if !exact.rungs.is_empty() && base.control.is_late() {
        return Ok(Ok(Outcome { base, found: exact }));
    }
    beside_updating(base, before)
}

/// The search with the updating parameters free: at each stage the candidates seen from the model as it was updated last,
/// then the model updated beside the best of them, and the candidates again.
fn beside_updating(base: Base<'_>, before: f64) -> Result<Result<Outcome<'_>, ChannelFault>, DiagnosisError> {
    let mut found = Found { updated: true, rungs: Vec::new(), agrees: false, before };
    let stated = base.bench().error(&base.predictions);
    let bare = base.bare()?;
    // Where corrections alone agree with the data and no law would bring its evidence beside them, none is followed.
    if bare.misfit() < DOUBTFUL && !bare.promises(CHOSEN)? {
        let (likely, _) = bare.likely()?;
        found.agrees = agrees(&likely, likely.misfit() * likely.count() as f64, 0);
        return Ok(Ok(Outcome { base: likely, found }));
    }
    let (mut here, drafts) = match base.localised()? {
        Ok(localised) => localised,
        Err(fault) => return Ok(Err(fault)),
    };
    let mut drafts = Some(drafts);
    let (mut likely, mut least) = bare.roughly();
    let mut told_alone = false;
    while found.rungs.len() < MOST_EFFECTS && (found.rungs.is_empty() || !here.control.is_late()) {
        let from = found.rungs.last().map(|rung| rung.refits[0].clone());
        let fits = match (&from, drafts.take()) {
            (None, Some(drafts)) => here.followed(drafts)?,
            (Some(from), _) => here.followed_beside(from, FURTHER)?,
            (None, None) => Vec::new(),
        };
        if found.rungs.is_empty() {
            let refits: Vec<Refit> = fits.iter().map(|(_, refit)| refit.clone()).collect();
            (here.early)(&conclusion::early(&here, &here.ranked(refits)));
        }
        let Some(weighed) = weighed(fits)? else { break };
        let best = &weighed.refits[0];
        let scale = scale_of(&weighed.refits, weighed.base.count());
        let doubtful = best.effects.iter().any(like_a_correction) || scale > DOUBTFUL;
        if from.is_none() && (bare.misfit() < RIVALLED * scale || doubtful) {
            (likely, least) = alone(&bare, &weighed)?;
            told_alone = true;
        }
        if std::env::var_os("DASH_DEBUG").is_some() {
            let groups = groups(here.data);
            let with = weighed.base.left_out(Some(best), &groups)?;
            let without = likely.left_out(from.as_ref(), &groups)?;
            let d: Vec<f64> = with.iter().zip(&without).map(|(a, b)| a - b).collect();
            let (n, sum) = (d.len() as f64, d.iter().sum::<f64>());
            let se = (n / (n - 1.0) * d.iter().map(|x| (x - sum / n).powi(2)).sum::<f64>()).sqrt();
            eprintln!(
                "ALONE {told_alone} rung {} {:?} evidence {:.1} scale {scale:.2} 2elpd {:.1} se {:.1} z {:.2} err {:.4} of {stated:.4} {:?}",
                found.rungs.len(),
                best.effects.last().map(|e| (e.effect, e.place.clone(), e.parameters.clone())),
                least - weighed.least,
                2.0 * sum,
                2.0 * se,
                sum / se,
                best.error,
                d.iter().map(|x| x.round() as i64).collect::<Vec<_>>()
            );
        }
        // What only lowers the error because every run has a stiffness of its own is nothing that could be added.
        let raises = best.error > stated;
        let known = best.parameters < weighed.base.count();
        if raises || !known || (least - weighed.least) / scale < evidence_needed(best) {
            break;
        }
        if (told_alone || from.is_some()) && !predicts_better(&weighed, (&likely, from.as_ref()))? {
            break;
        }
        found.agrees = agrees(&weighed.base, best.chi_square, best.parameters);
        least = weighed.least;
        let noise = weighed.base.noise.clone();
        found.rungs.push(Rung { scale, noise, refits: weighed.refits, probabilities: weighed.probabilities });
        likely = weighed.base;
        here = Base { predictions: likely.predictions.clone(), noise: likely.noise.clone(), ..likely.shallow() };
        // Corrections beyond what models are wrong by may stand in for one effect more.
        if found.agrees && is_likely(&likely) {
            break;
        }
    }
    if found.rungs.is_empty() {
        if !told_alone {
            (likely, _) = bare.likely()?;
        }
        found.agrees = agrees(&likely, likely.misfit() * likely.count() as f64, 0);
    }
    pruned(&likely, &mut found)?;
    Ok(Ok(Outcome { base: likely, found }))
}

/// The model with corrections alone, as likely as they make it, and its evidence: they may have ended in another valley than
/// those beside the effect.
fn alone<'a>(bare: &Base<'a>, weighed: &Weighed<'a>) -> Result<(Base<'a>, f64), DiagnosisError> {
    let (likely, least) = bare.likely()?;
    let beside = bare.updated(&weighed.base.linearisation.updating, &[], &Vec::new())?;
    let (estimated, cost) = beside.estimated()?;
    Ok(if cost < least { (estimated, cost) } else { (likely, least) })
}

/// Whether the best of the candidates predicts runs that are left out better than the model with corrections and the effects
/// before it, by more than may be by chance. A channel that is read wrongly is told by its evidence alone.
fn predicts_better(weighed: &Weighed, (likely, before): (&Base, Option<&Refit>)) -> Result<bool, DiagnosisError> {
    let best = &weighed.refits[0];
    if best.effects.last().is_some_and(|e| matches!(e.effect.kind(), Kind::Channel(_))) {
        return Ok(true);
    }
    let groups = groups(likely.data);
    Ok(exceeds(&weighed.base.left_out(Some(best), &groups)?, &likely.left_out(before, &groups)?))
}

fn like_a_correction(source: &Source) -> bool {
    matches!(source.effect, Effect::Stiffness | Effect::Mass)
}

/// Evidence that the last effect of a fit must bring beside `likely`, the model with corrections and the effects before it.
fn evidence_needed(refit: &Refit) -> f64 {
    let doubtful = refit.effects.len() > 1 || refit.effects.iter().any(like_a_correction);
    if doubtful { FURTHER } else { CHOSEN }
}

pub(crate) fn level(refit: &Refit) -> (f64, usize) {
    (refit.chi_square, refit.parameters)
}

/// Whether two effects at once agree with the data; then they are what was found.
fn two_at_once(base: &Base, found: &mut Found) -> Result<bool, DiagnosisError> {
    let (refits, noise) = base.polished(distinct(base.pairs()?))?;
    let refits = plainest(base, found, refits);
    found.agrees = refits.first().is_some_and(|best| fits_well(base, found, best));
    if found.agrees {
        found.rungs.push(Rung {
            scale: scale_of(&refits, base.count()),
            probabilities: base.probabilities(&refits),
            refits,
            noise,
        });
    }
    Ok(found.agrees)
}

/// Drops effects that the last set of a search no longer needs, now that the others are there.
fn pruned(base: &Base, found: &mut Found) -> Result<(), DiagnosisError> {
    while let Some(best) = found.rungs.last().map(|rung| rung.refits[0].clone()).filter(|r| r.effects.len() > 1) {
        let mut refits = Vec::new();
        for k in 0..best.effects.len() {
            let mut fewer = best.effects.clone();
            fewer.remove(k);
            refits.push(base.bench().refit(&fewer, 10, &FINAL, &best.starts)?);
        }
        let (refits, noise) = base.polished(base.ranked(refits))?;
        let enough = |r: &Refit| base.evidence(r, 1.0) < base.evidence(&best, 1.0) + EVIDENCE;
        let Some(first) = refits.first().filter(|r| enough(r)) else { break };
        found.agrees = agrees(base, first.chi_square, first.parameters) || nearly(base, first, found.before);
        found.rungs.pop();
        let scale = scale_of(&refits, base.count());
        let before = found.rungs.pop().map_or_else(Vec::new, |rung| rung.refits);
        let refits = distinct(base.ranked(refits.into_iter().chain(before).collect()));
        found.rungs.push(Rung { probabilities: base.probabilities(&refits), refits, scale, noise });
    }
    Ok(())
}

/// Adds rungs as long as the data demand them, up to `most`.
pub(crate) fn climb(base: &Base, found: &mut Found, mut last: (f64, usize), most: usize) -> Result<(), DiagnosisError> {
    while found.rungs.len() < most && !found.agrees {
        let refits = next(base, &found.rungs)?;
        if !add_rung(base, found, refits, last)? {
            break;
        }
        last = found.rungs.last().map_or(last, |r| level(&r.refits[0]));
    }
    Ok(())
}

/// Adds the rung of these fits if the best of them has the evidence.
pub(crate) fn add_rung(
    base: &Base,
    found: &mut Found,
    refits: Vec<Refit>,
    last: (f64, usize),
) -> Result<bool, DiagnosisError> {
    if found.rungs.is_empty() {
        (base.early)(&conclusion::early(base, &refits));
    }
    let (mut refits, mut noise) = base.polished(refits)?;
    let Some(best) = refits.first() else { return Ok(false) };
    if !fits_well(base, found, best) {
        let more = base.wider(best)?;
        refits.extend(more);
        (refits, noise) = base.polished(distinct(base.ranked(refits)))?;
    }
    let Some(best) = refits.first() else { return Ok(false) };
    if let Some(source) = best.effects.last() {
        let quiet = Base { noise: noise.clone(), predictions: base.predictions.clone(), ..base.shallow() };
        let margin = ELSEWHERE * scale_of(&refits, base.count());
        let fresh = |r: &Refit| !refits.iter().any(|known| same_set(&known.effects, &r.effects));
        let moved: Vec<Refit> = quiet.elsewhere(best, source, margin)?.into_iter().filter(fresh).collect();
        if !moved.is_empty() {
            refits.extend(moved);
            (refits, noise) = quiet.polished(base.ranked(refits))?;
        }
    }
    let refits = plainest(base, found, refits);
    let Some(best) = refits.first() else { return Ok(false) };
    if best.parameters >= base.count() {
        return Ok(false);
    }
    let scale = scale_of(&refits, base.count());
    let penalty = best.parameters.saturating_sub(last.1) as f64 * (base.count() as f64).ln();
    let gain = (last.0 - best.chi_square) / scale - penalty;
    if gain < EVIDENCE {
        return Ok(false);
    }
    found.agrees = fits_well(base, found, best);
    found.rungs.push(Rung { probabilities: base.probabilities(&refits), refits, scale, noise });
    Ok(true)
}

/// Without the sets whose laws contain simpler ones that leave no more than records and integrators are wrong by: what
/// little such laws explain beyond is as likely an error of those.
fn plainest(base: &Base, found: &Found, mut refits: Vec<Refit>) -> Vec<Refit> {
    let enough = |refit: &Refit| small(base, refit, found.before, [PLAIN, PLAIN_ERROR]);
    let contains = |set: &Refit, simple: &Refit| {
        simple.parameters < set.parameters && is_limit(&simple.effects, &set.effects) && enough(simple)
    };
    while let Some(best) = refits.first() {
        let Some(simple) = refits.iter().find(|r| contains(best, r)).cloned() else { break };
        refits.retain(|set| !contains(set, &simple));
    }
    refits
}

/// Whether a fit agrees with the data, or all but.
pub(crate) fn fits_well(base: &Base, found: &Found, refit: &Refit) -> bool {
    agrees(base, refit.chi_square, refit.parameters) || nearly(base, refit, found.before)
}

/// Sets of one effect more than the last rung.
fn next(base: &Base, rungs: &[Rung]) -> Result<Vec<Refit>, DiagnosisError> {
    let Some(last) = rungs.last() else { return base.singles(None) };
    let quiet = Base { noise: last.noise.clone(), predictions: base.predictions.clone(), ..base.shallow() };
    let mut refits = Vec::new();
    for start in last.refits.iter().take(2) {
        refits.extend(quiet.singles(Some(start))?);
    }
    if rungs.len() == 1 {
        refits.extend(quiet.pairs()?);
    }
    Ok(distinct(base.ranked(refits)))
}

/// The best fit of every set.
pub(crate) fn distinct(refits: Vec<Refit>) -> Vec<Refit> {
    let mut kept: Vec<Refit> = Vec::with_capacity(refits.len());
    for refit in refits {
        if !kept.iter().any(|k| same_set(&k.effects, &refit.effects)) {
            kept.push(refit);
        }
    }
    kept
}

pub(crate) fn same_set(a: &[Source], b: &[Source]) -> bool {
    a.len() == b.len() && a.iter().all(|x| b.iter().any(|y| x.is_same(y)))
}
