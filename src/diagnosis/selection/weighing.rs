//! Candidates with models of their own, weighed by their evidence: what they leave, what their parameters and the freedom of
//! the model beside them cost.

use crate::diagnosis::candidates::special_cases::is_limit;
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::residual::prediction::{FINAL, SEARCH};
use crate::diagnosis::selection::fitted_model::Refit;
use crate::diagnosis::selection::search::Base;
use crate::diagnosis::updating::parameters::{Scales, UpdatingParameter};
use crate::effects::{Effect, Place, Range, Source};
use crate::structure::Part;
use crate::structure::factors::Share;

/// Candidates weighed by their evidence, each with the scales that are most likely beside it.
pub(super) struct Weighed<'a> {
    /// The model with the scales of the best.
    pub base: Base<'a>,
    /// Best first.
    pub refits: Vec<Refit>,
    pub costs: Vec<f64>,
    pub least: f64,
}

/// Times that model, effects and scales of the best are settled in turn.
const SETTLED_AGAIN: usize = 2;
/// Rounds of each.
const UPDATES: usize = 6;
/// Evidence behind the best, with the scales of the search, beyond which no other scales would make a candidate the best.
const LIGHT: f64 = 300.0;
/// Squared residual per datum of the best from which on candidates within so many times what it leaves are weighed too.
const COARSE: f64 = 3.0;
const HEAVY: f64 = 2.0;
/// Candidates whose scales are estimated.
const WEIGHED: usize = 6;

/// Weighs fitted candidates, each with the model that was updated beside it.
pub(super) fn weighed<'a>(mut fits: Vec<(Base<'a>, Refit)>) -> Result<Option<Weighed<'a>>, DiagnosisError> {
    fits.retain(|(base, refit)| is_effect(base, refit));
    fits.sort_by(|a, b| cost(&a.0, Some(&a.1)).total_cmp(&cost(&b.0, Some(&b.1))));
    let one = |k: usize| -> Result<(f64, Base<'a>, Refit), DiagnosisError> {
        let (base, refit) = fits[k].0.with_likely_scales(Some(&fits[k].1), &SEARCH)?;
        let refit = refit.unwrap_or_else(|| fits[k].1.clone());
        let (likely, before) = (cost(&base, Some(&refit)), cost(&fits[k].0, Some(&fits[k].1)));
        if likely < before {
            return Ok((likely, base, refit));
        }
        let own = &fits[k].0;
        Ok((before, own.with_scales(own.linearisation.updating.scales), fits[k].1.clone()))
    };
    let Some(control) = fits.first().map(|(base, _)| base.control) else { return Ok(None) };
    let (first, left) = (cost(&fits[0].0, Some(&fits[0].1)), fits[0].1.chi_square);
    // Where even the best leaves much with the scales of the search, these say little of the order.
    let coarse = left > COARSE * fits[0].0.count() as f64;
    let near = first + if coarse { LIGHT.max(HEAVY * left) } else { LIGHT };
    let count = fits.iter().take(WEIGHED).take_while(|(base, refit)| cost(base, Some(refit)) < near).count();
    let told = |k: usize| -> Result<(f64, Base<'a>, Refit), DiagnosisError> {
        let (cost, base, refit) = one(k)?;
        let error = base.error_of_structure(&refit.effects, &refit.starts)?;
        Ok((cost, base, Refit { error, ..refit }))
    };
    let mut all = control.map(count, told).into_iter().collect::<Result<Vec<_>, _>>()?;
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let plain = plainest_first(&mut all);
    let costs: Vec<f64> = all.iter().map(|(cost, _, _)| *cost).collect();
    let refits: Vec<Refit> = all.iter().map(|(_, _, refit)| refit.clone()).collect();
    for (k, (_, base, refit)) in all.into_iter().enumerate().take(FINISHED) {
        let (base, mut refit) = finished(base, refit)?;
        refit.error = base.error_of_structure(&refit.effects, &refit.starts)?;
        if !is_effect(&base, &refit) {
            continue;
        }
        let least = cost(&base, Some(&refit));
        let refit = with_told_deviations(&base, refit)?;
        let mut order: Vec<(f64, Refit)> = costs.iter().copied().zip(refits).skip(k + 1).collect();
        // What is told first for being simpler is not to be told as the less likely.
        let others = order.iter().map(|(cost, _)| *cost).fold(f64::INFINITY, f64::min);
        order.insert(0, (if plain { least.min(others - SIMPLER) } else { least }, refit));
        let (costs, refits) = order.into_iter().unzip();
        return Ok(Some(Weighed { base, refits, costs, least }));
    }
    Ok(None)
}

/// Evidence, in units of what the best leaves per datum, by which a law may lead a simpler one that it contains and still not be
/// told in its stead: real laws are no more exact than that.
const NESTED: f64 = 40.0;

/// Evidence that being simpler counts for there.
const SIMPLER: f64 = 8.0;

/// Puts the simplest law that the best contains first where it is nearly as likely; whether there is one.
fn plainest_first(all: &mut [(f64, Base, Refit)]) -> bool {
    let Some((least, base, best)) = all.first() else { return false };
    let scale = (best.chi_square / base.count().max(1) as f64).max(1.0);
    // A model that leaves no more than noise tells nested laws apart by their evidence alone.
    let margin = if scale > NOISY { NESTED * scale } else { 0.0 };
    let simpler = |(cost, _, refit): &(f64, Base, Refit)| {
        refit.parameters < best.parameters && is_limit(&refit.effects, &best.effects) && *cost < least + margin
    };
    let found = all.iter().position(simpler);
    if let Some(k) = found {
        all[..=k].rotate_right(1);
    }
    found.is_some()
}

/// Squared residual per datum from which on a fit leaves more than noise.
const NOISY: f64 = 1.1;

/// Candidates that are settled to the end: where the best turns out to be nothing, the next.
const FINISHED: usize = 2;

/// A candidate with its model, settled in turn with the most likely scales.
fn finished(base: Base<'_>, refit: Refit) -> Result<(Base<'_>, Refit), DiagnosisError> {
    let (mut base, mut refit) = (base, refit);
    for _ in 0..SETTLED_AGAIN {
        if base.control.is_late() {
            break;
        }
        let (there, settled) = base.settled(refit, &SEARCH, UPDATES)?;
        let (likely, again) = there.with_likely_scales(Some(&settled), &SEARCH)?;
        let again = again.unwrap_or_else(|| settled.clone());
        let better = cost(&likely, Some(&again)) < cost(&there, Some(&settled));
        (base, refit) = if better { (likely, again) } else { (there, settled) };
    }
    base.settled(refit, &FINAL, UPDATES)
}

/// Whether both are the same coupling read from either end.
fn is_reverse(a: Part, b: Part) -> bool {
    matches!((a, b), (Part::Coupling([i, j]), Part::Coupling([k, l])) if i == l && j == k)
}

/// A fit with the deviations that hold where nothing is known better than laboratories know it: what is common to all gains
/// and all of the model no data tell, so that the likeliest scales are too small for it.
fn with_told_deviations(base: &Base, refit: Refit) -> Result<Refit, DiagnosisError> {
    let scales = base.linearisation.updating.scales.at_least(&Scales::SEARCH);
    let told = base.with_scales(scales).bench().refit(&refit.effects, 1, &FINAL, &refit.starts)?;
    Ok(Refit { deviations: told.deviations, ..refit })
}

/// Relative size of an added spring or mass up to which it is an error of the one that is there.
const OF_THE_PART: f64 = 0.05;

/// Whether every effect of a fit is of a size that the data know, and more than an error of a part of the model.
fn is_effect(base: &Base, refit: &Refit) -> bool {
    let within = |source: &Source| {
        let source = &source.simpler(&Range::UNKNOWN).unwrap_or_else(|| source.clone());
        // What the model has too much of is no missing effect, but a correction.
        if matches!(source.effect, Effect::Mass | Effect::Stiffness) && source.parameters[0] < 0.0 {
            return true;
        }
        let part = match (source.effect, &source.place) {
            (Effect::Mass, Place::Dofs(dofs)) if dofs.len() == 1 => Part::PointMass(dofs[0]),
            (Effect::Stiffness, Place::Dofs(dofs)) if dofs.len() == 1 => Part::GroundSpring(dofs[0]),
            (Effect::Stiffness, Place::Dofs(dofs)) if dofs.len() == 2 => Part::Coupling([dofs[0], dofs[1]]),
            _ => return false,
        };
        let parameters = &base.linearisation.updating.parameters;
        let updated = parameters.iter().any(|p| match p {
            UpdatingParameter::Structure(other) => *other == part || is_reverse(*other, part),
            _ => false,
        });
        let own = match base.predictor.structure().share(part).filter(|_| updated || source.effect == Effect::Mass) {
            Some(Share::Stiffness(entries) | Share::Mass(entries)) => entries.first().map_or(0.0, |e| e.2.abs()),
            None => 0.0,
        };
        source.parameters[0].abs() < OF_THE_PART * own
    };
    !base.ranked(vec![refit.clone()]).is_empty() && !refit.effects.iter().any(within)
}

/// Evidence of a model whose updating parameters are free, with the effects of `refit`; the smaller, the better.
fn cost(base: &Base, refit: Option<&Refit>) -> f64 {
    let fit = match refit {
        Some(refit) => base.evidence(refit, 1.0),
        None => base.bench().residual(&base.predictions).iter().map(|r| r * r).sum(),
    };
    fit + base.noise.cost()
}
