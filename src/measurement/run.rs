//! One run: a steady-state test under one periodic force.

use super::{Finding, HarmonicFit, Record};
use std::sync::Arc;

/// One run with its fitted harmonics, corrected for the known errors of its channels.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Name of the file (or of the run in a harmonics file), for messages and results.
    pub file: String,
    /// Label of the force level.
    pub level: Option<i64>,
    /// Whether the user wants it used.
    pub enabled: bool,
    /// Time record, where there is one.
    pub record: Option<Arc<Record>>,
    /// Harmonics of every channel.
    pub fit: HarmonicFit,
    /// Noise over signal, root mean square over the channels.
    pub noise_ratio: f64,
    /// What is wrong with the record, each with its reason in words.
    pub findings: Vec<Finding>,
}
