//! What is exported: identified sources, matrices and modes.

use crate::effects::{Effect, Source};
use crate::structure::Structure;
use faer::Mat;

/// A source with its identified (or known) values.
#[derive(Debug, Clone, PartialEq)]
pub struct IdentifiedSource {
    /// The source at its values.
    pub source: Source,
    /// Standard deviation of each parameter; 0 where it is known.
    pub deviation: Vec<f64>,
    /// Share of all dissipated energy, per cent.
    pub energy_percent: f64,
}

/// A damped mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IdentifiedMode {
    /// Frequency `|lambda| / 2 pi`, Hz.
    pub frequency_hz: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Its standard deviation.
    pub deviation: f64,
}

/// Everything that is exported; matrices are n x n in the order of [`Structure::dofs`].
#[derive(Debug, Clone, Copy)]
pub struct Identified<'a> {
    /// Title of the project.
    pub title: &'a str,
    /// Structure.
    pub structure: &'a Structure,
    /// Identified and known sources.
    pub sources: &'a [IdentifiedSource],
    /// Viscous damping matrix, N s/m.
    pub viscous: &'a Mat<f64>,
    /// One matrix of coefficients for each other law, in that law's unit.
    pub others: &'a [(Effect, Mat<f64>)],
    /// Viscous matrix of equal energy over all runs, N s/m.
    pub equivalent: &'a Mat<f64>,
    /// Share of each DOF in all dissipated energy, per cent.
    pub energy_percent: &'a [f64],
    /// Damped modes; empty without mass and stiffness.
    pub modes: &'a [IdentifiedMode],
}
