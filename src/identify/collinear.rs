//! Columns so alike that the data cannot tell them apart: each accepted source is exchanged for every other column, and
//! where the residual hardly grows the two are named together.

use super::outcome::Collinear;
use super::system::System;
use super::{found::Found, problem::Problem, solve, stopping};

/// Growth of chi-square up to which two sets are not told apart (two deviations).
const ALIKE: f64 = 4.0;
/// Most columns that are tried in the place of one: the ones most nearly parallel to it.
const MOST: usize = 400;

/// Sources that could stand in the place of each accepted one.
pub(super) fn groups(problem: &Problem<'_>, found: &Found) -> Vec<Collinear> {
    let set = &found.rankings[found.decision.accepted].best().columns;
    let Ok(before) = solve::coefficients(&found.system, set) else { return Vec::new() };
    let mut groups = Vec::new();
    for (place, &own) in set.iter().enumerate() {
        let near = nearest(&found.system, own, set);
        let found = problem.control.map(near.len(), |k| {
            let mut exchanged = set.clone();
            exchanged[place] = near[k];
            growth(problem, found, (set, &before), &exchanged).map(|g| (problem.column_source[near[k]], g))
        });
        let mut others: Vec<(usize, f64)> = found.into_iter().flatten().collect();
        others.sort_by(|a, b| a.1.total_cmp(&b.1));
        if !others.is_empty() {
            groups.push(Collinear { source: problem.column_source[own], others });
        }
    }
    groups
}

/// The columns outside of `set` that are most nearly parallel to column `own`.
fn nearest(system: &System, own: usize, set: &[usize]) -> Vec<usize> {
    let others = (0..system.a.ncols()).filter(|j| !set.contains(j));
    if system.a.ncols() <= MOST {
        return others.collect();
    }
    let column = system.a.col(own);
    let cosine = |j: usize| {
        let size = system.a.col(j).norm_l2();
        if size > 0.0 { (column.transpose() * system.a.col(j)) / size } else { 0.0 }
    };
    let mut order: Vec<(f64, usize)> = others.map(|j| (cosine(j), j)).collect();
    order.sort_by(|x, y| y.0.total_cmp(&x.0));
    order.into_iter().take(MOST).map(|(_, j)| j).collect()
}

/// How much worse the exchanged set is, if that is little.
fn growth(problem: &Problem<'_>, found: &Found, before: (&[usize], &[f64]), exchanged: &[usize]) -> Option<f64> {
    let system = &found.system;
    let after = (exchanged, solve::coefficients(system, exchanged).ok()?);
    if problem.is_noisy() {
        let old = system.chi_square(before.0, before.1);
        let scale = (old / solve::freedom(system.rows(), before.0.len()) as f64).max(1.0);
        let growth = (system.chi_square(after.0, &after.1) - old) / scale;
        return (growth < ALIKE).then_some(growth);
    }
    let (old, new) = (stopping::angle_deg(system, before.0, before.1), stopping::angle_deg(system, after.0, &after.1));
    (new < problem.settings.stop_angle_deg && new < 2.0 * old.max(1e-6)).then_some(new - old)
}
