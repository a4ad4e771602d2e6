//! Where to stop: the smallest set whose residual is within the noise (chi-square), more only on strong evidence (the
//! Bayesian criterion, extended by the number of sets that were to choose from), confirmed by leaving out runs. Without
//! known noise the angle rules, as in the thesis.

use super::negligible::without_negligible;
use super::outcome::{Form, SelectionStatus};
use super::problem::Problem;
use super::search::SizeRanking;
use super::solve;
use super::state::IdentificationState;
use super::system::System;
use crate::balance::Weights;
use crate::math::numerals::{counted, significant};
use crate::math::statistics::chi_square_quantile;

/// Probability of a larger residual below which a set does not explain the data.
const REJECTED: f64 = 0.01;
/// Difference of the criterion that counts as strong evidence for one more source.
const STRONG: f64 = 6.0;

/// Which set is accepted, and why.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Decision {
    /// Index into the rankings.
    pub accepted: usize,
    pub status: SelectionStatus,
    pub reason: String,
    /// Index of the larger set that fits better by sources of next to no energy, which are not taken.
    pub larger: Option<usize>,
}

/// How well the best set of one size does.
struct Score {
    count: usize,
    chi_square: f64,
    freedom: usize,
    criterion: f64,
}

/// One pass of the search: the equations at one motion, on which the best sets of each size are judged.
pub(crate) struct Pass<'a, 'p> {
    pub problem: &'a Problem<'p>,
    pub state: &'a IdentificationState,
    pub system: &'a System,
    pub form: Form,
}

/// Sizes beyond the accepted one that must not earn their sources for larger ones not to be looked at.
const BEYOND: usize = 2;

impl Pass<'_, '_> {
    /// Decides among the best sets of each size.
    pub(crate) fn decide(&self, rankings: &[SizeRanking]) -> Decision {
        let (decision, rows) = (self.decided(rankings), self.system.rows());
        let count = rankings[decision.accepted].best().columns.len();
        if matches!(decision.status, SelectionStatus::AboveNoise | SelectionStatus::AboveAngle) || count < rows {
            return decision;
        }
        let reason = format!(
            "{} from {}: nothing is left to judge them by; measure more runs or name fewer candidates",
            counted(count, "source"),
            counted(rows, "equation")
        );
        Decision { status: SelectionStatus::NothingLeft, reason, ..decision }
    }

    /// Whether larger sets than those of `rankings` would change nothing: the accepted set is within the noise, or below the angle,
    /// and the best of the next sizes gain less than strong evidence asks for, less with each.
    pub(crate) fn is_decided(&self, rankings: &[SizeRanking]) -> bool {
        if rankings.is_empty() {
            return false;
        }
        let decision = self.decided(rankings);
        let accepted = decision.larger.unwrap_or(decision.accepted);
        match decision.status {
            // The first size below the angle is taken, whatever comes after it.
            SelectionStatus::BelowAngle => true,
            SelectionStatus::WithinNoise if rankings.len() > accepted + BEYOND => {
                let criteria: Vec<f64> =
                    rankings[accepted..].iter().map(|ranking| self.score(ranking).criterion).collect();
                criteria.windows(2).all(|pair| pair[1] > pair[0])
            }
            _ => false,
        }
    }

    fn decided(&self, rankings: &[SizeRanking]) -> Decision {
        let Self { problem, state, system, form } = *self;
        let angle_rules = problem.settings.weights == Weights::None || !problem.is_noisy();
        if angle_rules && form == Form::Energy || !problem.is_noisy() {
            return by_angle(problem, state, rankings, form);
        }
        let scores: Vec<Score> = rankings.iter().map(|r| self.score(r)).collect();
        let within = |k: usize| scores[k].chi_square <= chi_square_quantile(1.0 - REJECTED, scores[k].freedom);
        let decision = match (0..scores.len()).find(|&k| within(k)) {
            Some(first) => within_noise(system, rankings, &scores, first),
            None => above_noise(&scores),
        };
        let Some((accepted, reason)) = without_negligible(problem, state, rankings, decision.accepted) else {
            return decision;
        };
        let status = if within(accepted) { SelectionStatus::WithinNoise } else { SelectionStatus::AboveNoise };
        Decision { accepted, status, reason, larger: Some(decision.accepted) }
    }

    fn score(&self, ranking: &SizeRanking) -> Score {
        let best = ranking.best();
        let chi_square = self.system.chi_square(&best.columns, &best.coefficients);
        let (count, rows) = (best.columns.len(), self.system.rows());
        Score {
            count,
            chi_square,
            freedom: solve::freedom(rows, count),
            criterion: chi_square + penalty(self.problem, count, rows),
        }
    }
}

/// `k ln d + 2 ln (number of sets of size k)`: the extended Bayesian criterion of Chen and Chen (2008).
pub(crate) fn penalty(problem: &Problem<'_>, count: usize, rows: usize) -> f64 {
    let (free, chosen) = (problem.columns.len() - problem.forced.len(), count.saturating_sub(problem.forced.len()));
    count as f64 * (rows as f64).ln() + 2.0 * crate::math::subsets::combinations(free, chosen).max(1.0).ln()
}

fn within_noise(system: &System, rankings: &[SizeRanking], scores: &[Score], first: usize) -> Decision {
    let mut accepted = first;
    for k in first + 1..scores.len() {
        if scores[k].criterion < scores[accepted].criterion - STRONG {
            accepted = k;
        }
    }
    let score = &scores[accepted];
    let mut reason = format!(
        "{}: chi-square {:.3} with {} degrees of freedom, within the noise",
        counted(score.count, "source"),
        score.chi_square,
        score.freedom
    );
    if accepted > first {
        reason += "; more than the noise asks for, on strong evidence";
    }
    reason += &confirmation(system, rankings, accepted);
    Decision { accepted, status: SelectionStatus::WithinNoise, reason, larger: None }
}

/// What leaving out each run says of the accepted set against the next smaller one.
fn confirmation(system: &System, rankings: &[SizeRanking], accepted: usize) -> String {
    let error = |k: usize| solve::held_out(system, &rankings[k].best().columns);
    let Some(own) = error(accepted) else { return "; too few runs to leave one out".to_string() };
    let said = |square: f64| significant(square.sqrt(), 3);
    match accepted.checked_sub(1).and_then(error) {
        Some(before) if own < before => format!(
            "; confirmed by leaving out runs (their error falls from {} to {} deviations)",
            said(before),
            said(own)
        ),
        Some(before) => format!(
            "; leaving out runs does not confirm it (their error goes from {} to {} deviations)",
            said(before),
            said(own)
        ),
        None => format!("; left-out runs are met to {} deviations", said(own)),
    }
}

/// No set reaches the noise: the noise is taken from the best residual, and the criterion decides.
fn above_noise(scores: &[Score]) -> Decision {
    let scale = scores.iter().map(|s| s.chi_square / s.freedom as f64).fold(f64::INFINITY, f64::min).max(1.0);
    let criterion = |s: &Score| s.chi_square / scale + (s.criterion - s.chi_square);
    let accepted =
        (0..scores.len()).min_by(|&a, &b| criterion(&scores[a]).total_cmp(&criterion(&scores[b]))).unwrap_or(0);
    let reason = format!(
        "no set reaches the noise (residual {:.3} deviations at best); {} by the Bayesian criterion",
        scale.sqrt(),
        counted(scores[accepted].count, "source")
    );
    Decision { accepted, status: SelectionStatus::AboveNoise, reason, larger: None }
}

/// The first set below the angle of the settings, else the one with the smallest angle.
fn by_angle(problem: &Problem<'_>, state: &IdentificationState, rankings: &[SizeRanking], form: Form) -> Decision {
    let energy =
        if form == Form::Energy { None } else { Some(System::energy(problem, state, problem.settings.weights)) };
    let angle = |r: &SizeRanking| match &energy {
        None => r.best().angle.to_degrees(),
        Some(energy) => angle_deg(energy, &r.best().columns, &r.best().coefficients),
    };
    let limit = problem.settings.stop_angle_deg;
    if let Some(accepted) = rankings.iter().position(|r| angle(r) < limit) {
        let count = rankings[accepted].best().columns.len();
        let reason = format!(
            "{}: the angle of {} deg is below the limit of {limit} deg",
            counted(count, "source"),
            significant(angle(&rankings[accepted]), 3)
        );
        return Decision { accepted, status: SelectionStatus::BelowAngle, reason, larger: None };
    }
    let accepted =
        (0..rankings.len()).min_by(|&a, &b| angle(&rankings[a]).total_cmp(&angle(&rankings[b]))).unwrap_or(0);
    let best = rankings[accepted].best();
    let names: Vec<String> = best.columns.iter().map(|&j| problem.columns[j].phrase(problem.structure)).collect();
    let reason = format!(
        "no set of up to {} sources comes below the limit of {limit} deg; the nearest, {}, is at {} deg",
        problem.settings.max_sources,
        names.join(", "),
        significant(angle(&rankings[accepted]), 3)
    );
    Decision { accepted, status: SelectionStatus::AboveAngle, reason, larger: None }
}

/// Angle in degrees between `b` and `A_S c`: `asin(|A_S c - b| / |b|)`.
pub(crate) fn angle_deg(system: &System, columns: &[usize], coefficients: &[f64]) -> f64 {
    relative_residual(system, columns, coefficients).min(1.0).asin().to_degrees()
}

/// `|A_S c - b| / |b|`.
pub(crate) fn relative_residual(system: &System, columns: &[usize], coefficients: &[f64]) -> f64 {
    let (mut error, mut size) = (0.0, 0.0);
    for i in 0..system.rows() {
        let model: f64 = columns.iter().zip(coefficients).map(|(&j, c)| system.a[(i, j)] * c).sum();
        error += (model - system.b[i]).powi(2);
        size += system.b[i].powi(2);
    }
    if size > 0.0 { (error / size).sqrt() } else { 0.0 }
}
