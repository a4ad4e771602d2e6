//! What one pass over a channel tells of the step by which its frequency is to be corrected.

use dashpot_numerics::dot;

/// Products of what a fit leaves of a channel, `r`, with itself and with the derivative `J` of the fit by the frequency.
/// They are summed block by block: of a long record nothing is kept but the samples themselves.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Slope {
    /// `r^T r`.
    pub(super) squares: f64,
    /// `J^T r`.
    pub(super) along: f64,
    /// `J^T J`.
    pub(super) length: f64,
    /// Products of every column of the fit with `J`.
    pub(super) products: Vec<f64>,
}

impl Slope {
    /// All zero, for harmonics up to H.
    pub(super) fn zero(harmonics: usize) -> Self {
        Self { squares: 0.0, along: 0.0, length: 0.0, products: vec![0.0; 2 * harmonics + 2] }
    }

    /// Adds the samples of a block, without the products with the columns.
    pub(super) fn add(&mut self, residual: &[f64], derivative: &[f64]) {
        self.squares += dot(residual, residual);
        self.along += dot(derivative, residual);
        self.length += dot(derivative, derivative);
    }
}
