//! What is asked of a search for the best sets, and what it answers.

use crate::control::Cancelled;
use crate::math::nnls::NnlsError;
use faer::MatRef;

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

/// Number of sets of `k` out of `n`.
pub fn combinations(n: usize, k: usize) -> f64 {
    if k > n { 0.0 } else { (0..k).fold(1.0, |sets, i| sets * (n - i) as f64 / (i + 1) as f64) }
}
