//! Lancaster's formula (3.82-3.91): `C` as a sum over complex modes,
//!
//! ```text
//! C = -2 M sum_p Re(psi_p lambda_p^2 psi_p^T) M        psi^T (2 lambda M + C) psi = 1
//! ```
//!
//! **Needs** the mass matrix and complex modes *scaled as above*: residues of a receptance with a drive-point sensor are;
//! other modes are scaled by [`super::pilkey_inman`]. **Limits**: the sum is over all modes; a truncated one
//! gives back the measured poles exactly, but the rest is undamped and the matrix is in general indefinite: some motions
//! would gain energy. Errors of the phases of the shapes enter multiplied by `lambda^2`.

use super::data::{Damping, ModalData};
use super::error::ClassicalError;
use super::linear::column;
use faer::{Mat, MatRef};

/// `C` of (3.91).
///
/// # Errors
/// [`ClassicalError::Missing`] for modes of unknown scale; [`ClassicalError::Few`], [`ClassicalError::Sizes`].
pub fn lancaster(m: MatRef<'_, f64>, modes: &ModalData) -> Result<Damping, ClassicalError> {
    modes.check(m.nrows(), 1)?;
    if !modes.scaled {
        let what = "scaled complex modes: measure the drive point, or use Pilkey and Inman's method".to_string();
        return Err(ClassicalError::Missing { what });
    }
    Ok(Damping::viscous(sum(m, modes)))
}

/// `-2 M sum Re(psi lambda^2 psi^T) M` at the scale as given.
pub(super) fn sum(m: MatRef<'_, f64>, modes: &ModalData) -> Mat<f64> {
    let n = m.nrows();
    let mut inner = Mat::<f64>::zeros(n, n);
    for (p, &lambda) in modes.poles.iter().enumerate() {
        let psi = column(modes.shapes.as_ref(), p);
        let square = lambda * lambda;
        for j in 0..n {
            let right = square * psi[j];
            for i in 0..n {
                inner[(i, j)] -= 2.0 * (psi[i] * right).re;
            }
        }
    }
    m * inner * m
}
