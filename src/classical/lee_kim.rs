//! Lee and Kim (3.53-3.59): viscous and structural damping from the imaginary part of the dynamic stiffness,
//!
//! ```text
//! Z = H^-1        Im Z(w) = w C + D
//! ```
//!
//! least squares over the lines, entry by entry, then symmetrised. **Needs** the receptance between all DOFs at two lines
//! or more (one, if there is no structural damping); neither mass nor stiffness. **Limits**: as every inversion of `H`,
//! all modes must be in the data (3.76-3.81); lines too close to each other cannot tell `C` from `D`.

use super::data::{Damping, ReceptanceData};
use super::error::ClassicalError;
use super::linear::inverse;
use crate::math::eigen::symmetrised;
use crate::math::fill::filled;
use faer::Mat;

/// `C` and `D` of (3.59).
///
/// # Errors
/// [`ClassicalError::Few`] below two different lines; [`ClassicalError::Singular`].
pub fn lee_kim(receptance: &ReceptanceData) -> Result<Damping, ClassicalError> {
    receptance.check(2)?;
    let z = stiffness_losses(receptance)?;
    let count = z.len() as f64;
    let mean = receptance.omega.iter().sum::<f64>() / count;
    let spread: f64 = receptance.omega.iter().map(|w| (w - mean).powi(2)).sum();
    if spread <= f64::EPSILON * mean * mean {
        return Err(ClassicalError::Few { what: "different frequencies", needed: 2, found: 1 });
    }
    let n = receptance.degrees();
    let slope = |i: usize, j: usize| -> f64 {
        z.iter().zip(&receptance.omega).map(|(m, w)| m[(i, j)] * (w - mean)).sum::<f64>() / spread
    };
    let viscous = filled(n, n, slope);
    let average = |i: usize, j: usize| z.iter().map(|m| m[(i, j)]).sum::<f64>() / count;
    let structural = filled(n, n, |i, j| average(i, j) - mean * viscous[(i, j)]);
    let mut damping = Damping::viscous(symmetrised(viscous.as_ref()));
    damping.structural = Some(symmetrised(structural.as_ref()));
    Ok(damping)
}

/// `C` alone, `D = 0`: from one line or more.
///
/// # Errors
/// [`ClassicalError::Few`] without a line; [`ClassicalError::Singular`].
pub fn lee_kim_viscous(receptance: &ReceptanceData) -> Result<Damping, ClassicalError> {
    receptance.check(1)?;
    let z = stiffness_losses(receptance)?;
    let weight: f64 = receptance.omega.iter().map(|w| w * w).sum();
    let n = receptance.degrees();
    let c = filled(n, n, |i, j| z.iter().zip(&receptance.omega).map(|(m, w)| m[(i, j)] * w).sum::<f64>() / weight);
    Ok(Damping::viscous(symmetrised(c.as_ref())))
}

/// `Im H^-1` at every line.
fn stiffness_losses(receptance: &ReceptanceData) -> Result<Vec<Mat<f64>>, ClassicalError> {
    let lines = receptance.omega.iter().zip(&receptance.matrices);
    lines.map(|(&w, h)| Ok(super::linear::imaginary(inverse(h.as_ref(), "the receptance", w)?.as_ref()))).collect()
}
