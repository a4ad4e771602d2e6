//! Minas and Inman (3.106-3.108): the entries of a symmetric `C` from the eigenvalue problem itself,
//!
//! ```text
//! C psi_p = -(lambda_p M + K / lambda_p) psi_p        real and imaginary parts, 2 n m rows, n (n + 1) / 2 unknowns
//! ```
//!
//! by least squares, each mode scaled to unit length. **Needs** mass, stiffness and complex modes at all DOFs (or matrices
//! reduced to the DOFs measured). **Limits**: with fewer modes than DOFs the rows do not fix all entries and
//! the shortest solution is taken; errors of `M` and `K` all end in `C`; a reduced model is stiffer than the structure.

use super::data::{Damping, ModalData};
use super::error::ClassicalError;
use super::linear::{column, packed, times, unpacked};
use crate::math::least_squares::LeastSquares;
use faer::{Mat, MatRef};

/// Most DOFs: above, the unknowns are too many for a dense solution.
pub const MOST_DEGREES: usize = 40;

/// `C` of (3.108).
///
/// # Errors
/// [`ClassicalError::TooLarge`], [`ClassicalError::Few`], [`ClassicalError::Sizes`], and those of the linear algebra.
pub fn minas_inman(m: MatRef<'_, f64>, k: MatRef<'_, f64>, modes: &ModalData) -> Result<Damping, ClassicalError> {
    let n = m.nrows();
    modes.check(n, 1)?;
    if n > MOST_DEGREES {
        return Err(ClassicalError::TooLarge { limit: MOST_DEGREES, found: n });
    }
    let unknowns = n * (n + 1) / 2;
    let mut rows = Mat::zeros(2 * n * modes.len(), unknowns);
    let mut right = vec![0.0; rows.nrows()];
    for (p, &lambda) in modes.poles.iter().enumerate() {
        let psi = column(modes.shapes.as_ref(), p);
        let size = psi.iter().map(faer::c64::norm_sqr).sum::<f64>().sqrt();
        let (mass, stiffness) = (times(m, &psi), times(k, &psi));
        for i in 0..n {
            let at = 2 * (n * p + i);
            for (j, value) in psi.iter().enumerate() {
                rows[(at, packed(i, j))] += value.re / size;
                rows[(at + 1, packed(i, j))] += value.im / size;
            }
            let force = -(mass[i] * lambda + stiffness[i] / lambda) / size;
            right[at] = force.re;
            right[at + 1] = force.im;
        }
    }
    let problem = LeastSquares::new(rows.as_ref())?;
    let mut damping = Damping::viscous(unpacked(&problem.solve(&right)?.x, n));
    if problem.rank() < unknowns {
        let note = format!("{} of {unknowns} entries are fixed by the modes; the shortest solution", problem.rank());
        damping.notes.push(note);
    }
    Ok(damping)
}
