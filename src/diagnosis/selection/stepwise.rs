//! Stepwise selection of effects, from the model as it is to one that agrees with the data: one at a time or by pairs;
//! where effects alone do not get there, beside corrections.

use super::beside_corrections::beside_updating;
use super::found::{
    AGREES, DOUBTFUL, EVIDENCE, Found, LAST, MOST_EFFECTS, Rung, distinct, fits_well, level, same_set, small,
};
use crate::diagnosis::candidates::special_cases::is_limit;
use crate::diagnosis::channels::ChannelFault;
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::selection::conclusion::{self, Outcome};
use crate::diagnosis::selection::fits::STEPS;
use crate::diagnosis::selection::fitted_model::Refit;
use crate::diagnosis::selection::search::{Base, scale_of};

/// Deviations within which it agrees so well that no further effect is looked for.
const SETTLED: f64 = 1.5;
/// Evidence that an effect must bring where the model agrees without it.
const CONFIRMED: f64 = 50.0;
/// The same for a law that another contains.
const PLAIN: f64 = 1e-4;
const PLAIN_ERROR: f64 = 1e-3;
/// How many times the squared residual of noise free forces may leave where the laws behind them may still explain it.
const REACH: f64 = 4.0;
/// Scaled squared residual within which places are worth trying with a law that was found elsewhere.
const ELSEWHERE: f64 = 40.0;
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
