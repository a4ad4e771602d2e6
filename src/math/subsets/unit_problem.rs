//! The problem in unit columns, and the best sets found so far.

use super::problem::{RankedSet, Ranking, SubsetError, SubsetProblem};
use crate::math::nnls::{NnlsError, check, nnls, normalise};
use faer::Mat;

/// The problem with unit columns and a unit right-hand side.
pub(super) struct Unit {
    pub(super) columns: Vec<Vec<f64>>,
    pub(super) scale: Vec<f64>,
    pub(super) b: Vec<f64>,
    pub(super) b_norm: f64,
    /// Forced columns, ascending, without repetition.
    pub(super) forced: Vec<usize>,
    /// Number of columns to choose beside the forced ones.
    pub(super) chosen: usize,
}

impl Unit {
    pub(super) fn new(problem: &SubsetProblem<'_>) -> Result<Self, SubsetError> {
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
    pub(super) fn free(&self) -> Vec<usize> {
        (0..self.columns.len()).filter(|j| self.scale[*j] > 0.0 && !self.forced.contains(j)).collect()
    }

    /// Solves for the forced and the `chosen` columns and offers the set if every chosen one is used. Returns the
    /// residual.
    pub(super) fn try_set(&self, chosen: &[usize], best: &mut Best) -> Result<f64, NnlsError> {
        let (set, x, residual) = self.solve(chosen)?;
        let positive = set.iter().zip(&x).all(|(j, v)| *v > 0.0 || self.forced.contains(j));
        if positive && chosen.len() == self.chosen {
            best.offer(set, x, residual);
        }
        Ok(residual)
    }

    /// Columns in ascending order, coefficients of the unit columns, residual.
    pub(super) fn solve(&self, chosen: &[usize]) -> Result<(Vec<usize>, Vec<f64>, f64), NnlsError> {
        let mut set: Vec<usize> = self.forced.iter().chain(chosen).copied().collect();
        set.sort_unstable();
        let a = Mat::from_fn(self.b.len(), set.len(), |i, j| self.columns[set[j]][i]);
        let fit = nnls(a.as_ref(), &self.b)?;
        Ok((set, fit.solution, fit.residual_norm))
    }
}

/// The best sets so far, in units of the unit problem.
pub(super) struct Best {
    pub(super) keep: usize,
    pub(super) sets: Vec<(f64, Vec<usize>, Vec<f64>)>,
}

impl Best {
    pub(super) fn new(keep: usize) -> Self {
        Self { keep: keep.max(1), sets: Vec::new() }
    }

    /// Residual that a set must undercut to be listed; no set is worse than none at all.
    pub(super) fn threshold(&self) -> f64 {
        if self.sets.len() < self.keep { 1.0 } else { self.sets[self.keep - 1].0 }
    }

    /// The best set, forced columns included.
    pub(super) fn first(&self) -> Option<&[usize]> {
        self.sets.first().map(|(_, columns, _)| columns.as_slice())
    }

    /// Residual of the best set; infinite where there is none.
    pub(super) fn least(&self) -> f64 {
        self.sets.first().map_or(f64::INFINITY, |(residual, _, _)| *residual)
    }

    pub(super) fn offer(&mut self, set: Vec<usize>, x: Vec<f64>, residual: f64) {
        let full = self.sets.len() >= self.keep;
        if (full && residual >= self.threshold()) || self.sets.iter().any(|(_, other, _)| *other == set) {
            return;
        }
        let place = self.sets.partition_point(|(other, _, _)| *other <= residual);
        self.sets.insert(place, (residual, set, x));
        self.sets.truncate(self.keep);
    }

    /// Back to the units of the question.
    pub(super) fn finish(self, unit: &Unit, proved: bool, nodes: u64) -> Ranking {
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
