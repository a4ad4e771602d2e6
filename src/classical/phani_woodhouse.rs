//! Srikantha Phani and Woodhouse's hybrid (3.126-3.131): ratios of the modes give the diagonal of the modal damping matrix,
//! the receptance what is off it,
//!
//! ```text
//! H' = Phi^-1 H Phi^-T        A(w) = diag(w_p^2 - w^2 + i w c'_pp), c'_pp = w_p / Q_p = 2 zeta_p w_p
//! C'_0 = off-diagonal of (A - A H' A) / (i w), least squares over the lines        C = Phi^-T C' Phi^-1
//! ```
//!
//! **Needs** the receptance between all DOFs, real mode shapes, frequencies and damping ratios. **Limits**: the series is cut
//! after its first term, so the error is of the first order of (coupling / distance of the lines from the resonances):
//! lines near a resonance are left out here ([`CLEAR`]), where the neglected term rules.

use super::data::{Damping, ReceptanceData};
use super::error::ClassicalError;
use super::linear::imaginary;
use crate::math::eigen::symmetrised;
use crate::math::fill::{filled, filled_complex};
use crate::math::least_squares::LeastSquares;
use crate::structure::modes::Modes;
use faer::{Mat, c64};

/// Lines nearer to a natural frequency than this part of it are left out.
pub const CLEAR: f64 = 0.03;

/// `C` from the receptance, the real modes and the damping ratio of each.
///
/// # Errors
/// [`ClassicalError::Few`] without a line clear of the resonances; [`ClassicalError::Sizes`]; those of the linear algebra.
pub fn phani_woodhouse(receptance: &ReceptanceData, modes: &Modes, ratios: &[f64]) -> Result<Damping, ClassicalError> {
    let n = receptance.degrees();
    if modes.len() != n || ratios.len() != n {
        let found = modes.len().min(ratios.len());
        return Err(ClassicalError::Sizes { what: "the list of modes and ratios", found, expected: n });
    }
    let clear = |w: f64| modes.omega.iter().all(|&wn| (w - wn).abs() > CLEAR * wn);
    let lines: Vec<usize> = (0..receptance.omega.len()).filter(|&k| clear(receptance.omega[k])).collect();
    if lines.is_empty() {
        return Err(ClassicalError::Few { what: "lines clear of the resonances", needed: 1, found: 0 });
    }
    let inverse = LeastSquares::new(modes.shapes.as_ref())?.pseudo_inverse();
    let (mut sum, mut weight) = (Mat::<f64>::zeros(n, n), 0.0);
    for k in lines {
        let w = receptance.omega[k];
        let diagonal: Vec<c64> =
            (0..n).map(|p| c64::new(modes.omega[p].powi(2) - w * w, 2.0 * w * ratios[p] * modes.omega[p])).collect();
        let h = modal(&inverse, &receptance.matrices[k]);
        let product = filled_complex(n, n, |i, j| -diagonal[i] * h[(i, j)] * diagonal[j]);
        sum += imaginary(product.as_ref()) * faer::Scale(w);
        weight += w * w;
    }
    let modal_damping = filled(n, n, |i, j| {
        if i == j { 2.0 * ratios[i] * modes.omega[i] } else { 0.5 * (sum[(i, j)] + sum[(j, i)]) / weight }
    });
    let c = inverse.transpose() * modal_damping * &inverse;
    Ok(Damping::viscous(symmetrised(c.as_ref())))
}

/// `Phi^-1 H Phi^-T`.
fn modal(inverse: &Mat<f64>, h: &Mat<c64>) -> Mat<c64> {
    let wide = super::linear::complex(inverse.as_ref());
    &wide * h * wide.transpose()
}
