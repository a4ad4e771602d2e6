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

use dashpot_numerics::dot;
use faer::Mat;

/// The factor on the damping of one mode, and the pattern of forces by which the mode is felt.
#[derive(Debug, Clone, PartialEq)]
pub struct DampingOfMode {
    /// Number of the undamped mode, from 0.
    pub mode: usize,
    /// Factor on its damping, positive.
    pub factor: f64,
    /// `M phi`, the shape being mass-normalised; n, square root of kg.
    pub pattern: Vec<f64>,
    /// Square of its natural circular frequency, rad^2/s^2.
    pub square: f64,
}

/// `M phi`.
pub(crate) fn modal_pattern(mass: &Mat<f64>, shape: &[f64]) -> Vec<f64> {
    (0..shape.len()).map(|i| dot(mass.col_as_slice(i), shape)).collect()
}
