//! Which law, or which sum of two, the loops of a component show.
//!
//! 1. Every law on the grid of its shapes, scaled to the force; every pair of shapes likewise, by their products.
//! 2. The best of each are fitted in all their parameters.
//! 3. Each record is left out in turn and predicted from the others: a sum of two is told first only where it predicts clearly
//!    better than one law. All, single laws and sums, are ranked by what they leave of the records that were left out
//!    ([`super::ranking`]).

use super::compare::noise_floor;
use super::fit::{Fitted, Ranked, error, freedom, improved, predicted, residual};
use crate::balance::loops::{ComponentError, Loops};
use crate::control::Control;
use crate::diagnosis::candidates::special_cases::is_allowed;
use crate::diagnosis::result::{Added, Diagnosis, Early, Step, Suggestion, Verdict};
use crate::effects::{Effect, Place, Source, State};
use crate::math::statistics::{evidence_weights, root_mean_square};
use dashpot_numerics::dot;

/// Rows on which shapes are compared, shapes a law that go into pairs, fits of one law and of two.
const ROWS: usize = 4000;
const SHAPES: usize = 6;
const SINGLES: usize = 12;
const PAIRS: usize = 10;
const ITERATIONS: usize = 20;
/// Error over that of the noise up to which a model agrees.
const AGREES: f64 = 1.1;
/// Error from which on the best laws explain nothing.
const POOR: f64 = 0.5;
/// Difference of evidence within which laws cannot be told apart.
const ALIKE: f64 = 6.0;
/// Most suggestions.
const MOST: usize = 8;

/// A law in one shape, its force in unit scale over rows of all records.
struct Column {
    source: Source,
    rows: Vec<f64>,
    square: f64,
    against: f64,
}

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
    let mut diagnosis = Diagnosis {
        error_before: before,
        noise_floor: floor,
        verdict: Verdict::Adequate,
        suggestions: Vec::new(),
        steps: vec![Step { added: Vec::new(), error: before, misfit: misfit(before) }],
        next_test: Vec::new(),
        corrections: Vec::new(),
        channel_faults: Vec::new(),
        records: None,
        complete: true,
        runs: Vec::new(),
    };
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
    let pairs = search.fitted(Search::pairs(&columns), PAIRS)?;
    control.report(0.8);
    let ranked = search.ranked(&singles, &pairs)?;
    let Some(best) = ranked.first().map(|r| r.fit.clone()) else { return Err(ComponentError::NoRuns) };
    // The law that was found carries the noise of the displacement to the force.
    let floor = noise_floor(loops, &best.effects)?;
    diagnosis.noise_floor = floor;
    let misfit = |error: f64| (error / floor.max(f64::MIN_POSITIVE)).powi(2);
    let records = loops.list.len();
    for fits in [&singles, &pairs] {
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
    let sure = diagnosis.suggestions.first().is_some_and(|s| s.probability >= 0.5);
    diagnosis.verdict = match best.error(records) {
        error if error > POOR => Verdict::Unexplained,
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
    /// Every law in every shape.
    fn columns(&self) -> Result<Vec<Column>, ComponentError> {
        let measured = Self::thinned(residual(self.loops, &[], &self.all)?);
        let range = self.loops.range();
        let mut columns = Vec::new();
        for (effect, _) in Effect::relative() {
            self.control.check()?;
            for parameters in effect.shapes(&range) {
                let source = Source { effect, place: Place::Dofs(vec![0]), state: State::Known, parameters };
                let taken = |list: &[Source]| list.iter().any(|s| s.is_same(&source));
                if taken(self.excluded) || self.loops.list[0].law_force(&source).is_none() {
                    continue;
                }
                // What is left with the law less what is left without it: its force, zero taken out, with a minus.
                let with = Self::thinned(residual(self.loops, std::slice::from_ref(&source), &self.all)?);
                let rows: Vec<f64> = measured.iter().zip(&with).map(|(m, w)| m - w).collect();
                let (square, against) = (dot(&rows, &rows), dot(&rows, &measured));
                if square > 0.0 && square.is_finite() {
                    columns.push(Column { source, rows, square, against });
                }
            }
        }
        Ok(columns)
    }

    fn thinned(rows: Vec<f64>) -> Vec<f64> {
        let every = (rows.len() / ROWS).max(1);
        rows.into_iter().step_by(every).collect()
    }

    /// The best shape of every law, best first.
    fn single(columns: &[Column]) -> Vec<Vec<Source>> {
        let mut found: Vec<(f64, Source)> = Vec::new();
        for column in columns {
            let Some(source) = sized(&column.source, column.against / column.square) else { continue };
            let gain = column.against.powi(2) / column.square;
            match found.iter_mut().find(|(_, s)| s.effect == source.effect) {
                Some(own) if gain > own.0 => *own = (gain, source),
                Some(_) => {}
                None => found.push((gain, source)),
            }
        }
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found.into_iter().map(|(_, source)| vec![source]).collect()
    }

    /// The best pair of shapes of every pair of laws, best first.
    fn pairs(columns: &[Column]) -> Vec<Vec<Source>> {
        let mut chosen: Vec<&Column> = Vec::new();
        for (effect, _) in Effect::relative() {
            let mut own: Vec<&Column> = columns.iter().filter(|c| c.source.effect == effect).collect();
            let every = own.len().div_ceil(SHAPES).max(1);
            own.sort_by(|a, b| (b.against.powi(2) / b.square).total_cmp(&(a.against.powi(2) / a.square)));
            let best = own.first().copied();
            chosen.extend(columns.iter().filter(|c| c.source.effect == effect).step_by(every));
            chosen.extend(best);
        }
        let mut found: Vec<(f64, Vec<Source>)> = Vec::new();
        for (i, a) in chosen.iter().enumerate() {
            for b in chosen.iter().skip(i + 1).filter(|b| b.source.effect != a.source.effect) {
                let product = dot(&a.rows, &b.rows);
                let determinant = a.square * b.square - product * product;
                if determinant < 1e-6 * a.square * b.square {
                    continue;
                }
                let s = (b.square * a.against - product * b.against) / determinant;
                let t = (a.square * b.against - product * a.against) / determinant;
                let (Some(first), Some(second)) = (sized(&a.source, s), sized(&b.source, t)) else { continue };
                let gain = s * a.against + t * b.against;
                let same = |set: &[Source]| set[0].effect == first.effect && set[1].effect == second.effect;
                match found.iter_mut().find(|(_, set)| same(set)) {
                    Some(own) if gain > own.0 => *own = (gain, vec![first, second]),
                    Some(_) => {}
                    None => found.push((gain, vec![first, second])),
                }
            }
        }
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found.into_iter().map(|(_, set)| set).collect()
    }

    /// The first `count` starts fitted in all parameters, by evidence.
    fn fitted(&self, starts: Vec<Vec<Source>>, count: usize) -> Result<Vec<Fitted>, ComponentError> {
        let few: Vec<Vec<Source>> = starts.into_iter().take(count).collect();
        let one = |k: usize| improved(self.loops, &few[k], &self.all, ITERATIONS, self.control);
        let mut fits = self.control.map(few.len(), one).into_iter().collect::<Result<Vec<Fitted>, _>>()?;
        fits.retain(|f| {
            let mut at = 0;
            f.effects.iter().all(|e| {
                let own = &f.deviations[at..at + e.parameters.len()];
                at += e.parameters.len();
                is_allowed(self.excluded, e, own) && is_determined(e, own) && !e.is_disguised()
            })
        });
        fits.sort_by(|a, b| self.criterion(a).total_cmp(&self.criterion(b)));
        Ok(fits)
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
                let indistinguishable_from =
                    others.filter(|o| !fit.effects.iter().any(|e| e.is_same(o))).cloned().collect();
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
        Ok(list)
    }

    /// Relative error of the energy of the records, root mean square.
    fn energy_error(&self, fit: &Fitted) -> Result<f64, ComponentError> {
        let of = |one: &crate::balance::loops::Loop| -> Result<f64, ComponentError> {
            let (measured, model) = (one.work(&one.force), one.work(&predicted(self.loops, one, &fit.effects)?));
            Ok((model - measured) / measured)
        };
        let all: Vec<f64> = self.loops.list.iter().map(of).collect::<Result<_, _>>()?;
        Ok(root_mean_square(&all))
    }
}

/// Whether the loops fix every parameter to within its own size: a law with one that they do not is a simpler one by another name.
fn is_determined(source: &Source, deviations: &[f64]) -> bool {
    source.effect.limits().next().is_none()
        || source.parameters.iter().zip(deviations).all(|(p, d)| d.is_finite() && *d < p.abs())
}

/// What is said of a law that stands in a sum.
fn beside(fit: &Fitted, source: &Source) -> Option<String> {
    let other = fit.effects.iter().find(|e| !e.is_same(source))?;
    Some(format!("That is in a sum with another law: {}.", other.effect.title()))
}

/// Number of parameters of all laws.
pub(super) fn parameters(fit: &Fitted) -> usize {
    fit.effects.iter().map(|e| e.parameters.len()).sum()
}

/// A law of unit scale at a scale; none where its parameters do not allow it.
fn sized(source: &Source, scale: f64) -> Option<Source> {
    let mut source = source.clone();
    source.effect.scaled().iter().for_each(|&k| source.parameters[k] *= scale);
    let allowed = source.parameters.iter().zip(source.effect.parameters()).all(|(v, p)| p.allows(*v));
    (scale.is_finite() && scale != 0.0 && allowed).then_some(source)
}

fn added(fit: &Fitted) -> Vec<Added> {
    let mut at = 0;
    let of = |source: &Source| {
        let deviations = fit.deviations[at..at + source.parameters.len()].to_vec();
        at += source.parameters.len();
        Added { source: source.clone(), deviations }
    };
    fit.effects.iter().map(of).collect()
}
