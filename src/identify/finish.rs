//! Puts the outcome together from what the passes found.

use super::error::IdentifyError;
use super::found::Found;
use super::negligible::widen;
use super::outcome::{Estimate, Outcome, RankedAlternative, RecordOutcome, RunOutcome, SelectionStep, WindowOutcome};
use super::problem::Problem;
use super::results::{self, ResultsInput};
use super::search::SizeRanking;
use super::stopping::{angle_deg, penalty};
use super::system::System;
use super::{collinear, solve, warnings};
use crate::balance::windows::WindowRows;
use crate::balance::{action, weights};
use crate::math::subsets::RankedSet;

/// Builds the outcome.
pub(super) fn outcome(problem: &Problem<'_>, found: &Found) -> Result<Outcome, IdentifyError> {
    let energy = System::energy(problem, &found.state, problem.settings.weights);
    let known: Vec<Vec<f64>> = known_energies(problem, found);
    let builder = OutcomeBuilder { problem, found, energy: &energy, known: &known };
    let mut steps = Vec::new();
    for ranking in &found.rankings {
        steps.push(builder.step(ranking)?);
    }
    let accepted = found.decision.accepted;
    let set = found.rankings[accepted].best().columns.clone();
    let mut fit = solve::fit(&found.system, &set)?;
    if let Some(larger) = found.decision.larger {
        let larger = steps[larger].clone();
        widen(&mut fit, &mut steps[accepted], &larger);
    }
    let mut sources = steps[accepted].sources.clone();
    sources.extend(builder.known_sources(&set, &fit.coefficients));
    let coefficients = solve::scattered(problem.columns.len(), &set, &fit.coefficients);
    let acting = problem.acting(&coefficients);
    let input = ResultsInput {
        structure: problem.structure,
        runs: &found.state.runs,
        acting: &acting,
        columns: set.iter().map(|&j| problem.columns[j].clone()).collect(),
        covariance: &fit.covariance,
    };
    let k = set.len();
    Ok(Outcome {
        status: found.decision.status,
        reason: found.decision.reason.clone(),
        form: found.form,
        expansion: problem.expander.method(),
        weights: weights::resolve(problem.settings.weights, &found.state.runs),
        model_error: found.state.model_error,
        runs: builder.runs(&steps[accepted], &acting),
        records: builder.records(&steps[accepted]),
        collinear: collinear::groups(problem, found),
        warnings: warnings::all(problem, found, &fit, &set),
        results: results::results(&input),
        covariance: (0..k).map(|i| (0..k).map(|j| fit.covariance[(i, j)]).collect()).collect(),
        steps,
        accepted,
        sources,
    })
}

/// Energy of each known source (rows) in each run (columns), J.
fn known_energies(problem: &Problem<'_>, found: &Found) -> Vec<Vec<f64>> {
    let energies_of = |source| {
        let run = |(m, e): &(crate::balance::Measured, crate::balance::Expanded)| {
            action::energy(source, problem.structure, e.field(m))
        };
        found.state.runs.iter().map(run).collect::<Vec<f64>>()
    };
    let with_windows = |(k, source)| energies_of(source).into_iter().chain(problem.windows.known(k)).collect();
    problem.known.iter().enumerate().map(with_windows).collect()
}

struct OutcomeBuilder<'a> {
    problem: &'a Problem<'a>,
    found: &'a Found,
    energy: &'a System,
    known: &'a [Vec<f64>],
}

impl OutcomeBuilder<'_> {
    fn step(&self, ranking: &SizeRanking) -> Result<SelectionStep, IdentifyError> {
        let (problem, system, equation) = (self.problem, &self.found.system, &self.found.state.equation);
        let columns = &ranking.best().columns;
        let fit = solve::fit(system, columns)?;
        let identified = equation.identified(columns, &fit.coefficients);
        let error = identified.iter().zip(&equation.e).map(|(g, e)| (g - e).powi(2)).sum::<f64>().sqrt();
        let size = equation.e.iter().map(|e| e * e).sum::<f64>().sqrt();
        let taken: f64 = self.taken(&identified);
        let estimate = |(k, &j): (usize, &usize)| Estimate {
            source: problem.column_source[j],
            coefficient: fit.coefficients[k],
            deviation: fit.deviations[k],
            energy_percent: percent(equation.identified(&[j], &[fit.coefficients[k]]).iter().sum(), taken),
        };
        let (count, rows) = (columns.len(), system.rows());
        let criterion = problem.is_noisy().then(|| fit.chi_square + penalty(problem, count, rows));
        Ok(SelectionStep {
            count,
            sources: columns.iter().enumerate().map(estimate).collect(),
            angle_deg: angle_deg(self.energy, columns, &fit.coefficients),
            relative_error: if size > 0.0 { error / size } else { 0.0 },
            identified_energy: self.with_known(&identified),
            chi_square: fit.chi_square,
            freedom: rows.saturating_sub(count),
            criterion,
            held_out: solve::held_out(system, columns).map(f64::sqrt),
            condition: fit.condition,
            alternatives: ranking.sets[1..].iter().map(|set| self.alternative(set)).collect(),
            best_of_all: ranking.best_of_all.as_ref().map(|set| self.alternative(set)),
            proved: ranking.proved,
            looked_at: ranking.looked_at,
        })
    }

    fn alternative(&self, set: &RankedSet) -> RankedAlternative {
        RankedAlternative {
            sources: set.columns.iter().map(|&j| self.problem.column_source[j]).collect(),
            coefficients: set.coefficients.clone(),
            angle_deg: angle_deg(self.energy, &set.columns, &set.coefficients),
            chi_square: self.found.system.chi_square(&set.columns, &set.coefficients),
        }
    }

    fn with_known(&self, identified: &[f64]) -> Vec<f64> {
        let known = |r: usize| self.known.iter().map(|energies| energies[r]).sum::<f64>();
        identified.iter().enumerate().map(|(r, e)| e + known(r)).collect()
    }

    /// Energy taken out over all runs, J.
    fn taken(&self, identified: &[f64]) -> f64 {
        self.with_known(identified).iter().sum()
    }

    fn known_sources(&self, set: &[usize], coefficients: &[f64]) -> Vec<Estimate> {
        let taken = self.taken(&self.found.state.equation.identified(set, coefficients));
        let estimate = |(k, &source): (usize, &usize)| Estimate {
            source,
            coefficient: self.problem.known[k].coefficient(),
            deviation: 0.0,
            energy_percent: percent(self.known[k].iter().sum(), taken),
        };
        self.problem.known_source.iter().enumerate().map(estimate).collect()
    }

    fn records(&self, step: &SelectionStep) -> Vec<RecordOutcome> {
        let mut next = self.found.state.runs.len();
        let windows = &self.problem.windows;
        let record_outcome = |(&record, rows): (&usize, &WindowRows)| {
            let first = next;
            next += rows.len();
            let window = |k: usize| WindowOutcome {
                span_s: rows.span_s[k],
                input_energy: rows.input[k],
                released_energy: rows.released[k],
                stored_energy: rows.stored[k],
                identified_energy: step.identified_energy[first + k],
                deviation: rows.covariance[(k, k)].max(0.0).sqrt(),
            };
            RecordOutcome {
                record,
                windows: (0..rows.len()).map(window).collect(),
                modes: rows.modes.iter().map(|r| r + 1).collect(),
                dominant: rows.dominant + 1,
                corner_hz: rows.corner_hz,
            }
        };
        windows.record.iter().zip(&windows.rows).map(record_outcome).collect()
    }

    fn runs(&self, step: &SelectionStep, acting: &[crate::effects::Source]) -> Vec<RunOutcome> {
        let (problem, state) = (self.problem, &self.found.state);
        let run_outcome =
            |(r, (measured, expanded)): (usize, &(crate::balance::Measured, crate::balance::Expanded))| {
                let noise = if measured.noisy {
                    weights::residual_deviation(problem.structure, measured, expanded, acting)
                } else {
                    0.0
                };
                let known = |i: &usize| expanded.known[*i];
                let square = |i: usize| expanded.x[(i, 0)].norm_sqr();
                let rows: Vec<usize> = (0..expanded.known.len()).filter(known).collect();
                let size: f64 = rows.iter().map(|&i| square(i)).sum();
                let error: f64 = rows.iter().map(|&i| 2.0 * expanded.deviation[(i, 0)].powi(2)).sum();
                RunOutcome {
                    run: problem.run_index[r],
                    input_energy: state.equation.input[r],
                    energy_deviation: noise,
                    identified_energy: step.identified_energy[r],
                    misfit: expanded.misfit,
                    relative_misfit: expanded.relative_misfit,
                    expansion_error: if size > 0.0 { (error / size).sqrt() } else { 0.0 },
                    harmonics: measured.numbers.clone(),
                }
            };
        state.runs.iter().enumerate().map(run_outcome).collect()
    }
}

fn percent(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { 100.0 * part / whole } else { 0.0 }
}
