//! Instrumental variables in Srikantha Phani and Woodhouse's form (3.61-3.67): mass, damping and stiffness together from
//! the full receptance,
//!
//! ```text
//! A [M; C; K] = [I; 0]        A_k = [Re; Im] (-w^2 H, i w H, H)        [M C K]^T_new = (W^T A)^-1 W^T [I; 0]
//! ```
//!
//! starting from least squares (`W = A`); then `W` is `A` made from the receptance of the last estimate, whose errors do not
//! correlate with the noise of the measurement, so that the bias of least squares goes. (The thesis prints the dynamic
//! stiffness for `W`; for `W^T A` to be regular and free of bias it must be made like `A`, with the receptance.)
//! **Needs** the receptance between all DOFs at two lines or more. **Limits**: `Z H = I` needs every mode, as any
//! inversion; few lines away from the resonances say little of `C`.

use super::data::{Damping, ReceptanceData};
use super::error::ClassicalError;
use super::linear::{dynamic_stiffness, fixed_point, inverse, solve};
use crate::math::eigen::symmetrised;
use crate::math::fill::filled;
use crate::math::least_squares::LeastSquares;
use faer::{Mat, c64};

/// Most steps.
const STEPS: usize = 50;
/// Relative change of the estimate at which it has settled.
const SETTLED: f64 = 1e-10;

/// Mass, damping and stiffness of (3.62), symmetrised.
#[derive(Debug, Clone, PartialEq)]
pub struct Identified {
    /// Mass, n x n, kg.
    pub mass: Mat<f64>,
    /// Damping.
    pub damping: Damping,
    /// Stiffness, n x n, N/m.
    pub stiffness: Mat<f64>,
}

/// The instrumental-variable estimate.
///
/// # Errors
/// [`ClassicalError::Few`] below two lines; [`ClassicalError::Singular`]; [`ClassicalError::NoConvergence`].
pub fn instrumental(receptance: &ReceptanceData) -> Result<Identified, ClassicalError> {
    receptance.check(2)?;
    let n = receptance.degrees();
    let reference = receptance.omega.iter().copied().fold(0.0, f64::max);
    let a = stacked(&receptance.omega, &receptance.matrices, reference);
    let right = identities(n, receptance.omega.len());
    let start = LeastSquares::new(a.as_ref())?.pseudo_inverse() * &right;
    let next = |x: &Mat<f64>| -> Result<Mat<f64>, ClassicalError> {
        let instruments = stacked(&receptance.omega, &modelled(x, receptance, reference)?, reference);
        let (normal, load) = (instruments.transpose() * &a, instruments.transpose() * &right);
        solve(normal.as_ref(), load.as_ref(), "the instrumental matrix", 0.0)
    };
    let (x, steps) = fixed_point(start, STEPS, SETTLED, next)?;
    let mut identified = split(&x, n, reference);
    identified.damping.notes.push(steps);
    Ok(identified)
}

/// Rows `[Re; Im] (-w^2/r^2 H, i w/r H, H)` of all lines, `r` a reference frequency that makes the unknowns alike.
fn stacked(omega: &[f64], matrices: &[Mat<c64>], reference: f64) -> Mat<f64> {
    let n = matrices[0].nrows();
    let mut a = Mat::zeros(2 * n * omega.len(), 3 * n);
    for (k, (&w, h)) in omega.iter().zip(matrices).enumerate() {
        let ratio = w / reference;
        let factors = [c64::new(-ratio * ratio, 0.0), c64::new(0.0, ratio), c64::new(1.0, 0.0)];
        for (block, factor) in factors.into_iter().enumerate() {
            for j in 0..n {
                for i in 0..n {
                    let value = factor * h[(i, j)];
                    a[(2 * n * k + i, n * block + j)] = value.re;
                    a[(2 * n * k + n + i, n * block + j)] = value.im;
                }
            }
        }
    }
    a
}

fn identities(n: usize, lines: usize) -> Mat<f64> {
    filled(2 * n * lines, n, |i, j| f64::from(u8::from(i % (2 * n) == j)))
}

/// Receptance of an estimate at every line.
fn modelled(x: &Mat<f64>, receptance: &ReceptanceData, reference: f64) -> Result<Vec<Mat<c64>>, ClassicalError> {
    let one = split(x, receptance.degrees(), reference);
    let (m, c, k) = (one.mass.as_ref(), one.damping.viscous.as_ref(), one.stiffness.as_ref());
    let model = |&w: &f64| inverse(dynamic_stiffness(m, c, k, w).as_ref(), "the dynamic stiffness", w);
    receptance.omega.iter().map(model).collect()
}

/// Unknowns back to kg, N s/m, N/m.
fn split(x: &Mat<f64>, n: usize, reference: f64) -> Identified {
    let block = |b: usize, scale: f64| {
        let matrix = filled(n, n, |i, j| x[(n * b + i, j)] / scale);
        symmetrised(matrix.as_ref())
    };
    Identified {
        mass: block(0, reference * reference),
        damping: Damping::viscous(block(1, reference)),
        stiffness: block(2, 1.0),
    }
}
