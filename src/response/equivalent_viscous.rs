//! Structural damping in time. A complex stiffness `K + i H` is defined harmonic by harmonic and has no force in time (it would act
//! before its cause). Motion that rings or is struck takes place near the natural frequencies, where viscous damping takes out the same:
//!
//! ```text
//! C = M Phi D Phi^T M,     D_rs = (phi_r^T H phi_s) / sqrt(omega_r omega_s)
//! ```
//!
//! so that a loss factor `eta` gives every mode the damping ratio `eta / 2`. Rigid bodies are not strained: their rows are zero.
//! Source: Ewins, Modal Testing (2000), section 2.4; Crandall, The role of damping in vibration theory, J. Sound Vib. 11 (1970) 3.

use crate::structure::{StructureError, SystemMatrices, modes};
use dashpot_numerics::{product, transposed_product};
use faer::Mat;

/// Equivalent viscous damping, N s/m over the masses, in coordinates of natural frequencies `omega` (rad/s) of the loss stiffness there.
pub(crate) fn in_coordinates(loss: &Mat<f64>, omega: &[f64]) -> Mat<f64> {
    let share = |r: usize| if omega[r] > 0.0 { omega[r].sqrt().recip() } else { 0.0 };
    Mat::from_fn(loss.nrows(), loss.ncols(), |r, s| loss[(r, s)] * share(r) * share(s))
}

/// Equivalent viscous damping, n x n, N s/m, of the loss stiffness `loss`, n x n, N/m.
///
/// # Errors
/// Those of [`modes::modes`].
pub(crate) fn equivalent_viscous(matrices: &SystemMatrices, loss: &Mat<f64>) -> Result<Mat<f64>, StructureError> {
    let modes = modes::modes(matrices)?;
    let modal = transposed_product(modes.shapes.as_ref(), product(loss.as_ref(), modes.shapes.as_ref()).as_ref());
    let damping = in_coordinates(&modal, &modes.omega);
    let patterns = product(matrices.mass.as_ref(), modes.shapes.as_ref());
    let half = product(damping.as_ref(), patterns.transpose().to_owned().as_ref());
    Ok(product(patterns.as_ref(), half.as_ref()))
}
