//! What the methods take and what they give.

use super::error::ClassicalError;
use crate::math::fill::filled_complex;
use crate::structure::damped_modes::DampedMode;
use faer::{Mat, c64};

/// Complex modes: m poles above the real axis and their shapes at n DOFs.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalData {
    /// Poles `lambda`, rad/s, imaginary parts positive.
    pub poles: Vec<c64>,
    /// Shapes, n x m. Any scale, unless `scaled`.
    pub shapes: Mat<c64>,
    /// Whether `psi^T (2 lambda M + C) psi = 1` (3.82), as residues of a receptance with a drive-point sensor give it:
    /// `H = sum psi psi^T / (s - lambda) + conjugate`.
    pub scaled: bool,
}

impl ModalData {
    /// The lowest `count` oscillating modes of a model; scaled.
    pub fn from_modes(modes: &[DampedMode], count: usize) -> Self {
        let kept: Vec<&DampedMode> = modes.iter().filter(|m| m.lambda.im > 0.0).take(count).collect();
        let n = kept.first().map_or(0, |m| m.shape.len());
        Self {
            poles: kept.iter().map(|m| m.lambda).collect(),
            shapes: filled_complex(n, kept.len(), |i, p| kept[p].shape[i]),
            scaled: true,
        }
    }

    /// Number of modes, m.
    pub fn len(&self) -> usize {
        self.poles.len()
    }

    /// Whether there is no mode.
    pub fn is_empty(&self) -> bool {
        self.poles.is_empty()
    }

    /// Number of DOFs, n.
    pub fn degrees(&self) -> usize {
        self.shapes.nrows()
    }

    /// Damping ratio of mode `p`, `-Re lambda / |lambda|`.
    pub fn damping_ratio(&self, p: usize) -> f64 {
        -self.poles[p].re / self.poles[p].norm()
    }

    /// Fails unless the shapes cover `n` DOFs and there are at least `least` modes.
    ///
    /// # Errors
    /// [`ClassicalError::Few`], [`ClassicalError::Sizes`].
    pub fn check(&self, n: usize, least: usize) -> Result<(), ClassicalError> {
        if self.len() < least {
            return Err(ClassicalError::Few { what: "complex modes", needed: least, found: self.len() });
        }
        if self.degrees() != n {
            return Err(ClassicalError::Sizes { what: "the mode shapes", found: self.degrees(), expected: n });
        }
        Ok(())
    }
}

/// The full receptance matrix at a number of lines.
#[derive(Debug, Clone, PartialEq)]
pub struct ReceptanceData {
    /// Circular frequencies, rad/s, ascending.
    pub omega: Vec<f64>,
    /// Receptance at each, n x n, m/N.
    pub matrices: Vec<Mat<c64>>,
}

impl ReceptanceData {
    /// Number of DOFs; 0 without a line.
    pub fn degrees(&self) -> usize {
        self.matrices.first().map_or(0, Mat::nrows)
    }

    /// Fails below `least` lines.
    ///
    /// # Errors
    /// [`ClassicalError::Few`].
    pub fn check(&self, least: usize) -> Result<(), ClassicalError> {
        let found = self.omega.len();
        if found < least {
            return Err(ClassicalError::Few { what: "lines of the full receptance matrix", needed: least, found });
        }
        Ok(())
    }
}

/// The motion of all DOFs under one harmonic load.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadCase {
    /// Circular frequency, rad/s.
    pub omega: f64,
    /// Force on each DOF, N.
    pub force: Vec<c64>,
    /// Displacement of each DOF, m.
    pub displacement: Vec<c64>,
}

/// A free decay of one channel.
#[derive(Debug, Clone, PartialEq)]
pub struct DecayRecord {
    /// Time between samples, s.
    pub step: f64,
    /// Samples, any unit.
    pub samples: Vec<f64>,
}

/// An identified damping matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Damping {
    /// Viscous `C`, n x n, N s/m.
    pub viscous: Mat<f64>,
    /// Structural `D` of `i D x`, n x n, N/m, where the method gives one.
    pub structural: Option<Mat<f64>>,
    /// What the reader should know.
    pub notes: Vec<String>,
}

impl Damping {
    /// A viscous matrix without remarks.
    pub fn viscous(viscous: Mat<f64>) -> Self {
        Self { viscous, structural: None, notes: Vec::new() }
    }
}
