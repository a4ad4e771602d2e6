//! The best sets of each size.
//!
//! The thesis' search (4.2.4): with `keep` > 0 every set holds at least one of the `keep` columns that are best alone, with
//! positive coefficients only; forced columns are in every set. Where sets are few, all are looked at; else branch and bound
//! proves the best. Beside them the best set without the `keep` rule, where it is another one.

use super::error::IdentifyError;
use super::problem::Problem;
use super::promising::promising;
use super::system::System;
use crate::control::Control;
use crate::math::subsets::{RankedSet, Ranking, SubsetProblem, branch_and_bound, combinations, exhaustive};
use faer::Mat;

/// Sets up to which all are looked at.
const FEW: f64 = 500.0;
/// Sets of one size up to which the search goes on for the history alone.
const MANY: f64 = 200_000.0;
/// Nodes of the tree after which the proof is given up.
const NODES: u64 = 400_000;
/// Columns up to which all those nodes are affordable; among more a node costs more and a proof is farther off, so that their
/// number falls with the fourth power of the columns (200 columns: 10 000 nodes, seconds a size in place of minutes).
const AFFORDABLE: f64 = 80.0;
/// The same for sets of more than [`LARGE`] sources, where a proof is out of reach in most cases and each node costs more.
const NODES_LARGE: u64 = 40_000;
/// The same among the most promising of very many columns, where nothing is proved for all of them anyway.
const NODES_AMONG: u64 = 40;
/// Sources up to which a set is not large.
const LARGE: usize = 8;
/// Sets asked for of one size where the `keep` rule applies, so that some remain.
const ASKED: usize = 30;
/// Sets reported of one size.
const REPORTED: usize = 10;

/// The best sets of one size.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SizeRanking {
    /// Best first; columns are those of the problem. Never empty.
    pub sets: Vec<RankedSet>,
    /// The best without the `keep` rule, where it differs from the first of `sets`.
    pub best_of_all: Option<RankedSet>,
    /// Whether the best is proved to be the best of all that the rules allow.
    pub proved: bool,
    /// Sets or nodes looked at.
    pub looked_at: u64,
}

impl SizeRanking {
    /// The best set.
    pub(super) fn best(&self) -> &RankedSet {
        &self.sets[0]
    }
}

/// The best sets of each size from the smallest to the largest that the settings and the data allow. Sizes of which there are
/// more than [`MANY`] sets are not looked at once `decided` says that they would change nothing.
pub(crate) fn search(
    problem: &Problem<'_>,
    system: &System,
    decided: &dyn Fn(&[SizeRanking]) -> bool,
    control: &Control,
) -> Result<Vec<SizeRanking>, IdentifyError> {
    let chosen = promising(system, &problem.forced)?;
    let (reduced, b) = system.compressed(&chosen);
    let forced: Vec<usize> = problem.forced.iter().filter_map(|f| chosen.iter().position(|c| c == f)).collect();
    let least = forced.len().max(1);
    let most = problem.settings.max_sources.min(chosen.len()).min(system.rows());
    let task = Task {
        a: &reduced,
        b: &b,
        forced: &forced,
        // Of very many columns those that are best alone are neighbours of one place, which need not be a source.
        keep: if chosen.len() == system.a.ncols() { problem.settings.keep } else { 0 },
        all: chosen.len() == system.a.ncols(),
    };
    let singles = task.singles(control)?;
    let mut rankings: Vec<SizeRanking> = Vec::new();
    for size in least..=most {
        control.check()?;
        if combinations(chosen.len() - forced.len(), size - forced.len()) > MANY && decided(&rankings) {
            break;
        }
        if let Some(mut ranking) = task.of_size(size, &singles, control)? {
            let rename = |set: &mut RankedSet| set.columns.iter_mut().for_each(|j| *j = chosen[*j]);
            ranking.sets.iter_mut().for_each(rename);
            ranking.best_of_all.iter_mut().for_each(rename);
            let exact = ranking.best().angle < 1e-9;
            rankings.push(ranking);
            if exact {
                break;
            }
        }
    }
    if rankings.is_empty() { Err(IdentifyError::NothingFits) } else { Ok(rankings) }
}

/// Nodes of the tree that a search among so many columns may take.
fn affordable(columns: usize) -> u64 {
    let share = (AFFORDABLE / columns.max(1) as f64).min(1.0).powi(4);
    (share * NODES as f64) as u64
}

/// The search among given columns.
struct Task<'a> {
    a: &'a Mat<f64>,
    b: &'a [f64],
    forced: &'a [usize],
    keep: usize,
    /// Whether these are all columns of the problem.
    all: bool,
}

impl Task<'_> {
    /// Columns in the order of how well each does alone.
    fn singles(&self, control: &Control) -> Result<Vec<usize>, IdentifyError> {
        let ranking = self.run(self.a, 1, &[], self.a.ncols(), control)?;
        Ok(ranking.sets.into_iter().map(|set| set.columns[0]).collect())
    }

    fn run(
        &self,
        a: &Mat<f64>,
        size: usize,
        forced: &[usize],
        keep: usize,
        control: &Control,
    ) -> Result<Ranking, IdentifyError> {
        let node_limit = match size {
            _ if !self.all => NODES_AMONG,
            1..=LARGE => affordable(a.ncols()),
            _ => NODES_LARGE,
        };
        let problem = SubsetProblem { a: a.as_ref(), b: self.b, size, keep, forced, node_limit };
        let sets = combinations(a.ncols() - forced.len(), size - forced.len());
        Ok(if sets <= FEW { exhaustive(&problem, control)? } else { branch_and_bound(&problem, control)? })
    }

    fn of_size(&self, size: usize, singles: &[usize], control: &Control) -> Result<Option<SizeRanking>, IdentifyError> {
        let asked = if self.keep == 0 { REPORTED } else { ASKED };
        let ranking = self.run(self.a, size, self.forced, asked, control)?;
        let (mut proved, mut looked_at) = (ranking.proved, ranking.nodes);
        let kept: Vec<usize> = singles.iter().copied().filter(|j| !self.forced.contains(j)).take(self.keep).collect();
        let allowed = |set: &RankedSet| {
            self.keep == 0 || size == self.forced.len() || set.columns.iter().any(|j| kept.contains(j))
        };
        let best_of_all = ranking.sets.first().cloned();
        let mut sets: Vec<RankedSet> = ranking.sets.into_iter().filter(allowed).collect();
        if sets.is_empty() {
            for &j in &kept {
                let mut forced = self.forced.to_vec();
                forced.push(j);
                let part = self.run(self.a, size, &forced, REPORTED, control)?;
                proved &= part.proved;
                looked_at += part.nodes;
                sets.extend(part.sets.into_iter().filter(|s| s.coefficients.iter().all(|c| *c > 0.0)));
            }
            sets.sort_by(|x, y| x.residual_norm.total_cmp(&y.residual_norm));
            sets.dedup_by(|x, y| x.columns == y.columns);
        }
        sets.truncate(REPORTED);
        let Some(first) = sets.first() else { return Ok(None) };
        let best_of_all = best_of_all.filter(|best| best.columns != first.columns);
        Ok(Some(SizeRanking { best_of_all, sets, proved: proved && self.all, looked_at }))
    }
}
