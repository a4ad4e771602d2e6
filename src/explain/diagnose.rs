//! Which effect is missing: ranked suggestions, the steps to a model that agrees with the data, a verdict.

use super::data::{Data, ExplainError, Problem};
use super::evidence::sentences;
use super::next_test::next_test;
use super::predict::{FINAL, Predictor, RunPrediction};
use super::refit::Refit;
use super::search::{Base, scale_of};
use crate::control::Control;
use crate::effects::Source;
use crate::math::statistics::{evidence_weights, root_mean_square};

/// Most effects that are added.
const MOST_EFFECTS: usize = 3;
/// Evidence (difference of the information criterion) that an effect must bring: its own, and that of having been
/// chosen among thousands.
const EVIDENCE: f64 = 25.0;
/// Squared residual per datum up to which a model agrees with the data, beyond the scatter of that figure.
const AGREES: f64 = 1.15;
/// Difference of the scaled squared residual within which two suggestions cannot be told apart.
const ALIKE: f64 = 9.0;

/// What the comparison of model and data says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The model agrees with the data to the noise.
    Adequate,
    /// An effect is missing, and it is named.
    Missing,
    /// The model disagrees, and the data cannot tell the suggestions apart.
    Undecided,
}

impl Verdict {
    /// Word in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Adequate => "adequate",
            Self::Missing => "missing",
            Self::Undecided => "undecided",
        }
    }
}

/// An effect with the standard deviations of its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Added {
    /// Effect, place and parameters.
    pub source: Source,
    /// Standard deviation of every parameter.
    pub deviations: Vec<f64>,
}

/// One suggested effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Suggestion {
    /// The effect.
    pub added: Added,
    /// Error of the model with this effect alone added.
    pub error_after: f64,
    /// The same on runs that were left out of the fit.
    pub held_out_error_after: f64,
    /// Probability among all that was looked at, 0 to 1.
    pub probability: f64,
    /// Why, in sentences with numbers.
    pub evidence: Vec<String>,
    /// Other effects or places that fit as well within the noise.
    pub indistinguishable_from: Vec<Source>,
}

/// The model on the way: effects added so far and the error with them.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// Effects.
    pub added: Vec<Added>,
    /// Error, as in `compare`.
    pub error: f64,
}

/// A run that would tell suggestions apart or pin a parameter down.
#[derive(Debug, Clone, PartialEq)]
pub struct NextTest {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Row of the DOF to be driven.
    pub force_dof: usize,
    /// Amplitude of the force, N.
    pub force: f64,
    /// What it would show.
    pub why: String,
}

/// The whole answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// Error of the model as it is.
    pub error_before: f64,
    /// What it would be were the model exact.
    pub noise_floor: f64,
    /// Verdict.
    pub verdict: Verdict,
    /// Suggestions, best first; none if adequate.
    pub suggestions: Vec<Suggestion>,
    /// From the model as it is to the best one.
    pub steps: Vec<Step>,
    /// Tests worth doing next.
    pub next_test: Vec<NextTest>,
}

/// Finds what the model of `problem` lacks.
pub fn diagnose(problem: &Problem, control: &Control) -> Result<Diagnosis, ExplainError> {
    if problem.structure.matrices().is_none() {
        return super::points_search::diagnose(problem, control);
    }
    let data = Data::new(problem)?;
    let predictor = Predictor::new(problem.structure, problem.known(), &data)?;
    let base = Base::new(&predictor, &data, control)?;
    Search { base: &base }.run()
}

/// A model on the ladder of added effects.
struct Rung {
    refits: Vec<Refit>,
    scale: f64,
}

struct Search<'a> {
    base: &'a Base<'a>,
}

impl Search<'_> {
    fn run(&self) -> Result<Diagnosis, ExplainError> {
        let base = self.base;
        let bench = base.bench();
        let before = square(&bench.residual(&base.predictions));
        let error_before = bench.error(&base.predictions);
        let noise_floor = noise_floor(base, &base.predictions);
        let first = Step { added: Vec::new(), error: error_before };
        let mut diagnosis = Diagnosis {
            error_before,
            noise_floor,
            verdict: Verdict::Adequate,
            suggestions: Vec::new(),
            steps: vec![first],
            next_test: Vec::new(),
        };
        if self.agrees(before, 0) && before < self.limit(0) {
            return Ok(diagnosis);
        }
        let rungs = self.climb(before)?;
        if rungs.is_empty() {
            let disagrees = before > 2.0 * base.count() as f64;
            diagnosis.verdict = if disagrees { Verdict::Undecided } else { Verdict::Adequate };
            return Ok(diagnosis);
        }
        self.conclude(&rungs, &mut diagnosis)?;
        Ok(diagnosis)
    }

    /// Whether a squared residual with `parameters` fitted is that of noise.
    fn agrees(&self, chi_square: f64, parameters: usize) -> bool {
        chi_square <= AGREES * self.limit(parameters)
    }

    /// Degrees of freedom and three deviations of their sum.
    fn limit(&self, parameters: usize) -> f64 {
        let n = self.base.count().saturating_sub(parameters) as f64;
        n + 3.0 * (2.0 * n).sqrt()
    }

    /// Adds effects as long as the data demand them; the refits of every number of effects.
    fn climb(&self, before: f64) -> Result<Vec<Rung>, ExplainError> {
        let mut rungs: Vec<Rung> = Vec::new();
        let mut last = (before, 0);
        while rungs.len() < MOST_EFFECTS && !self.agrees(last.0, last.1) {
            let refits = self.next(&rungs)?;
            let Some(best) = refits.first() else { break };
            if best.parameters >= self.base.count() {
                break;
            }
            let scale = scale_of(&refits, self.base.count());
            let penalty = (best.parameters - last.1.min(best.parameters)) as f64 * (self.base.count() as f64).ln();
            let gain = (last.0 - best.chi_square) / scale - penalty;
            if gain < EVIDENCE {
                break;
            }
            last = (best.chi_square, best.parameters);
            rungs.push(Rung { refits, scale });
            self.base.control.report(0.3 * rungs.len() as f64);
        }
        Ok(rungs)
    }

    /// Sets of one effect more than the last rung.
    fn next(&self, rungs: &[Rung]) -> Result<Vec<Refit>, ExplainError> {
        let base = self.base;
        let Some(last) = rungs.last() else { return base.singles(&[]) };
        let mut refits = Vec::new();
        for start in last.refits.iter().take(2) {
            refits.extend(base.singles(&start.effects)?);
        }
        if rungs.len() == 1 {
            refits.extend(base.pairs(&[])?);
        }
        let scale = scale_of(&refits, base.count());
        refits.sort_by(|a, b| base.evidence(a, scale).total_cmp(&base.evidence(b, scale)));
        refits.dedup_by(|a, b| same_set(&a.effects, &b.effects));
        Ok(refits)
    }

    fn conclude(&self, rungs: &[Rung], diagnosis: &mut Diagnosis) -> Result<(), ExplainError> {
        let base = self.base;
        let top = &rungs[rungs.len() - 1];
        let best = base.bench().refit(&top.refits[0].effects, 4, &FINAL)?;
        let predictions = base.bench().predict(&best.effects, &FINAL, &[])?;
        diagnosis.noise_floor = noise_floor(base, &predictions);
        let criteria: Vec<f64> = top.refits.iter().map(|r| base.evidence(r, top.scale)).collect();
        let weights = evidence_weights(&criteria);
        let ordered = self.order(&best, &rungs[0])?;
        for set in &ordered {
            diagnosis.steps.push(Step { added: added(set), error: set.error });
        }
        let final_set = added(ordered.last().unwrap_or(&best));
        for item in &final_set {
            let alone = self.alone(&item.source, &rungs[0])?;
            let probability = containing(&top.refits, &weights, &item.source);
            let alike = alike(&top.refits, &best, &item.source, top.scale);
            let held = base.bench().held_out_error(&alone)?;
            let others: Vec<Source> = best.effects.iter().filter(|e| !e.is_same(&item.source)).cloned().collect();
            let evidence = sentences(base, item, &others, diagnosis.error_before, alone.error)?;
            diagnosis.suggestions.push(Suggestion {
                added: item.clone(),
                error_after: alone.error,
                held_out_error_after: held,
                probability,
                evidence,
                indistinguishable_from: alike,
            });
        }
        self.alternatives(top, &weights, diagnosis)?;
        if let Some(rival) = top.refits.get(1) {
            diagnosis.next_test = next_test(base, &best.effects, &rival.effects)?.into_iter().collect();
        }
        let sure = diagnosis.suggestions.first().is_some_and(|s| s.probability >= 0.5);
        diagnosis.verdict = if sure { Verdict::Missing } else { Verdict::Undecided };
        Ok(())
    }

    /// The effects of the best set in the order in which they help, each prefix fitted.
    fn order(&self, best: &Refit, first: &Rung) -> Result<Vec<Refit>, ExplainError> {
        let bench = self.base.bench();
        if best.effects.len() == 1 {
            return Ok(vec![best.clone()]);
        }
        let mut rest = best.effects.clone();
        let mut chain: Vec<Refit> = Vec::new();
        let mut chosen: Vec<Source> = Vec::new();
        while rest.len() > 1 {
            let mut options = Vec::new();
            for k in 0..rest.len() {
                let set: Vec<Source> = chosen.iter().chain(std::iter::once(&rest[k])).cloned().collect();
                let known = first.refits.iter().find(|r| same_set(&r.effects, &set));
                options.push(known.map_or_else(|| bench.refit(&set, 8, &super::predict::SEARCH), |r| Ok(r.clone()))?);
            }
            let k = (0..rest.len()).min_by(|&a, &b| options[a].chi_square.total_cmp(&options[b].chi_square));
            let k = k.unwrap_or(0);
            chosen.push(rest.remove(k));
            chain.push(options.swap_remove(k));
        }
        chosen.extend(rest);
        chain.push(bench.refit(&chosen, 3, &FINAL)?);
        Ok(chain)
    }

    fn alone(&self, source: &Source, first: &Rung) -> Result<Refit, ExplainError> {
        let set = std::slice::from_ref(source);
        match first.refits.iter().find(|r| same_set(&r.effects, set)) {
            Some(refit) => self.base.bench().refit(&refit.effects, 3, &FINAL),
            None => self.base.bench().refit(set, 8, &FINAL),
        }
    }

    /// Suggestions beyond the best set: what else was fitted at the same number of effects.
    fn alternatives(&self, top: &Rung, weights: &[f64], diagnosis: &mut Diagnosis) -> Result<(), ExplainError> {
        for refit in top.refits.iter().skip(1) {
            let deviations = refit.effects.iter().zip(&refit.deviations);
            for (source, own) in deviations {
                let listed = diagnosis.suggestions.iter().any(|s| s.added.source.is_same(source));
                if listed || diagnosis.suggestions.len() >= 8 {
                    continue;
                }
                diagnosis.suggestions.push(Suggestion {
                    added: Added { source: source.clone(), deviations: own.clone() },
                    error_after: refit.error,
                    held_out_error_after: self.base.bench().held_out_error(refit)?,
                    probability: containing(&top.refits, weights, source),
                    evidence: vec![format!(
                        "With it the error would be {:.3} % instead of {:.3} %.",
                        100.0 * refit.error,
                        100.0 * diagnosis.error_before
                    )],
                    indistinguishable_from: Vec::new(),
                });
            }
        }
        Ok(())
    }
}

/// Error that noise and truncation alone would leave.
pub(crate) fn noise_floor(base: &Base, predictions: &[RunPrediction]) -> f64 {
    let Ok(noise) = base.whitenings(&[], predictions) else { return f64::NAN };
    let mut floors = Vec::new();
    for (run, noise) in base.data.runs.iter().zip(&noise) {
        for c in 0..run.responses.len() {
            let scale = run.scale(c);
            floors.push(if scale > 0.0 { noise.expected(c).sqrt() / scale } else { 0.0 });
        }
    }
    root_mean_square(&floors)
}

fn square(residual: &[f64]) -> f64 {
    residual.iter().map(|r| r * r).sum()
}

fn added(refit: &Refit) -> Vec<Added> {
    let pairs = refit.effects.iter().zip(&refit.deviations);
    pairs.map(|(source, deviations)| Added { source: source.clone(), deviations: deviations.clone() }).collect()
}

fn same_set(a: &[Source], b: &[Source]) -> bool {
    a.len() == b.len() && a.iter().all(|x| b.iter().any(|y| x.is_same(y)))
}

/// Probability of all sets that contain an effect at a place.
fn containing(refits: &[Refit], weights: &[f64], source: &Source) -> f64 {
    let with = refits.iter().zip(weights).filter(|(r, _)| r.effects.iter().any(|e| e.is_same(source)));
    with.map(|(_, w)| w).sum::<f64>().min(1.0)
}

/// Effects that in place of `source` leave a residual that differs by no more than noise.
fn alike(refits: &[Refit], best: &Refit, source: &Source, scale: f64) -> Vec<Source> {
    let others: Vec<&Source> = best.effects.iter().filter(|e| !e.is_same(source)).collect();
    let near = refits.iter().filter(|r| (r.chi_square - best.chi_square) / scale < ALIKE);
    let mut found: Vec<Source> = Vec::new();
    for refit in near {
        let fresh: Vec<&Source> = refit.effects.iter().filter(|e| !others.iter().any(|o| o.is_same(e))).collect();
        if let [other] = fresh[..]
            && !other.is_same(source)
            && !found.iter().any(|f| f.is_same(other))
        {
            found.push(other.clone());
        }
    }
    found
}
