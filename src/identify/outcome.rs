//! What identification ends with: plain data, with the whole history of steps.

use super::results::Results;
use crate::balance::{Expansion, Weights};
use serde::{Deserialize, Serialize};

/// How the search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SelectionStatus {
    /// The accepted set explains the data to their noise.
    WithinNoise,
    /// No set reaches the noise; the accepted one is the best by the Bayesian criterion.
    AboveNoise,
    /// The accepted set is below the angle limit.
    BelowAngle,
    /// No set is below the angle limit; the accepted one has the smallest angle.
    AboveAngle,
    /// As many sources as equations: any set fits, and nothing is left to judge it by.
    NothingLeft,
}

/// Which equation was solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Form {
    /// The energy equation, one row a run.
    Energy,
    /// The response equation, maximum likelihood: mass and stiffness agree with the data.
    Response,
}

/// An identified coefficient.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Index in the list of sources given to `identify`.
    pub source: usize,
    /// Value of the linear coefficient, in its unit.
    pub coefficient: f64,
    /// Its standard deviation; 0 for a known source, infinite where the data do not determine it.
    pub deviation: f64,
    /// Its share of the energy taken out by all sources (known ones included) over all runs, per cent.
    pub energy_percent: f64,
}

/// Another set of the same size.
#[derive(Debug, Clone, PartialEq)]
pub struct RankedAlternative {
    /// Indices in the list of sources.
    pub sources: Vec<usize>,
    /// Their coefficients.
    pub coefficients: Vec<f64>,
    /// Angle between the energies measured and identified, degrees.
    pub angle_deg: f64,
    /// Residual, each row over its deviation where that is known.
    pub chi_square: f64,
}

/// The best set of one size.
#[derive(Debug, Clone, PartialEq)]
pub struct SelectionStep {
    /// Number of sources.
    pub count: usize,
    /// The identified sources.
    pub sources: Vec<Estimate>,
    /// Angle between the energies measured and identified (rows weighted as in the settings), degrees.
    pub angle_deg: f64,
    /// `|e - G c| / |e|` over the runs, unweighted.
    pub relative_error: f64,
    /// `G c` of each run in use, J; known sources included.
    pub identified_energy: Vec<f64>,
    /// Residual of the equation that was solved, each row over its deviation where that is known.
    pub chi_square: f64,
    /// Rows less unknowns.
    pub freedom: usize,
    /// Extended Bayesian criterion, less is better; `None` where noise is not known.
    pub criterion: Option<f64>,
    /// Root mean square of the error on left-out runs, in deviations; `None` where runs are too few.
    pub held_out: Option<f64>,
    /// Condition of the set's columns.
    pub condition: f64,
    /// Sets of the same size, next best first.
    pub alternatives: Vec<RankedAlternative>,
    /// The best set that the `keep` rule leaves out, where there is a better one.
    pub best_of_all: Option<RankedAlternative>,
    /// Whether the best is proved to be the best.
    pub proved: bool,
    /// Sets or nodes looked at.
    pub looked_at: u64,
}

/// One run in use.
#[derive(Debug, Clone, PartialEq)]
pub struct RunOutcome {
    /// Index in the list of runs given to `identify`.
    pub run: usize,
    /// Input energy per period, J.
    pub input_energy: f64,
    /// Standard deviation of (input - identified) energy from the noise, J.
    pub energy_deviation: f64,
    /// Energy taken out by the accepted sources and the known ones, J.
    pub identified_energy: f64,
    /// Root mean square of (measured - expanded) at the sensors, in standard deviations.
    pub misfit: f64,
    /// The same relative to the measured.
    pub relative_misfit: f64,
    /// Expected relative error of the expanded motion over all DOFs.
    pub expansion_error: f64,
    /// Harmonics that stand out of the noise.
    pub harmonics: Vec<usize>,
}

/// One record that is not steady.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordOutcome {
    /// Index in the list of such runs given to `identify`.
    pub record: usize,
    /// The windows that it was divided into.
    pub windows: Vec<WindowOutcome>,
    /// Numbers of the modes in its band, from 1.
    pub modes: Vec<usize>,
    /// The mode that holds most energy, whose periods the windows hold.
    pub dominant: usize,
    /// Frequency below which motion is left out, Hz.
    pub corner_hz: f64,
}

/// One window of a record.
#[derive(Debug, Clone, PartialEq)]
pub struct WindowOutcome {
    /// Start and end, s.
    pub span_s: [f64; 2],
    /// Work of the exciters, J.
    pub input_energy: f64,
    /// Energy that the structure gave up: stored at the start less stored at the end, J.
    pub released_energy: f64,
    /// Energy of the structure at the start, J.
    pub stored_energy: f64,
    /// Energy taken out by the accepted sources and the known ones, J.
    pub identified_energy: f64,
    /// Standard deviation of (input + released - identified) from the noise, J.
    pub deviation: f64,
}

/// Sources that the data cannot tell from an accepted one.
#[derive(Debug, Clone, PartialEq)]
pub struct Collinear {
    /// The accepted source.
    pub source: usize,
    /// Others that could stand in its place, each with the increase of chi-square, or of the angle in degrees where noise
    /// is not known.
    pub others: Vec<(usize, f64)>,
}

/// The whole answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// How the search ended.
    pub status: SelectionStatus,
    /// Why the accepted set, in words.
    pub reason: String,
    /// Which equation was solved.
    pub form: Form,
    /// Expansion in use.
    pub expansion: Expansion,
    /// Weights of the energy equation in use.
    pub weights: Weights,
    /// Relative error of the model assumed in `dynamic` expansion.
    pub model_error: f64,
    /// Runs in use, in the order given.
    pub runs: Vec<RunOutcome>,
    /// Records that are not steady, in the order given.
    pub records: Vec<RecordOutcome>,
    /// Best set of each size, ascending.
    pub steps: Vec<SelectionStep>,
    /// Index of the accepted step.
    pub accepted: usize,
    /// Accepted sources, then the known ones.
    pub sources: Vec<Estimate>,
    /// Covariance of the accepted coefficients, in the order of the accepted step.
    pub covariance: Vec<Vec<f64>>,
    /// What the data cannot tell apart.
    pub collinear: Vec<Collinear>,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// Matrices, energy shares, damped modes.
    pub results: Results,
}

impl Outcome {
    /// The accepted step.
    pub fn accepted_step(&self) -> &SelectionStep {
        &self.steps[self.accepted]
    }
}
