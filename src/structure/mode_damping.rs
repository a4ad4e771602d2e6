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

use super::factors::Part;
use super::system::{Structure, SystemMatrices};
use dashpot_numerics::dot;

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
pub(crate) fn modal_pattern(matrices: &SystemMatrices, shape: &[f64]) -> Vec<f64> {
    (0..shape.len()).map(|i| dot(matrices.mass.col_as_slice(i), shape)).collect()
}

impl Structure {
    /// Factor on the damping that laws of the whole structure give a mode; 1 where it is not corrected.
    pub fn mode_damping(&self, mode: usize) -> f64 {
        self.origin.damping_of_modes.iter().find(|d| d.mode == mode).map_or(1.0, |d| d.factor)
    }

    /// Modes whose damping is corrected.
    pub fn damping_of_modes(&self) -> &[DampingOfMode] {
        &self.origin.damping_of_modes
    }

    /// Takes the factors on the damping of modes among `factors` beside those that are there, on the modes as they are now.
    pub(super) fn correct_damping(&mut self, factors: &[(Part, f64)]) {
        let mut all: Vec<(usize, f64)> = self.origin.damping_of_modes.iter().map(|d| (d.mode, d.factor)).collect();
        for &(part, factor) in factors {
            let Part::ModeDamping(mode) = part else { continue };
            match all.iter_mut().find(|(own, _)| *own == mode) {
                Some((_, own)) => *own *= factor,
                None => all.push((mode, factor)),
            }
        }
        all.retain(|(_, factor)| *factor != 1.0);
        self.origin.damping_of_modes.clear();
        if all.is_empty() {
            return;
        }
        let (Ok(modes), Some(matrices)) = (self.modes(), &self.matrices) else { return };
        let of = |(mode, factor): (usize, f64)| DampingOfMode {
            mode,
            factor,
            pattern: modal_pattern(matrices, modes.shapes.col_as_slice(mode)),
            square: modes.omega[mode].powi(2),
        };
        self.origin.damping_of_modes = all.into_iter().filter(|(mode, _)| *mode < modes.len()).map(of).collect();
    }
}
