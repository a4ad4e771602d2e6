//! Settings of the analysis, table `[analysis]` of a project.

use crate::balance::{Expansion, Weights};
use serde::{Deserialize, Serialize};

/// Settings of the analysis; every one has a default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Harmonics fitted to each channel.
    pub harmonics: usize,
    /// Expansion to all DOFs.
    pub expansion: Expansion,
    /// Best single columns kept: every set looked at has one of them; 0 = all sets.
    pub keep: usize,
    /// Weights of the rows of the energy equation.
    pub weights: Weights,
    /// Most sources in a set.
    pub max_sources: usize,
    /// Angle in degrees below which the search stops.
    pub stop_angle_deg: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            harmonics: 7,
            expansion: Expansion::Auto,
            keep: 5,
            weights: Weights::Auto,
            max_sources: 8,
            stop_angle_deg: 0.05,
        }
    }
}
