//! Sources too small to be told from the errors of model and sensors.
//!
//! Deviations are those of noise. Lines of frequency responses, or long records, have so little of it that what a model a
//! per cent off leaves in the expansion of the motion stands out, and a further source takes it up: one that carries next to
//! none of the energy anywhere. What no run shows to half a per cent of its energy, `|G_rj c_j| < 0.005 sum_k |G_rk c_k|` in
//! all rows `r`, is not taken: accelerometers and force cells are flat over frequency to no better than one per cent.

use super::outcome::SelectionStep;
use super::problem::Problem;
use super::search::SizeRanking;
use super::solve::Fit;
use super::state::IdentificationState;
use super::system::System;
use crate::balance::Weights;
use crate::math::numerals::counted;
use crate::math::subsets::RankedSet;

/// Share of the energy of a run that a source must carry in one of them at least.
const LEAST_SHARE: f64 = 5e-3;

/// Index of the smaller best set in `rankings` that is the accepted one without sources that carry next to no energy in any run,
/// and how that is said; none where there is none. Forced sources stay.
pub(super) fn without_negligible(
    problem: &Problem<'_>,
    state: &IdentificationState,
    rankings: &[SizeRanking],
    accepted: usize,
) -> Option<(usize, String)> {
    let energy = System::energy(problem, state, Weights::None);
    let best = rankings[accepted].best();
    let small =
        |column: &usize| !problem.forced.contains(column) && largest_share(&energy, best, *column) < LEAST_SHARE;
    let (negligible, kept): (Vec<usize>, Vec<usize>) = best.columns.iter().copied().partition(small);
    let smaller = rankings[..accepted].iter().position(|ranking| ranking.best().columns == kept)?;
    let names: Vec<String> = negligible.iter().map(|&j| problem.columns[j].phrase(problem.structure)).collect();
    let reason = format!(
        "{}; {} would bring the residual nearer to the noise, but carries less than 0.5 % of the energy in every run, \
         less than model and sensors are true to",
        counted(kept.len(), "source"),
        names.join(" with ")
    );
    Some((smaller, reason))
}

/// Puts the best set of a size first that the rule of `keep` forbids, where the best of a larger size is that set and sources of
/// next to no energy: such sources are there for the rule alone, which asks for one of the columns that are best by themselves.
pub(super) fn lift_the_rule(problem: &Problem<'_>, state: &IdentificationState, rankings: &mut [SizeRanking]) {
    if !problem.is_noisy() {
        return;
    }
    let energy = System::energy(problem, state, Weights::None);
    for k in 1..rankings.len() {
        let (smaller, larger) = rankings.split_at_mut(k);
        let next = larger[0].best();
        let carries = |j: &usize| largest_share(&energy, next, *j) >= LEAST_SHARE;
        let kept: Vec<usize> = next.columns.iter().copied().filter(carries).collect();
        let forbidden =
            |ranking: &&mut SizeRanking| ranking.best_of_all.as_ref().is_some_and(|set| set.columns == kept);
        if let Some(ranking) = smaller.iter_mut().find(forbidden) {
            ranking.sets.splice(0..0, ranking.best_of_all.take());
        }
    }
}

/// Adds to the covariance of the accepted set what its coefficients `c` differ by from those beside the negligible sources,
/// `(c - c') (c - c')^T`: an error of the model that noise says nothing of.
pub(super) fn widen(fit: &mut Fit, accepted: &mut SelectionStep, larger: &SelectionStep) {
    let beside = |source: usize| larger.sources.iter().find(|e| e.source == source).map(|e| e.coefficient);
    let moved: Vec<f64> =
        accepted.sources.iter().map(|e| beside(e.source).map_or(0.0, |there| e.coefficient - there)).collect();
    for (i, estimate) in accepted.sources.iter_mut().enumerate() {
        for (j, other) in moved.iter().enumerate() {
            fit.covariance[(i, j)] += moved[i] * other;
        }
        fit.deviations[i] = fit.deviations[i].hypot(moved[i]);
        estimate.deviation = fit.deviations[i];
    }
}

/// Largest share of the energy of a row that column `column` of the set carries, over all rows.
fn largest_share(energy: &System, set: &RankedSet, column: usize) -> f64 {
    let share = |row: usize| {
        let carried = |(&j, c): (&usize, &f64)| (energy.a[(row, j)] * c).abs();
        let all: f64 = set.columns.iter().zip(&set.coefficients).map(carried).sum();
        let own: f64 = set.columns.iter().zip(&set.coefficients).filter(|(j, _)| **j == column).map(carried).sum();
        if all > 0.0 { own / all } else { 0.0 }
    };
    (0..energy.rows()).map(share).fold(0.0, f64::max)
}
