//! Chen et al. (3.43-3.52): damping from the full receptance through its undamped part,
//!
//! ```text
//! G = -Im(H) Re(H)^-1        H_N = Re(H) - G Im(H) = (K - w^2 M)^-1        w C = H_N^-1 G
//! ```
//!
//! least squares over the lines, then symmetrised. **Needs** the receptance between all DOFs at one line or more; neither
//! mass nor stiffness. **Limits**: viscous damping only. `H` is inverted, so every mode must be in the data: with
//! fewer modes than DOFs it is singular but for noise, and the high modes, which are not measured, rule the result.

use super::data::{Damping, ReceptanceData};
use super::error::ClassicalError;
use super::linear::{imaginary, real, solve};
use crate::math::eigen::symmetrised;
use crate::math::fill::filled;
use faer::Mat;

/// `C` of (3.52).
///
/// # Errors
/// [`ClassicalError::Few`] without a line; [`ClassicalError::Singular`] where a line cannot be inverted.
pub fn chen(receptance: &ReceptanceData) -> Result<Damping, ClassicalError> {
    receptance.check(1)?;
    let n = receptance.degrees();
    let (mut sum, mut weight) = (Mat::<f64>::zeros(n, n), 0.0);
    for (&omega, h) in receptance.omega.iter().zip(&receptance.matrices) {
        let (re, im) = (real(h.as_ref()), imaginary(h.as_ref()));
        // G Re(H) = -Im(H), solved as Re(H)^T G^T = -Im(H)^T.
        let g = solve(re.transpose(), (-&im).transpose(), "the real part of the receptance", omega)?;
        let g = g.transpose().to_owned();
        let normal = &re - &g * &im;
        let damping = solve(normal.as_ref(), g.as_ref(), "the undamped receptance", omega)?;
        sum += damping * faer::Scale(omega);
        weight += omega * omega;
    }
    let c = filled(n, n, |i, j| sum[(i, j)] / weight);
    Ok(Damping::viscous(symmetrised(c.as_ref())))
}
