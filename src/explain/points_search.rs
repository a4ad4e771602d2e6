//! The search for `points` structures, on the energies alone.
//!
//! ```text
//! e_r - sum of known = sum_j s_j G_rj(shape_j) + noise,      s_j >= 0
//! ```
//!
//! one column a law, place and shape of its grid. All columns and all pairs of columns are looked at; the best are
//! fitted in all their parameters. What takes no energy (springs, masses) cannot be seen.

use super::data::{ExplainError, Problem, RunData};
use super::descent::{Residual, Variables, descend};
use super::diagnose::{Added, Diagnosis, Step, Suggestion, Verdict};
use super::energy::taken;
use super::points::{PointsEnergy, displacement, energies};
use super::shapes::{Range, scaled, shapes};
use crate::control::Control;
use crate::effects::{Effect, Leg, Motion, Place, Source, State};
use crate::math::statistics::{bayesian_information, evidence_weights, root_mean_square};
use crate::structure::Structure;
use dashpot_numerics::transposed_product;
use faer::{Mat, c64};
use std::convert::Infallible;

/// Sets that are fitted in all their parameters, at each number of effects.
const REFITS: usize = 24;
/// Evidence that an effect must bring.
const EVIDENCE: f64 = 15.0;
/// Allowance for what no model matches, relative to the energy of the run.
const ALLOWANCE: f64 = 5e-4;
/// Difference of the squared residual within which two suggestions cannot be told apart.
const ALIKE: f64 = 9.0;
/// Samples a period.
const SAMPLES: usize = 256;

/// Energies of the used runs as data.
struct Balance<'a> {
    structure: &'a Structure,
    runs: Vec<RunData>,
    /// Input less what is known, J.
    missing: Vec<f64>,
    input: Vec<f64>,
    deviation: Vec<f64>,
}

/// One column: a source of unit scale and its energies.
struct Column {
    source: Source,
    /// Energy over the deviation, one a run.
    weighted: Vec<f64>,
}

/// A set fitted in all its parameters.
#[derive(Clone)]
struct Fitted {
    added: Vec<Added>,
    chi_square: f64,
    parameters: usize,
    error: f64,
    held_out: f64,
}

impl<'a> Balance<'a> {
    fn new(problem: &'a Problem, effects: &[Source]) -> Result<Self, ExplainError> {
        let data = super::data::Data::new(problem)?;
        let used = |e: &PointsEnergy| data.runs.iter().any(|r| r.index == e.index);
        let plain: Vec<PointsEnergy> = energies(problem, &[])?.into_iter().filter(used).collect();
        let noisy: Vec<PointsEnergy> = energies(problem, effects)?.into_iter().filter(used).collect();
        let deviation = noisy.iter().map(|e| e.deviation.hypot(ALLOWANCE * e.input).max(f64::MIN_POSITIVE));
        Ok(Self {
            structure: problem.structure,
            missing: plain.iter().map(|e| e.input - e.taken).collect(),
            input: plain.iter().map(|e| e.input).collect(),
            deviation: deviation.collect(),
            runs: data.runs,
        })
    }

    fn weighted(&self) -> Vec<f64> {
        self.missing.iter().zip(&self.deviation).map(|(e, d)| e / d).collect()
    }

    fn energies(&self, source: &Source) -> Vec<f64> {
        let of = |run: &RunData| taken(self.structure, source, run.omega, &|dof| displacement(run, dof));
        self.runs.iter().map(of).collect()
    }

    fn columns(&self) -> Vec<Column> {
        let ground = (0..self.structure.len()).map(|dof| vec![dof]);
        let pairs = self.structure.neighbours().into_iter().map(|pair| pair.to_vec());
        let mut columns = Vec::new();
        for dofs in ground.chain(pairs) {
            let Some(range) = self.range(&dofs) else { continue };
            for effect in Effect::ALL.into_iter().filter(|e| e.law().is_some() && e.dissipates()) {
                for parameters in shapes(effect, &range) {
                    let source = Source { effect, place: Place::Dofs(dofs.clone()), state: State::Known, parameters };
                    let weighted: Vec<f64> =
                        self.energies(&source).iter().zip(&self.deviation).map(|(e, d)| e / d).collect();
                    if weighted.iter().all(|w| w.is_finite()) && weighted.iter().any(|w| *w > 0.0) {
                        columns.push(Column { source, weighted });
                    }
                }
            }
        }
        columns
    }

    /// Range of the motion at a place; none where nothing moves.
    fn range(&self, dofs: &[usize]) -> Option<Range> {
        let leg = Leg { first: dofs[0], second: dofs.get(1).copied() };
        let motions = self.runs.iter().map(|run| {
            let relative = |h: usize| leg.relative(|dof| displacement(run, dof)[h]);
            let harmonics: Vec<c64> = (0..run.harmonics).map(relative).collect();
            Motion::new(run.omega, 0.0, &harmonics, SAMPLES)
        });
        let range = super::law::range(&motions.collect::<Vec<_>>());
        (range.displacement > 0.0).then_some(range)
    }

    /// Relative error per run with `effects`.
    fn errors(&self, effects: &[Source]) -> Vec<f64> {
        let mut left = self.missing.clone();
        for effect in effects {
            left.iter_mut().zip(self.energies(effect)).for_each(|(l, e)| *l -= e);
        }
        left.iter().zip(&self.input).map(|(l, e)| if *e == 0.0 { 1.0 } else { (l / e).abs() }).collect()
    }

    fn fit(&self, effects: &[Source]) -> Fitted {
        let (variables, start) = Variables::new(effects);
        let Ok(descent) = descend(&mut OnEnergy { balance: self, variables: &variables }, &start, 20);
        let found = variables.effects(&descent.theta);
        let slopes = variables.slopes(&descent.theta);
        let mut deviations = descent.deviations().into_iter().zip(slopes).map(|(d, s)| d * s.abs());
        let added = found.iter().map(|source| {
            let own = deviations.by_ref().take(source.parameters.len()).collect();
            Added { source: source.clone(), deviations: own }
        });
        let added = added.collect();
        let error = root_mean_square(&self.errors(&found));
        let held_out = self.held_out(&found, &descent.residual, &descent.jacobian);
        Fitted { added, chi_square: descent.chi_square, parameters: variables.len(), error, held_out }
    }

    /// Error of each run by the linearised fit without it: the residual over one less its leverage.
    fn held_out(&self, effects: &[Source], residual: &[f64], jacobian: &Mat<f64>) -> f64 {
        let n = jacobian.ncols();
        let normal = transposed_product(jacobian.as_ref(), jacobian.as_ref());
        let identity = Mat::<f64>::identity(n, n);
        let Ok(inverse) = crate::math::least_squares::solve_symmetric(normal.as_ref(), identity.as_ref()) else {
            return root_mean_square(&self.errors(effects));
        };
        let errors: Vec<f64> = (0..residual.len())
            .map(|r| {
                let row = |i: usize, k: usize| jacobian[(r, i)] * inverse[(i, k)] * jacobian[(r, k)];
                let leverage: f64 = (0..n).map(|i| (0..n).map(|k| row(i, k)).sum::<f64>()).sum();
                let scale = if self.input[r] == 0.0 { 1.0 } else { self.input[r].abs() };
                residual[r] * self.deviation[r] / scale / (1.0 - leverage.min(0.9))
            })
            .collect();
        root_mean_square(&errors)
    }
}

/// Weighted difference of energies as a function of the variables.
struct OnEnergy<'a> {
    balance: &'a Balance<'a>,
    variables: &'a Variables,
}

impl Residual for OnEnergy<'_> {
    type Error = Infallible;

    fn residual(&mut self, theta: &[f64]) -> Result<Vec<f64>, Infallible> {
        let mut left = self.balance.missing.clone();
        for effect in self.variables.effects(theta) {
            left.iter_mut().zip(self.balance.energies(&effect)).for_each(|(l, e)| *l -= e);
        }
        Ok(left.iter().zip(&self.balance.deviation).map(|(l, d)| l / d).collect())
    }

    fn jacobian(&mut self, theta: &[f64], at: &[f64]) -> Result<Mat<f64>, Infallible> {
        let step = 1e-5;
        let mut jacobian = Mat::zeros(at.len(), theta.len());
        for k in 0..theta.len() {
            let mut moved = theta.to_vec();
            moved[k] += step;
            let Ok(after) = self.residual(&moved);
            for (r, (a, b)) in after.iter().zip(at).enumerate() {
                jacobian[(r, k)] = (a - b) / step;
            }
        }
        Ok(jacobian)
    }
}

/// Squared residual and scales of one column or two with non-negative scales; none if a scale is not positive.
fn solve(columns: &[&Column], e: &[f64]) -> Option<(f64, Vec<f64>)> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let total = dot(e, e);
    match columns {
        [a] => {
            let s = dot(&a.weighted, e) / dot(&a.weighted, &a.weighted);
            (s > 0.0).then(|| (total - s * dot(&a.weighted, e), vec![s]))
        }
        [a, b] => {
            let (aa, bb, ab) =
                (dot(&a.weighted, &a.weighted), dot(&b.weighted, &b.weighted), dot(&a.weighted, &b.weighted));
            let (ae, be) = (dot(&a.weighted, e), dot(&b.weighted, e));
            let determinant = aa * bb - ab * ab;
            if determinant <= 1e-9 * aa * bb {
                return None;
            }
            let (s, t) = ((ae * bb - be * ab) / determinant, (be * aa - ae * ab) / determinant);
            (s > 0.0 && t > 0.0).then(|| (total - s * ae - t * be, vec![s, t]))
        }
        _ => None,
    }
}

/// Diagnoses a `points` problem.
pub(crate) fn diagnose(problem: &Problem, control: &Control) -> Result<Diagnosis, ExplainError> {
    let first = Balance::new(problem, &[])?;
    let best = climb(&first, control)?;
    // The noise of the motion counts once it is known how much energy the new sources take.
    let effects: Vec<Source> =
        best.last().map(|r| r[0].added.iter().map(|a| a.source.clone()).collect()).unwrap_or_default();
    let balance = Balance::new(problem, &effects)?;
    let rungs = climb(&balance, control)?;
    Ok(conclude(&balance, &rungs))
}

fn climb(balance: &Balance, control: &Control) -> Result<Vec<Vec<Fitted>>, ExplainError> {
    let e = balance.weighted();
    let n = e.len();
    let mut last = (e.iter().map(|x| x * x).sum::<f64>(), 0);
    let columns = if agrees(last.0, n, 0) { Vec::new() } else { balance.columns() };
    let mut rungs: Vec<Vec<Fitted>> = Vec::new();
    for count in 1..=2 {
        control.check()?;
        if agrees(last.0, n, last.1) || columns.is_empty() {
            break;
        }
        let fits = ranked(balance, &drafts(&columns, &e, count), n);
        let Some(best) = fits.first() else { break };
        let scale = (best.chi_square / (n - best.parameters).max(1) as f64).max(1.0);
        let penalty = (best.parameters as f64 - last.1 as f64) * (n as f64).ln();
        if (last.0 - best.chi_square) / scale - penalty < EVIDENCE {
            break;
        }
        last = (best.chi_square, best.parameters);
        rungs.push(fits);
    }
    Ok(rungs)
}

/// Whether a squared residual is that of noise.
fn agrees(chi_square: f64, n: usize, parameters: usize) -> bool {
    let freedom = n.saturating_sub(parameters) as f64;
    chi_square <= 1.15 * (freedom + 3.0 * (2.0 * freedom).sqrt())
}

/// The best sets of one column or two, with one shape a law and place.
fn drafts(columns: &[Column], e: &[f64], count: usize) -> Vec<Vec<Source>> {
    let mut found: Vec<(f64, Vec<usize>, Vec<f64>)> = Vec::new();
    let mut consider = |set: Vec<usize>| {
        let chosen: Vec<&Column> = set.iter().map(|&k| &columns[k]).collect();
        if let Some((chi, scales)) = solve(&chosen, e) {
            let parameters: usize = chosen.iter().map(|c| c.source.parameters.len()).sum();
            found.push((bayesian_information(chi, parameters, e.len()), set, scales));
            if found.len() > 4000 {
                found.sort_by(|a, b| a.0.total_cmp(&b.0));
                found.truncate(400);
            }
        }
    };
    for i in 0..columns.len() {
        if count == 1 {
            consider(vec![i]);
        } else {
            for j in i + 1..columns.len() {
                if !columns[i].source.is_same(&columns[j].source) {
                    consider(vec![i, j]);
                }
            }
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut sets: Vec<Vec<Source>> = Vec::new();
    for (_, set, scales) in found {
        let sources: Vec<Source> = set.iter().zip(&scales).map(|(&k, &s)| grown(&columns[k].source, s)).collect();
        let seen = |other: &Vec<Source>| other.iter().zip(&sources).all(|(a, b)| a.is_same(b));
        if !sets.iter().any(seen) {
            sets.push(sources);
        }
        if sets.len() == REFITS {
            break;
        }
    }
    sets
}

fn grown(source: &Source, scale: f64) -> Source {
    let mut source = source.clone();
    scaled(source.effect).iter().for_each(|&k| source.parameters[k] *= scale);
    source
}

fn ranked(balance: &Balance, drafts: &[Vec<Source>], n: usize) -> Vec<Fitted> {
    let enough = |f: &Fitted| f.parameters < n && f.chi_square.is_finite();
    let mut fits: Vec<Fitted> = drafts.iter().map(|d| balance.fit(d)).filter(enough).collect();
    fits.sort_by(|a, b| criterion(a, n).total_cmp(&criterion(b, n)));
    fits
}

fn criterion(fit: &Fitted, n: usize) -> f64 {
    bayesian_information(fit.chi_square, fit.parameters, n)
}

fn conclude(balance: &Balance, rungs: &[Vec<Fitted>]) -> Diagnosis {
    let n = balance.missing.len();
    let before = root_mean_square(&balance.errors(&[]));
    let relative = balance.deviation.iter().zip(&balance.input).map(|(d, e)| d / e.abs().max(f64::MIN_POSITIVE));
    let mut diagnosis = Diagnosis {
        error_before: before,
        noise_floor: root_mean_square(&relative.collect::<Vec<_>>()),
        verdict: Verdict::Adequate,
        suggestions: Vec::new(),
        steps: vec![Step { added: Vec::new(), error: before }],
        next_test: Vec::new(),
        corrections: Vec::new(),
    };
    let (Some(first), Some(top)) = (rungs.first(), rungs.last()) else {
        let e = balance.weighted();
        if !agrees(e.iter().map(|x| x * x).sum(), n, 0) {
            diagnosis.verdict = Verdict::Undecided;
        }
        return diagnosis;
    };
    diagnosis.steps.extend(rungs.iter().map(|r| Step { added: r[0].added.clone(), error: r[0].error }));
    let weights = evidence_weights(&top.iter().map(|f| criterion(f, n)).collect::<Vec<_>>());
    for fit in top {
        for added in &fit.added {
            if diagnosis.suggestions.iter().any(|s| s.added.source.is_same(&added.source))
                || diagnosis.suggestions.len() >= 8
            {
                continue;
            }
            let with = top.iter().zip(&weights).filter(|(f, _)| contains(f, &added.source));
            let probability = with.map(|(_, w)| w).sum::<f64>().min(1.0);
            let alone = first.iter().find(|f| contains(f, &added.source)).unwrap_or(fit);
            diagnosis.suggestions.push(Suggestion {
                added: added.clone(),
                error_after: alone.error,
                held_out_error_after: alone.held_out,
                probability,
                evidence: sentences(added, before, alone.error),
                indistinguishable_from: alike(top, &added.source),
            });
        }
    }
    let sure = diagnosis.suggestions.first().is_some_and(|s| s.probability >= 0.5);
    diagnosis.verdict = if sure { Verdict::Missing } else { Verdict::Undecided };
    diagnosis
}

fn contains(fit: &Fitted, source: &Source) -> bool {
    fit.added.iter().any(|a| a.source.is_same(source))
}

fn alike(top: &[Fitted], source: &Source) -> Vec<Source> {
    let mut found: Vec<Source> = Vec::new();
    for fit in top.iter().filter(|f| f.chi_square - top[0].chi_square < ALIKE) {
        let fresh: Vec<&Source> = fit.added.iter().map(|a| &a.source).filter(|s| !contains(&top[0], s)).collect();
        if let [other] = fresh[..]
            && contains(&top[0], source)
            && !contains(fit, source)
            && !found.iter().any(|f| f.is_same(other))
        {
            found.push(other.clone());
        }
    }
    found
}

fn sentences(added: &Added, before: f64, after: f64) -> Vec<String> {
    vec![
        added.source.effect.sentence().to_string(),
        super::evidence::values(&added.source, &added.deviations),
        format!("The error of the energy falls from {:.3} % to {:.3} %.", 100.0 * before, 100.0 * after),
        "Without mass and stiffness only the energy of each run can be compared.".to_string(),
    ]
}
