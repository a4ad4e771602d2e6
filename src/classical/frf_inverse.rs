//! Inverse of a receptance built from the modes measured and the model's undamped modes above them (3.69, section 3.3.6):
//!
//! ```text
//! H = sum_{p <= m} psi psi^T / (i w - lambda) + conjugate + sum_{p > m} phi phi^T / (w_p^2 - w^2)        C = Im(H^-1) / w
//! ```
//!
//! at a low frequency, symmetrised. **Needs** mass and stiffness and complex modes at all DOFs, scaled (3.82). **Limits**:
//! the modes above are taken as undamped; a plain pseudo-inverse of the truncated sum would be useless (errors of 1e5 per
//! cent), because the inverse is ruled by the modes that are missing.

use super::data::{Damping, ModalData};
use super::error::ClassicalError;
use super::linear::{column, inverse};
use crate::math::fill::filled;
use crate::structure::modes::Modes;
use faer::{Mat, MatRef, c64};

/// Frequency of the inversion as a part of the lowest measured one.
const LOW: f64 = 0.05;

/// `C` at a frequency far below the lowest measured mode.
///
/// # Errors
/// [`ClassicalError::Missing`] for modes of unknown scale or rigid body modes; [`ClassicalError::Few`],
/// [`ClassicalError::Sizes`], [`ClassicalError::Singular`].
pub fn frf_inverse(model: &Modes, modes: &ModalData) -> Result<Damping, ClassicalError> {
    modes.check(model.shapes.nrows(), 1)?;
    if !modes.scaled {
        return Err(ClassicalError::Missing { what: "scaled complex modes: measure the drive point".to_string() });
    }
    if model.omega[0] == 0.0 {
        return Err(ClassicalError::Missing { what: "a structure without rigid body modes".to_string() });
    }
    let omega = LOW * modes.poles.iter().map(|l| l.norm()).fold(f64::INFINITY, f64::min);
    let z = inverse(receptance(model, modes, omega).as_ref(), "the receptance", omega)?;
    let n = model.shapes.nrows();
    Ok(Damping::viscous(filled(n, n, |i, j| 0.5 * (z[(i, j)].im + z[(j, i)].im) / omega)))
}

/// Receptance at `omega` (rad/s), n x n: measured modes, then undamped ones.
pub fn receptance(model: &Modes, modes: &ModalData, omega: f64) -> Mat<c64> {
    let n = model.shapes.nrows();
    let mut h = Mat::zeros(n, n);
    let s = c64::new(0.0, omega);
    for (p, &lambda) in modes.poles.iter().enumerate() {
        let psi = column(modes.shapes.as_ref(), p);
        for j in 0..n {
            for i in 0..n {
                let residue = psi[i] * psi[j];
                h[(i, j)] += residue / (s - lambda) + residue.conj() / (s - lambda.conj());
            }
        }
    }
    for p in modes.len()..model.len() {
        add_undamped(&mut h, model.shapes.as_ref(), p, model.omega[p].powi(2) - omega * omega);
    }
    h
}

fn add_undamped(h: &mut Mat<c64>, shapes: MatRef<'_, f64>, p: usize, stiffness: f64) {
    let n = shapes.nrows();
    for j in 0..n {
        for i in 0..n {
            h[(i, j)] += c64::new(shapes[(i, p)] * shapes[(j, p)] / stiffness, 0.0);
        }
    }
}
