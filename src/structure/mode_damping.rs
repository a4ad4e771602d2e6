//! Damping of single modes, which no matrix in proportion to mass or stiffness gives as it is.
//!
//! Laws of the whole structure act on `B = M` or `B = K`. Where the damping of modes is corrected they act on
//!
//! ```text
//! B' = B + sum_r (f_r - 1) b_r (M phi_r)(M phi_r)^T,      b_r = 1 or omega_r^2
//! ```
//!
//! so that the modal damping of mode `r` is `f_r` times what they give, and that of the others as it was (Craig and Kurdila 2006,
//! Fundamentals of Structural Dynamics, chapter 10: damping matrix for given modal damping factors).
//!
//! Damping that is stated as structural may be viscous, and the reverse: away from the natural frequency, where a stiffening joint
//! takes the response, `f_r (omega / omega_r)^e` stands in the place of `f_r`, told by the factor `2^e` of an octave.

use dashpot_numerics::dot;
use faer::Mat;

/// The factor on the damping of one mode, and the pattern of forces by which the mode is felt.
#[derive(Debug, Clone, PartialEq)]
pub struct DampingOfMode {
    /// Number of the undamped mode, from 0.
    pub mode: usize,
    /// Factor on its damping at its natural frequency, positive.
    pub factor: f64,
    /// Factor on that an octave above, positive.
    pub per_octave: f64,
    /// `M phi`, the shape being mass-normalised; n, square root of kg.
    pub pattern: Vec<f64>,
    /// Square of its natural circular frequency, rad^2/s^2.
    pub square: f64,
}

impl DampingOfMode {
    /// Factor on its damping at `omega`, rad/s.
    pub fn factor_at(&self, omega: f64) -> f64 {
        self.factor * (octaves(omega, self.square) * self.per_octave.ln()).exp()
    }
}

/// Octaves of `omega`, rad/s, above a natural frequency of this square; 0 at rest and of a mode at rest.
pub(crate) fn octaves(omega: f64, square: f64) -> f64 {
    if omega > 0.0 && square > 0.0 { 0.5 * (omega * omega / square).log2() } else { 0.0 }
}

/// `M phi`.
pub(crate) fn modal_pattern(mass: &Mat<f64>, shape: &[f64]) -> Vec<f64> {
    (0..shape.len()).map(|i| dot(mass.col_as_slice(i), shape)).collect()
}
