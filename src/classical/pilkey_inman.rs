//! Pilkey and Inman (3.92-3.96): Lancaster's formula for modes of unknown scale.
//!
//! ```text
//! iterative:  scale by psi^T (2 lambda M + C_k) psi = 1, C_k+1 by (3.91), until nothing changes; C_0 = 0
//! direct:     scale by psi^T (lambda^2 M - K) psi = lambda, then (3.91)
//! ```
//!
//! **Needs** the mass matrix and complex modes of any scale; the direct form the stiffness matrix too. **Limits**: those of
//! Lancaster's formula; the iteration converges where damping is light and slows as it grows.

use super::data::{Damping, ModalData};
use super::error::ClassicalError;
use super::lancaster;
use super::linear::{column, fixed_point, form};
use crate::math::fill::filled_complex;
use faer::{Mat, MatRef, c64};

/// Most steps of the iteration.
const STEPS: usize = 200;
/// Relative change of `C` at which it has settled.
const SETTLED: f64 = 1e-13;

/// The iterative form, from `C_0 = 0`.
///
/// # Errors
/// [`ClassicalError::NoConvergence`]; [`ClassicalError::Few`], [`ClassicalError::Sizes`].
pub fn iterative(m: MatRef<'_, f64>, modes: &ModalData) -> Result<Damping, ClassicalError> {
    modes.check(m.nrows(), 1)?;
    let next = |c: &Mat<f64>| {
        let size = |psi: &[c64], lambda: c64| form(psi, m, psi) * lambda * 2.0 + form(psi, c.as_ref(), psi);
        Ok(lancaster::sum(m, &scaled(modes, size)))
    };
    let (c, steps) = fixed_point(Mat::zeros(m.nrows(), m.ncols()), STEPS, SETTLED, next)?;
    let mut damping = Damping::viscous(c);
    damping.notes.push(steps);
    Ok(damping)
}

/// The direct form.
///
/// # Errors
/// [`ClassicalError::Few`], [`ClassicalError::Sizes`].
pub fn direct(m: MatRef<'_, f64>, k: MatRef<'_, f64>, modes: &ModalData) -> Result<Damping, ClassicalError> {
    modes.check(m.nrows(), 1)?;
    Ok(Damping::viscous(lancaster::sum(m, &scaled_by_stiffness(m, k, modes))))
}

/// Modes with `psi^T (2 lambda M + C) psi = 1`, scaled without `C` by (3.96).
pub fn scaled_by_stiffness(m: MatRef<'_, f64>, k: MatRef<'_, f64>, modes: &ModalData) -> ModalData {
    scaled(modes, |psi, lambda| form(psi, m, psi) * lambda - form(psi, k, psi) / lambda)
}

/// Divides each shape by the root of a form that is quadratic in it.
fn scaled(modes: &ModalData, size: impl Fn(&[c64], c64) -> c64) -> ModalData {
    let factors: Vec<c64> = (0..modes.len())
        .map(|p| {
            let a = size(&column(modes.shapes.as_ref(), p), modes.poles[p]);
            if a.norm() > 0.0 { c64::new(1.0, 0.0) / a.sqrt() } else { c64::new(1.0, 0.0) }
        })
        .collect();
    let shapes = filled_complex(modes.degrees(), modes.len(), |i, p| modes.shapes[(i, p)] * factors[p]);
    ModalData { poles: modes.poles.clone(), shapes, scaled: true }
}
