//! A mode as an extraction gives it.

use faer::{Mat, c64};
use std::f64::consts::TAU;

/// One mode as extracted.
#[derive(Debug, Clone, PartialEq)]
pub struct ExtractedMode {
    /// Pole, rad/s.
    pub pole: c64,
    /// Standard deviation of the real (and of the imaginary) part of the pole, rad/s, from what the fit leaves.
    pub deviation: f64,
    /// Residues `psi psi^T`, sensors x drives.
    pub residues: Mat<c64>,
}

impl ExtractedMode {
    /// `|lambda| / 2 pi`, Hz.
    pub fn frequency_hz(&self) -> f64 {
        self.pole.norm() / TAU
    }

    /// `-Re lambda / |lambda|`.
    pub fn damping_ratio(&self) -> f64 {
        -self.pole.re / self.pole.norm()
    }
}
