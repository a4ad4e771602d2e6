//! What of the study is drawn, and against what.

use crate::classical::incompleteness::MatrixErrors;

/// What the errors are drawn against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// The number of modes, at one set of sensors.
    Modes,
    /// The number of sensors, with as many modes as all sets of sensors allow.
    Sensors,
}

/// What is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Error {
    /// `eps_C` (3.135), with `eps_p` (3.117).
    Matrix,
    /// Largest deviation of the modes (3.134).
    Mac,
}

/// What is looked at.
#[derive(Debug, Clone, Copy)]
pub struct Choice {
    /// Axis of x.
    pub along: Along,
    /// Axis of y.
    pub error: Error,
    /// Which of the sets of sensors.
    pub set: usize,
}

impl Default for Choice {
    fn default() -> Self {
        Self { along: Along::Modes, error: Error::Matrix, set: 0 }
    }
}

impl Choice {
    /// The error that is drawn, of those of a matrix.
    pub(super) fn of(self, errors: &MatrixErrors) -> Option<f64> {
        match self.error {
            Error::Matrix => Some(errors.eps_c),
            Error::Mac => errors.mac,
        }
    }
}
