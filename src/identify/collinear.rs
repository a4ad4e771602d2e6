//! Columns so alike that the data cannot tell them apart: each accepted source is exchanged for every other column, and
//! where the residual hardly grows the two are named together.

use super::outcome::Collinear;
use super::{Found, problem::Problem, solve, stopping};

/// Growth of chi-square up to which two sets are not told apart (two deviations).
const ALIKE: f64 = 4.0;
/// Most columns that are tried.
const MOST: usize = 400;

/// Sources that could stand in the place of each accepted one.
pub(super) fn groups(problem: &Problem<'_>, found: &Found) -> Vec<Collinear> {
    let set = &found.rankings[found.decision.accepted].best().columns;
    let n = problem.columns.len().min(MOST);
    let mut groups = Vec::new();
    for (place, &own) in set.iter().enumerate() {
        let mut others: Vec<(usize, f64)> = (0..n)
            .filter(|j| !set.contains(j))
            .filter_map(|j| {
                let mut exchanged = set.clone();
                exchanged[place] = j;
                growth(problem, found, set, &exchanged).map(|g| (problem.column_source[j], g))
            })
            .collect();
        others.sort_by(|a, b| a.1.total_cmp(&b.1));
        if !others.is_empty() {
            groups.push(Collinear { source: problem.column_source[own], others });
        }
    }
    groups
}

/// How much worse the exchanged set is, if that is little.
fn growth(problem: &Problem<'_>, found: &Found, set: &[usize], exchanged: &[usize]) -> Option<f64> {
    let (before, after) = (solve::fit(&found.system, set).ok()?, solve::fit(&found.system, exchanged).ok()?);
    if problem.is_noisy() {
        let scale = (before.chi_square / solve::freedom(found.system.rows(), set.len()) as f64).max(1.0);
        let growth = (after.chi_square - before.chi_square) / scale;
        return (growth < ALIKE).then_some(growth);
    }
    let angle = |set: &[usize], c: &[f64]| stopping::angle_deg(&found.system, set, c);
    let (old, new) = (angle(set, &before.coefficients), angle(exchanged, &after.coefficients));
    (new < problem.settings.stop_angle_deg && new < 2.0 * old.max(1e-6)).then_some(new - old)
}
