//! One run of harmonics that were fitted elsewhere.

use crate::measurement::HarmonicFit;

/// One run of a harmonics file.
#[derive(Debug, Clone, PartialEq)]
pub struct HarmonicsRun {
    /// Name in column `run`.
    pub name: String,
    /// Its harmonics; covariance and noise are zero where the file gives no deviations.
    pub fit: HarmonicFit,
    /// Label of the force level, where the file has it.
    pub level: Option<i64>,
    /// Name of the session, where the file has it.
    pub session: Option<String>,
}
