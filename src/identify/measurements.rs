//! Everything that was measured on one structure.

use crate::measurement::{MeasuredRatio, Run, TransientRun};

/// Everything that was measured on one structure.
#[derive(Debug, Clone, Copy)]
pub struct Measurements<'a> {
    /// Steady runs.
    pub runs: &'a [Run],
    /// Decays and transients.
    pub transient_runs: &'a [TransientRun],
    /// Damping ratios.
    pub ratios: &'a [MeasuredRatio],
}
