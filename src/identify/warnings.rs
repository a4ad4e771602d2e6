//! What the user should know beside the answer.

use super::problem::Problem;
use super::{found::Found, solve};
use crate::balance::Expansion;
use crate::effects::Place;

/// Angle in degrees below which two laws at one place are parallel in practice.
const PARALLEL_DEG: f64 = 0.1;
/// Condition above which coefficients are hardly determined one by one.
const WORST_CONDITION: f64 = 1e3;

/// All warnings.
pub(super) fn all(problem: &Problem<'_>, found: &Found, fit: &solve::Fit, set: &[usize]) -> Vec<String> {
    let mut list = problem.warnings.clone();
    list.extend(single_mode(problem));
    list.extend(parallel_laws(problem, found));
    list.extend(few_runs(problem, found, set));
    list.extend(super::layouts::warning(problem, found, set.len()));
    list.extend(uncertain(problem, fit, set));
    if fit.condition > WORST_CONDITION {
        list.push(format!(
            "the accepted columns are nearly dependent (condition {:.1e}); their coefficients are far less certain than their sum",
            fit.condition
        ));
    }
    if found.rankings.iter().any(|r| !r.proved) {
        list.push("there are too many sets to look at; the best found are not proved to be the best".to_string());
    }
    list
}

/// Single-mode expansion says one thing a mode.
fn single_mode(problem: &Problem<'_>) -> Option<String> {
    let model = problem.expander.model().filter(|_| problem.expander.method() == Expansion::SingleMode)?;
    let mut modes: Vec<usize> =
        problem.measured.iter().filter_map(|m| model.by_distance(m.omega).first().copied()).collect();
    let runs = modes.len();
    modes.sort_unstable();
    modes.dedup();
    let laws: std::collections::BTreeSet<_> = problem.columns.iter().map(|c| c.effect).collect();
    (modes.len() < runs && laws.len() == 1).then(|| {
        format!(
            "single-mode expansion gives at most one equation a mode: {runs} runs excite {} modes; use expansion = \"dynamic\"",
            modes.len()
        )
    })
}

/// Two laws at one place whose columns are parallel: the runs hold no difference of amplitude.
fn parallel_laws(problem: &Problem<'_>, found: &Found) -> Vec<String> {
    let g = &found.state.equation.g;
    let mut list = Vec::new();
    for i in 0..problem.columns.len() {
        for j in 0..i {
            let (a, b) = (&problem.columns[i], &problem.columns[j]);
            if a.place != b.place || matches!(a.place, Place::Whole(_)) || g.nrows() < 2 {
                continue;
            }
            let dot = |p: usize, q: usize| (0..g.nrows()).map(|r| g[(r, p)] * g[(r, q)]).sum::<f64>();
            let cosine = dot(i, j) / (dot(i, i) * dot(j, j)).sqrt();
            if cosine.is_finite() && cosine.min(1.0).acos().to_degrees() < PARALLEL_DEG {
                let names = (b.phrase(problem.structure), a.phrase(problem.structure));
                list.push(format!(
                    "{} and {} cannot be told apart: they take out energy in the same proportion in every run; measure at another force level",
                    names.0, names.1
                ));
            }
        }
    }
    list.truncate(5);
    list
}

/// As many sources as equations explain anything.
fn few_runs(problem: &Problem<'_>, found: &Found, set: &[usize]) -> Option<String> {
    let runs = problem.equations();
    let other = found.rankings[found.decision.accepted].sets.get(1);
    (set.len() >= runs && other.is_some()).then(|| {
        format!(
            "{} sources from {runs} runs: other sets fit as well; measure more runs or name fewer candidates",
            set.len()
        )
    })
}

fn uncertain(problem: &Problem<'_>, fit: &solve::Fit, set: &[usize]) -> Vec<String> {
    set.iter()
        .enumerate()
        .filter(|&(k, _)| fit.coefficients[k] > 0.0 && fit.deviations[k] > 0.5 * fit.coefficients[k])
        .map(|(k, &j)| {
            format!(
                "{}: its standard deviation is {:.0} % of its value",
                problem.columns[j].phrase(problem.structure),
                100.0 * (fit.deviations[k] / fit.coefficients[k]).min(1e6)
            )
        })
        .collect()
}
