//! Undamped modes: `K phi = omega^2 M phi`, scaled so that `Phi^T M Phi = I`.

use super::error::StructureError;
use super::matrices::SystemMatrices;
use super::system::Structure;
use crate::math::eigen::{self, EigenError};
use faer::{Mat, c64};
use std::f64::consts::TAU;

/// Multiple of rounding at the highest `omega^2` below which `omega^2` counts as that of a rigid body.
const RIGID: f64 = 64.0 * f64::EPSILON;

/// Undamped modes in ascending order of frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// Natural circular frequencies, rad/s; exactly 0 for rigid body modes.
    pub omega: Vec<f64>,
    /// Mass-normalised shapes, one column a mode: n x n, or n x m where only the lowest m are known.
    pub shapes: Mat<f64>,
}

impl Modes {
    /// Number of modes.
    pub fn len(&self) -> usize {
        self.omega.len()
    }

    /// Whether there is no mode.
    pub fn is_empty(&self) -> bool {
        self.omega.is_empty()
    }

    /// Natural frequency of mode `r`, Hz.
    pub fn frequency_hz(&self, r: usize) -> f64 {
        self.omega[r] / TAU
    }

    /// Shape of mode `r`.
    pub fn shape(&self, r: usize) -> Vec<f64> {
        self.shapes.col(r).iter().copied().collect()
    }

    /// Mode nearest in frequency to `omega` (rad/s).
    pub fn nearest(&self, omega: f64) -> Option<usize> {
        (0..self.len()).min_by(|&a, &b| (self.omega[a] - omega).abs().total_cmp(&(self.omega[b] - omega).abs()))
    }
}

/// Undamped modes of mass and stiffness.
///
/// # Errors
/// [`StructureError::NegativeStiffness`] when an `omega^2` is negative beyond rounding; [`StructureError::Modes`] when the
/// iteration fails.
pub fn modes(matrices: &SystemMatrices) -> Result<Modes, StructureError> {
    let eigen =
        eigen::generalised_symmetric(matrices.stiffness.as_ref(), matrices.mass.as_ref()).map_err(|e| failure(&e))?;
    let n = eigen.values.len();
    let highest = eigen.values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let least = eigen.values.first().copied().unwrap_or(0.0);
    if least < -RIGID.max(1e-12) * highest * (n as f64).sqrt() {
        return Err(StructureError::NegativeStiffness { least });
    }
    Ok(Modes { omega: frequencies(&eigen.values, RIGID * highest), shapes: eigen.vectors })
}

/// `omega` of `omega^2`; 0 for those of rigid bodies, up to `rounding`.
pub(super) fn frequencies(squares: &[f64], rounding: f64) -> Vec<f64> {
    squares.iter().map(|&v| if v <= rounding { 0.0 } else { v.sqrt() }).collect()
}

pub(super) fn failure(error: &EigenError) -> StructureError {
    StructureError::Modes { reason: error.to_string() }
}

impl Structure {
    /// Undamped modes.
    ///
    /// # Errors
    /// [`StructureError::NoMatrices`] for points; otherwise those of [`modes`].
    pub fn modes(&self) -> Result<Modes, StructureError> {
        modes(self.matrices().ok_or(StructureError::NoMatrices)?)
    }
}

/// Modal assurance criterion `|a^H b|^2 / (a^H a b^H b)`: 1 for shapes that differ by a factor only; 0 where a shape is 0.
pub fn mac(a: &[c64], b: &[c64]) -> f64 {
    let product = |x: &[c64], y: &[c64]| x.iter().zip(y).map(|(p, q)| p.conj() * q).sum::<c64>();
    let norms = product(a, a).re * product(b, b).re;
    if norms > 0.0 { product(a, b).norm_sqr() / norms } else { 0.0 }
}

/// [`mac`] for real shapes.
pub fn mac_real(a: &[f64], b: &[f64]) -> f64 {
    let complex = |x: &[f64]| x.iter().map(|&v| c64::new(v, 0.0)).collect::<Vec<c64>>();
    mac(&complex(a), &complex(b))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models;
    use faer::mat;

    #[test]
    fn free_chain_has_one_rigid_mode() {
        let modes = models::chain(&[2.0, 3.0, 4.0], &[0.0; 3], &[1e5, 2e5]).modes().unwrap();
        assert_eq!(modes.omega[0], 0.0);
        assert!(modes.omega[1] > 1.0);
        assert!((modes.shapes[(0, 0)].abs() - 1.0 / 3.0).abs() < 1e-12); // 1 / sqrt(total mass)
    }

    #[test]
    fn negative_stiffness_is_an_error() {
        let matrices = SystemMatrices { mass: Mat::identity(2, 2), stiffness: mat![[1.0, 0.0], [0.0, -4.0]] };
        let Err(StructureError::NegativeStiffness { least }) = modes(&matrices) else { panic!() };
        assert!((least + 4.0).abs() < 1e-12);
    }

    #[test]
    fn mac_ignores_a_complex_factor() {
        let a = [c64::new(1.0, 0.5), c64::new(-2.0, 1.0)];
        let b: Vec<c64> = a.iter().map(|v| v * c64::new(0.3, -7.0)).collect();
        assert!((mac(&a, &b) - 1.0).abs() < 1e-14);
        assert_eq!(mac_real(&[1.0, 0.0], &[0.0, 1.0]), 0.0);
        assert_eq!(mac_real(&[0.0, 0.0], &[0.0, 1.0]), 0.0);
    }
}
