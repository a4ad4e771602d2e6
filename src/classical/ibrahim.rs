//! Ibrahim (3.97-3.105): measured complex modes completed by the model's normal modes,
//!
//! ```text
//! [M^-1 K  M^-1 C] [psi; lambda psi] = -lambda^2 psi        measured modes, p <= m
//! the same with the model's phi_p and lambda_p = w_p (-zeta + i sqrt(1 - zeta^2)), p > m
//! ```
//!
//! `zeta` being the mean measured ratio. The normal modes of `M^-1 K` then correct the mass matrix by least change (3.103),
//! and `C = M [M^-1 C]`, symmetrised. **Needs** mass, stiffness and complex modes at all DOFs. **Limits**: the modes
//! above the measured ones get the mean damping of those measured, whatever theirs is.

use super::data::{Damping, ModalData};
use super::error::ClassicalError;
use super::linear::column;
use crate::math::eigen::{least_eigenvalue, real_general, symmetrised};
use crate::math::fill::filled;
use crate::math::least_squares::{LeastSquares, solve_symmetric};
use crate::structure::modes::Modes;
use faer::{Mat, MatRef, c64};

/// Least eigenvalue of the modal mass below which two shapes are one.
const DISTINCT: f64 = 1e-6;

/// `C` from measured modes and the undamped modes of the model.
///
/// # Errors
/// [`ClassicalError::Few`], [`ClassicalError::Sizes`], and those of the linear algebra.
pub fn ibrahim(m: MatRef<'_, f64>, model: &Modes, modes: &ModalData) -> Result<Damping, ClassicalError> {
    let n = m.nrows();
    modes.check(n, 1)?;
    let (rows, right) = equations(model, modes);
    // X = [(M^-1 K)^T; (M^-1 C)^T].
    let x = LeastSquares::new(rows.as_ref())?.pseudo_inverse() * &right;
    let stiffness = filled(n, n, |i, j| x[(j, i)]);
    let damping = filled(n, n, |i, j| x[(n + j, i)]);
    let corrected = corrected_mass(m, stiffness.as_ref())?;
    let mut outcome = Damping::viscous(symmetrised((&corrected * &damping).as_ref()));
    if modes.len() < n {
        outcome.notes.push(format!(
            "{} modes of the model above those measured have the mean damping ratio {:.3e}",
            n - modes.len(),
            mean_ratio(modes)
        ));
    }
    Ok(outcome)
}

fn mean_ratio(modes: &ModalData) -> f64 {
    (0..modes.len()).map(|p| modes.damping_ratio(p)).sum::<f64>() / modes.len() as f64
}

/// Real and imaginary rows `[psi^T  lambda psi^T]` and `-lambda^2 psi^T`, each mode scaled to `lambda^2 psi` of unit length.
fn equations(model: &Modes, modes: &ModalData) -> (Mat<f64>, Mat<f64>) {
    let n = modes.degrees();
    let zeta = mean_ratio(modes);
    let measured = (0..modes.len()).map(|p| (modes.poles[p], column(modes.shapes.as_ref(), p)));
    let assumed = (modes.len()..n).map(|p| {
        let lambda = c64::new(-zeta, (1.0 - zeta * zeta).max(0.0).sqrt()) * model.omega[p];
        (lambda, model.shape(p).into_iter().map(|v| c64::new(v, 0.0)).collect())
    });
    let all: Vec<(c64, Vec<c64>)> = measured.chain(assumed).collect();
    let mut rows = Mat::zeros(2 * all.len(), 2 * n);
    let mut right = Mat::zeros(2 * all.len(), n);
    for (p, (lambda, psi)) in all.iter().enumerate() {
        let size = psi.iter().map(c64::norm_sqr).sum::<f64>().sqrt() * lambda.norm_sqr();
        for j in 0..n {
            let value = psi[j] / size;
            let (speed, acceleration) = (value * lambda, value * lambda * lambda);
            rows[(2 * p, j)] = value.re;
            rows[(2 * p + 1, j)] = value.im;
            rows[(2 * p, n + j)] = speed.re;
            rows[(2 * p + 1, n + j)] = speed.im;
            right[(2 * p, j)] = -acceleration.re;
            right[(2 * p + 1, j)] = -acceleration.im;
        }
    }
    (rows, right)
}

/// Mass of least change to which the normal modes of `M^-1 K` are orthogonal (3.102, 3.103).
fn corrected_mass(m: MatRef<'_, f64>, stiffness: MatRef<'_, f64>) -> Result<Mat<f64>, ClassicalError> {
    let n = m.nrows();
    let (_, vectors) = real_general(stiffness)?;
    let mut phi = filled(n, n, |i, j| vectors[(i, j)].re);
    for j in 0..n {
        let size = (phi.col(j).transpose() * m * phi.col(j)).sqrt();
        for i in 0..n {
            phi[(i, j)] /= size;
        }
    }
    let modal = symmetrised((phi.transpose() * m * &phi).as_ref());
    if least_eigenvalue(modal.as_ref()) < DISTINCT {
        let what = "natural frequencies that all differ: the shapes of equal ones cannot be told apart".to_string();
        return Err(ClassicalError::Missing { what });
    }
    let identity = Mat::<f64>::identity(n, n);
    let inverse = solve_symmetric(modal.as_ref(), identity.as_ref())?;
    let middle = &inverse * (&identity - &modal) * &inverse;
    let change = m * &phi * middle * phi.transpose() * m;
    Ok(symmetrised((m + change).as_ref()))
}
