//! Which law, or which sum of two or three, the loops of a component show.
//!
//! 1. Every law on the grid of its shapes, scaled to the force; every pair of shapes likewise, by their products.
//! 2. The best of each are fitted in all their parameters; where sums of two leave more than the noise, a third law is added to the
//!    best of them; one law of the best sums is exchanged for every other (`sums`).
//! 3. Each record is left out in turn and predicted from the others: a sum is told first only where it predicts clearly better
//!    than fewer laws. All, single laws and sums, are ranked by what they leave of the records that were left out
//!    ([`super::ranking`]).

use super::compare::noise_floor;
use super::fit::{Fitted, Ranked, error, freedom, improved, left_of_all, predicted, without_repeats};
use crate::balance::loops::{ComponentError, Loops};
use crate::control::Control;
use crate::diagnosis::candidates::special_cases::is_allowed;
use crate::diagnosis::result::{Added, Diagnosis, Early, Step, Suggestion, Verdict};
use crate::effects::{Range, Source};
use crate::math::statistics::{evidence_weights, root_mean_square};

/// Fits of one law, of two and of three.
const SINGLES: usize = 12;
const PAIRS: usize = 40;
const TRIPLES: usize = 20;
const ITERATIONS: usize = 20;
/// Error over that of the noise up to which a model agrees, and from which on a third law is looked for: below, what it adds is an error
/// of the other two.
const AGREES: f64 = 1.1;
const LACKING: f64 = 2.0;
/// Share of the force of all records together from which on the best laws explain nothing.
const POOR: f64 = 0.5;
/// Difference of evidence within which laws cannot be told apart.
const ALIKE: f64 = 6.0;
/// Error over that of the noise from which on it is said that more is in the loops.
const TOLD: f64 = 3.0;
/// Most suggestions.
const MOST: usize = 8;

/// Finds what the model of a component lacks; effects `excluded` are not suggested.
///
/// # Errors
/// [`ComponentError`]: laws without a force in time, a search that was stopped.
pub fn diagnose_component(
    loops: &Loops,
    excluded: &[Source],
    control: &Control,
    early: &Early,
) -> Result<Diagnosis, ComponentError> {
    let search = Search { loops, excluded, control, all: (0..loops.list.len()).collect() };
    let before = error(loops, &[], &search.all)?;
    let floor = noise_floor(loops, &[])?;
    let misfit = |error: f64| (error / floor.max(f64::MIN_POSITIVE)).powi(2);
    let stated = Step { added: Vec::new(), error: before, misfit: misfit(before) };
    let mut diagnosis = Diagnosis::adequate(stated, floor);
    if before < AGREES * floor {
        return Ok(diagnosis);
    }
    let columns = search.columns()?;
    let singles = search.fitted(Search::single(&columns), SINGLES)?;
    if singles.is_empty() {
        diagnosis.verdict = Verdict::Unexplained;
        return Ok(diagnosis);
    }
    control.report(0.4);
    early(&search.suggestions(&search.by_evidence(&singles))?);
    let pairs = search.with_exchanges(&columns, search.fitted(Search::pairs(&columns), PAIRS)?)?;
    control.report(0.6);
    let lacks = pairs.first().is_some_and(|best| best.error(loops.list.len()) > LACKING * floor);
    let triples = if lacks {
        search.with_exchanges(&columns, search.fitted(search.triples(&columns, &pairs)?, TRIPLES)?)?
    } else {
        Vec::new()
    };
    control.report(0.8);
    let sizes = [singles, pairs, triples];
    let ranked = search.ranked(&sizes)?;
    let Some(best) = ranked.first().map(|r| r.fit.clone()) else { return Err(ComponentError::NoRuns) };
    // The law that was found carries the noise of the displacement to the force.
    let floor = noise_floor(loops, &best.effects)?;
    diagnosis.noise_floor = floor;
    let misfit = |error: f64| (error / floor.max(f64::MIN_POSITIVE)).powi(2);
    let records = loops.list.len();
    for fits in &sizes {
        let top = if fits.first().is_some_and(|f| f.effects.len() == best.effects.len()) {
            Some(&best)
        } else {
            fits.first()
        };
        if let Some(fit) = top.filter(|f| f.effects.len() <= best.effects.len()) {
            let error = fit.error(records);
            diagnosis.steps.push(Step { added: added(fit), error, misfit: misfit(error) });
        }
    }
    diagnosis.suggestions = search.suggestions(&ranked)?;
    if let Some(first) = diagnosis.suggestions.first_mut() {
        first.evidence.extend(beyond_noise(best.error(records) / floor.max(f64::MIN_POSITIVE)));
    }
    let sure = diagnosis.suggestions.first().is_some_and(|s| s.probability >= 0.5);
    diagnosis.verdict = match left_of_all(loops, &best.effects)? {
        left if left > POOR => Verdict::Unexplained,
        _ if sure => Verdict::Missing,
        _ => Verdict::Undecided,
    };
    diagnosis.complete = control.is_complete();
    control.report(1.0);
    Ok(diagnosis)
}

pub(super) struct Search<'a> {
    pub loops: &'a Loops,
    pub excluded: &'a [Source],
    pub control: &'a Control,
    pub all: Vec<usize>,
}

impl Search<'_> {
    /// The first `count` starts fitted in all parameters, by evidence.
    pub(super) fn fitted(&self, starts: Vec<Vec<Source>>, count: usize) -> Result<Vec<Fitted>, ComponentError> {
        let few: Vec<Vec<Source>> = starts.into_iter().take(count).collect();
        let range = self.loops.range();
        let fitted_start = |k: usize| -> Result<Option<Fitted>, ComponentError> {
            let fit = improved(self.loops, &few[k], &self.all, ITERATIONS, self.control)?;
            // A law that is all but a simpler one on these loops is that one.
            let plain: Vec<Source> =
                fit.effects.iter().map(|e| e.simpler(&range).unwrap_or_else(|| e.clone())).collect();
            if plain == fit.effects {
                return Ok(Some(fit));
            }
            // A sum of which two laws are one is a smaller sum, which is looked at among those.
            if distinct(&plain).len() < plain.len() {
                return Ok(None);
            }
            improved(self.loops, &plain, &self.all, ITERATIONS, self.control).map(Some)
        };
        let fits = self.control.map(few.len(), fitted_start).into_iter().collect::<Result<Vec<_>, _>>()?;
        let mut fits: Vec<Fitted> = fits.into_iter().flatten().collect();
        fits.retain(|f| {
            let mut at = 0;
            f.effects.iter().all(|e| {
                let own = &f.deviations[at..at + e.parameters.len()];
                at += e.parameters.len();
                is_allowed(self.excluded, e, own) && is_determined(e, own, &range) && !e.is_disguised()
            })
        });
        fits.sort_by(|a, b| self.criterion(a).total_cmp(&self.criterion(b)));
        Ok(without_repeats(fits))
    }

    /// Bayesian information criterion on the independent data of the loops.
    pub(super) fn criterion(&self, fit: &Fitted) -> f64 {
        let count = freedom(self.all.len());
        count * fit.square.max(1e-12).ln() + parameters(fit) as f64 * count.max(2.0).ln()
    }

    fn suggestions(&self, ranked: &[Ranked]) -> Result<Vec<Suggestion>, ComponentError> {
        let weights = evidence_weights(&ranked.iter().map(|r| r.criterion).collect::<Vec<f64>>());
        let mut list: Vec<Suggestion> = Vec::new();
        for (k, (Ranked { fit, held_out, criterion }, weight)) in ranked.iter().zip(&weights).enumerate() {
            let error = fit.error(self.loops.list.len());
            let energy = self.energy_error(fit)?;
            for added in added(fit) {
                if let Some(known) = list.iter_mut().find(|s| s.added.source.is_same(&added.source)) {
                    known.probability = (known.probability + weight).min(1.0);
                    continue;
                }
                if list.len() >= MOST {
                    continue;
                }
                let alike = |j: &usize| *j != k && (ranked[*j].criterion - criterion).abs() < ALIKE;
                let others = (0..ranked.len()).filter(alike).flat_map(|j| &ranked[j].fit.effects);
                let others: Vec<Source> =
                    others.filter(|o| !fit.effects.iter().any(|e| e.is_same(o))).cloned().collect();
                let indistinguishable_from = distinct(&others);
                let mut words = vec![
                    added.source.effect.sentence().to_string(),
                    format!(
                        "With it {:.2} % of the force is left, {:.2} % of the energy of the loops.",
                        100.0 * error,
                        100.0 * energy
                    ),
                ];
                words.extend(beside(fit, &added.source));
                list.push(Suggestion {
                    added,
                    error_after: error,
                    held_out_error_after: held_out.unwrap_or(error),
                    probability: *weight,
                    evidence: words,
                    indistinguishable_from,
                });
            }
        }
        // The laws of the best fit, the surest first; of those that are as sure the one with the larger force.
        let first = ranked.first().map_or(0, |best| best.fit.effects.len()).min(list.len());
        list[..first].sort_by_cached_key(|s| {
            let percent = (100.0 * s.probability).round() as i64;
            (-percent, std::cmp::Reverse(self.force_square(&s.added.source).to_bits()))
        });
        Ok(list)
    }

    /// Sum over the records of the mean square of the force of a source, N^2; its bits are in its order.
    fn force_square(&self, source: &Source) -> f64 {
        let forces = self.loops.list.iter().filter_map(|one| one.law_force(source));
        forces.map(|force| root_mean_square(&force).powi(2)).sum()
    }

    /// Relative error of the energy of the records, root mean square.
    fn energy_error(&self, fit: &Fitted) -> Result<f64, ComponentError> {
        let relative_error = |one: &crate::balance::loops::LoopRecord| -> Result<f64, ComponentError> {
            let (measured, model) = (one.work(&one.force), one.work(&predicted(self.loops, one, &fit.effects)?));
            Ok((model - measured) / measured)
        };
        let all: Vec<f64> = self.loops.list.iter().map(relative_error).collect::<Result<_, _>>()?;
        Ok(root_mean_square(&all))
    }
}

/// Laws without those that stand in the list before.
fn distinct(laws: &[Source]) -> Vec<Source> {
    let mut different: Vec<Source> = Vec::new();
    for law in laws {
        if !different.iter().any(|known| known.is_same(law)) {
            different.push(law.clone());
        }
    }
    different
}

/// Whether the loops fix every size of a law, and every parameter of one that has simpler laws as limits, to within its own size: what
/// they do not fix is nothing, or a simpler law by another name. A pure number may be uncertain by more than its size where no limit is
/// that near: the share of the sliders of a joint that slip last is nothing, to first order without effect there.
fn is_determined(source: &Source, deviations: &[f64], range: &Range) -> bool {
    let has_limits = source.effect.limits().next().is_some();
    let near_limit = |k: usize| {
        let is_simpler = |value: f64| {
            let mut moved = source.clone();
            moved.parameters[k] = value;
            source.effect.parameters()[k].allows(value) && moved.simpler(range).is_some()
        };
        is_simpler(source.parameters[k] + deviations[k]) || is_simpler(source.parameters[k] - deviations[k])
    };
    let is_number = |k: usize| source.effect.parameters()[k].unit.is_empty();
    let fixed = |k: usize| {
        deviations[k].is_finite() && (deviations[k] < source.parameters[k].abs() || (is_number(k) && !near_limit(k)))
    };
    (0..source.parameters.len()).filter(|k| has_limits || source.effect.scaled().contains(k)).all(fixed)
}

/// What is said where a sum leaves that many times the noise.
fn beyond_noise(times: f64) -> Option<String> {
    (times > TOLD).then(|| {
        format!(
            "That is {times:.1} times the noise: the loops hold more than these laws give, and no sum of three laws here gives it."
        )
    })
}

/// What is said of a law that stands in a sum.
fn beside(fit: &Fitted, source: &Source) -> Option<String> {
    let others: Vec<String> =
        fit.effects.iter().filter(|e| !e.is_same(source)).map(|e| e.effect.title().to_string()).collect();
    match &others[..] {
        [] => None,
        [other] => Some(format!("That is in a sum with another law: {other}.")),
        _ => Some(format!("That is in a sum with other laws: {}.", others.join(", "))),
    }
}

/// Number of parameters of all laws.
pub(super) fn parameters(fit: &Fitted) -> usize {
    fit.effects.iter().map(|e| e.parameters.len()).sum()
}

fn added(fit: &Fitted) -> Vec<Added> {
    let mut at = 0;
    let with_deviations = |source: &Source| {
        let deviations = fit.deviations[at..at + source.parameters.len()].to_vec();
        at += source.parameters.len();
        Added { source: source.clone(), deviations }
    };
    fit.effects.iter().map(with_deviations).collect()
}
