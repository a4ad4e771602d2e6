//! Why a classical method cannot run.

use crate::math::eigen::EigenError;
use crate::math::least_squares::LinearError;
use crate::structure::StructureError;

/// What a method lacks, and how to mend it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum ClassicalError {
    #[error("needs {needed} {what}, but there are {found}")]
    Few { what: &'static str, needed: usize, found: usize },
    #[error("works up to {limit} DOFs, but the structure has {found}: its unknowns are every entry of the matrix")]
    TooLarge { limit: usize, found: usize },
    #[error("{what} has {found} rows where {expected} are needed")]
    Sizes { what: &'static str, found: usize, expected: usize },
    #[error("{what} is singular at {frequency_hz:.4} Hz: leave that line out")]
    Singular { what: &'static str, frequency_hz: f64 },
    #[error("needs {what}")]
    Missing { what: String },
    #[error("did not settle in {steps} steps (last change {change:.1e})")]
    NoConvergence { steps: usize, change: f64 },
    #[error(transparent)]
    Linear(#[from] LinearError),
    #[error(transparent)]
    Eigen(#[from] EigenError),
    #[error(transparent)]
    Structure(#[from] StructureError),
    #[error("was cancelled")]
    Cancelled,
}

impl From<crate::control::Cancelled> for ClassicalError {
    fn from(_: crate::control::Cancelled) -> Self {
        Self::Cancelled
    }
}
