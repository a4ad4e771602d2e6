//! The best sets of a given size for non-negative least squares: `min |A_S x - b|`, `x >= 0`, over sets S of columns.
//!
//! A set counts only if every free column in it has a positive coefficient: otherwise it is a smaller set in disguise.
//! [`exhaustive`] looks at every set; [`branch_and_bound`] proves the same answer without looking at most of them.

mod pairs;
mod relaxation;
mod search;

pub use search::branch_and_bound;

use super::nnls::{NnlsError, check, nnls, normalise};
use crate::control::{Cancelled, Control};
use faer::{Mat, MatRef};

/// Which sets to look for.
#[derive(Debug, Clone, Copy)]
pub struct SubsetProblem<'a> {
    /// Columns to choose from, m x n.
    pub a: MatRef<'a, f64>,
    /// Right-hand side, m values.
    pub b: &'a [f64],
    /// Number of columns in a set, forced ones included.
    pub size: usize,
    /// Number of sets to report, best first.
    pub keep: usize,
    /// Columns that are in every set; their coefficients may be zero.
    pub forced: &'a [usize],
    /// Nodes after which branch and bound gives up the proof and reports the best sets found so far.
    pub node_limit: u64,
}

/// A set of columns and how well it explains the right-hand side.
#[derive(Debug, Clone, PartialEq)]
pub struct RankedSet {
    /// Columns in ascending order.
    pub columns: Vec<usize>,
    /// Coefficient of each column.
    pub coefficients: Vec<f64>,
    /// `|A_S x - b|`.
    pub residual_norm: f64,
    /// Angle in rad between `b` and the cone of non-negative combinations of the columns: `asin(residual / |b|)`.
    pub angle: f64,
}

/// The best sets.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranking {
    /// Best first, no more than `keep`.
    pub sets: Vec<RankedSet>,
    /// Whether these are proved to be the best of all.
    pub proved: bool,
    /// Sets looked at (exhaustive) or nodes of the tree (branch and bound).
    pub nodes: u64,
}

/// Why there is no ranking.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum SubsetError {
    #[error(transparent)]
    Nnls(#[from] NnlsError),
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error("column {column} is forced but there are only {columns} columns")]
    Forced { column: usize, columns: usize },
    #[error("sets of {size} are asked for, but {forced} columns are forced and there are {columns} columns in all")]
    Size { size: usize, forced: usize, columns: usize },
}

/// Looks at every set.
///
/// # Errors
/// [`SubsetError`] for values that are not finite, forced columns that do not exist, an impossible size, or cancellation.
pub fn exhaustive(problem: &SubsetProblem<'_>, control: &Control) -> Result<Ranking, SubsetError> {
    let unit = Unit::new(problem)?;
    let free = unit.free();
    let mut best = Best::new(problem.keep);
    let mut picks: Vec<usize> = (0..unit.chosen).collect();
    let total = combinations(free.len(), unit.chosen);
    let mut nodes = 0_u64;
    if free.len() < unit.chosen {
        return Ok(best.finish(&unit, true, 0));
    }
    loop {
        if nodes.is_multiple_of(256) {
            control.check()?;
            control.report(nodes as f64 / total);
        }
        nodes += 1;
        let chosen: Vec<usize> = picks.iter().map(|&p| free[p]).collect();
        unit.try_set(&chosen, &mut best)?;
        if !next_combination(&mut picks, free.len()) {
            return Ok(best.finish(&unit, true, nodes));
        }
    }
}

/// Number of sets of `k` out of `n`.
pub fn combinations(n: usize, k: usize) -> f64 {
    if k > n { 0.0 } else { (0..k).fold(1.0, |sets, i| sets * (n - i) as f64 / (i + 1) as f64) }
}

/// Next combination in lexicographic order; false after the last.
fn next_combination(picks: &mut [usize], n: usize) -> bool {
    let k = picks.len();
    let Some(i) = (0..k).rev().find(|&i| picks[i] < n - k + i) else {
        return false;
    };
    picks[i] += 1;
    for j in i + 1..k {
        picks[j] = picks[j - 1] + 1;
    }
    true
}

/// The problem with unit columns and a unit right-hand side.
struct Unit {
    columns: Vec<Vec<f64>>,
    scale: Vec<f64>,
    b: Vec<f64>,
    b_norm: f64,
    /// Forced columns, ascending, without repetition.
    forced: Vec<usize>,
    /// Number of columns to choose beside the forced ones.
    chosen: usize,
}

impl Unit {
    fn new(problem: &SubsetProblem<'_>) -> Result<Self, SubsetError> {
        check(problem.a, problem.b)?;
        let n = problem.a.ncols();
        let mut forced = problem.forced.to_vec();
        forced.sort_unstable();
        forced.dedup();
        if let Some(&column) = forced.iter().find(|&&j| j >= n) {
            return Err(SubsetError::Forced { column, columns: n });
        }
        if problem.size < forced.len() || problem.size > n {
            return Err(SubsetError::Size { size: problem.size, forced: forced.len(), columns: n });
        }
        let mut columns: Vec<Vec<f64>> =
            (0..n).map(|j| problem.a.col(j).iter().copied().collect::<Vec<f64>>()).collect();
        let scale = columns.iter_mut().map(|c| normalise(c)).collect();
        let mut b = problem.b.to_vec();
        let b_norm = normalise(&mut b);
        Ok(Self { columns, scale, b, b_norm, chosen: problem.size - forced.len(), forced })
    }

    /// Columns that may be chosen: neither forced nor zero.
    fn free(&self) -> Vec<usize> {
        (0..self.columns.len()).filter(|j| self.scale[*j] > 0.0 && !self.forced.contains(j)).collect()
    }

    /// Solves for the forced and the `chosen` columns and offers the set if every chosen one is used. Returns the
    /// residual.
    fn try_set(&self, chosen: &[usize], best: &mut Best) -> Result<f64, NnlsError> {
        let (set, x, residual) = self.solve(chosen)?;
        let positive = set.iter().zip(&x).all(|(j, v)| *v > 0.0 || self.forced.contains(j));
        if positive && chosen.len() == self.chosen {
            best.offer(set, x, residual);
        }
        Ok(residual)
    }

    /// Columns in ascending order, coefficients of the unit columns, residual.
    fn solve(&self, chosen: &[usize]) -> Result<(Vec<usize>, Vec<f64>, f64), NnlsError> {
        let mut set: Vec<usize> = self.forced.iter().chain(chosen).copied().collect();
        set.sort_unstable();
        let a = Mat::from_fn(self.b.len(), set.len(), |i, j| self.columns[set[j]][i]);
        let fit = nnls(a.as_ref(), &self.b)?;
        Ok((set, fit.solution, fit.residual_norm))
    }
}

/// The best sets so far, in units of the unit problem.
struct Best {
    keep: usize,
    sets: Vec<(f64, Vec<usize>, Vec<f64>)>,
}

impl Best {
    fn new(keep: usize) -> Self {
        Self { keep: keep.max(1), sets: Vec::new() }
    }

    /// Residual that a set must undercut to be listed; no set is worse than none at all.
    fn threshold(&self) -> f64 {
        if self.sets.len() < self.keep { 1.0 } else { self.sets[self.keep - 1].0 }
    }

    /// The best set, forced columns included.
    fn first(&self) -> Option<&[usize]> {
        self.sets.first().map(|(_, columns, _)| columns.as_slice())
    }

    /// Residual of the best set; infinite where there is none.
    fn least(&self) -> f64 {
        self.sets.first().map_or(f64::INFINITY, |(residual, _, _)| *residual)
    }

    fn offer(&mut self, set: Vec<usize>, x: Vec<f64>, residual: f64) {
        let full = self.sets.len() >= self.keep;
        if (full && residual >= self.threshold()) || self.sets.iter().any(|(_, other, _)| *other == set) {
            return;
        }
        let place = self.sets.partition_point(|(other, _, _)| *other <= residual);
        self.sets.insert(place, (residual, set, x));
        self.sets.truncate(self.keep);
    }

    /// Back to the units of the question.
    fn finish(self, unit: &Unit, proved: bool, nodes: u64) -> Ranking {
        let sets = self
            .sets
            .into_iter()
            .map(|(residual, columns, x)| RankedSet {
                coefficients: columns
                    .iter()
                    .zip(x)
                    .map(|(&j, v)| if unit.scale[j] > 0.0 { v * unit.b_norm / unit.scale[j] } else { 0.0 })
                    .collect(),
                columns,
                residual_norm: residual * unit.b_norm,
                angle: residual.min(1.0).asin(),
            })
            .collect();
        Ranking { sets, proved, nodes }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn combinations_come_once_and_all() {
        let mut picks = vec![0, 1, 2];
        let mut seen = vec![picks.clone()];
        while next_combination(&mut picks, 6) {
            seen.push(picks.clone());
        }
        seen.dedup();
        assert_eq!(seen.len() as f64, combinations(6, 3));
        assert_eq!(combinations(180, 5), 1_488_847_536.0);
        assert!(!next_combination(&mut [], 4));
    }
}
