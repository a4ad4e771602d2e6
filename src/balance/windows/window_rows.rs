//! Rows of the energy equation over windows of one record, and why there are none.

use crate::balance::loops::ComponentError;
use faer::Mat;

/// Why windows of a record give no rows.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum WindowError {
    #[error("{file}: windows of records need mass and stiffness; points have none, so give the matrices")]
    NoMatrices { file: String },
    #[error("the structure's modes cannot be computed: {reason}")]
    Modes { reason: String },
    #[error(
        "{file}: its {sensors} sensors cannot tell the {modes} modes in its band apart; add sensors or mend their places"
    )]
    TooFewSensors { file: String, modes: usize, sensors: usize },
    #[error(
        "{file}: {found_s:.4} s are used, and {needed_s:.4} s are needed to integrate the slowest mode; use a longer part"
    )]
    TooShort { file: String, needed_s: f64, found_s: f64 },
    #[error("{file}: the motion does not stand out of the noise over two windows; use another part")]
    OnlyNoise { file: String },
    #[error(transparent)]
    Component(#[from] ComponentError),
}

/// Rows of the energy equation over windows of one record.
#[derive(Debug, Clone, PartialEq)]
pub struct WindowRows {
    /// Start and end of each window, s, in the record's time.
    pub span_s: Vec<[f64; 2]>,
    /// Energy of each source at unit coefficient, J; windows x sources.
    pub g: Mat<f64>,
    /// Right side, J: input less stored less known.
    pub e: Vec<f64>,
    /// Work of the exciters, J.
    pub input: Vec<f64>,
    /// Energy that the structure gave up over each window, J.
    pub released: Vec<f64>,
    /// Energy of the structure at the start of each window, J.
    pub stored: Vec<f64>,
    /// Energy of each known source, J; windows x known sources.
    pub known: Mat<f64>,
    /// Covariance of the rows, J^2.
    pub covariance: Mat<f64>,
    /// Numbers of the modes in the band, from 0.
    pub modes: Vec<usize>,
    /// The mode whose periods the windows hold.
    pub dominant: usize,
    /// Frequency below which motion is left out, Hz.
    pub corner_hz: f64,
}
