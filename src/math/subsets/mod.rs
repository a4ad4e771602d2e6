//! The best sets of a given size for non-negative least squares: `min |A_S x - b|`, `x >= 0`, over sets S of columns.
//!
//! A set counts only if every free column in it has a positive coefficient: otherwise it is a smaller set in disguise.
//! [`exhaustive`] looks at every set; [`branch_and_bound`] proves the same answer without looking at most of them.

mod exhaustive;
mod pairs;
mod problem;
mod relaxation;
mod search;
mod unit_problem;

pub use exhaustive::exhaustive;
pub use problem::{RankedSet, Ranking, SubsetError, SubsetProblem, combinations};
pub use search::branch_and_bound;
