//! Adhikari and Woodhouse (3.109-3.118): first-order perturbation of the undamped modes. With shapes turned and scaled so
//! that `U = Re Psi` is mass-normalised and nearly real, `V = Im Psi`, `w_p = Im lambda_p`:
//!
//! ```text
//! B = (U^T U)^-1 U^T V        c'_jp = (w_p^2 - w_j^2) b_jp / w_p, j != p        c'_pp = -2 Re lambda_p
//! C = U (U^T U)^-1 C' (U^T U)^-1 U^T
//! ```
//!
//! The symmetric variant solves `V = U B` under `c'_jp = c'_pj`, that is `b_jp = w_p s_jp` with `s` skew-symmetric off the
//! diagonal. **Needs** complex modes at all DOFs and the mass matrix for their scale. **Limits**: light damping (errors are
//! of second order in `C`); with fewer modes than DOFs what `V` has outside the span of `U` is lost
//! ([`projection_error`], 3.117), and ratios of modes that were not measured are invented.

use super::data::{Damping, ModalData};
use super::error::ClassicalError;
use super::linear::{form, imaginary, real};
use crate::math::eigen::symmetrised;
use crate::math::fill::filled;
use crate::math::least_squares::LeastSquares;
use faer::{Mat, MatRef, c64};

/// Modes turned and scaled for the expansion.
struct Turned {
    u: Mat<f64>,
    v: Mat<f64>,
    /// `Im lambda`, rad/s.
    omega: Vec<f64>,
    /// `-2 Re lambda`, rad/s.
    diagonal: Vec<f64>,
}

/// The original form; `C` is in general not symmetric.
///
/// # Errors
/// [`ClassicalError::Few`], [`ClassicalError::Sizes`], and those of the linear algebra.
pub fn original(m: MatRef<'_, f64>, modes: &ModalData) -> Result<Damping, ClassicalError> {
    let turned = turned(m, modes)?;
    let left = LeastSquares::new(turned.u.as_ref())?.pseudo_inverse();
    let b = &left * &turned.v;
    let w = &turned.omega;
    let modal = filled(w.len(), w.len(), |j, p| {
        if j == p { turned.diagonal[p] } else { (w[p] * w[p] - w[j] * w[j]) * b[(j, p)] / w[p] }
    });
    let mut damping = Damping::viscous(left.transpose() * modal * &left);
    let projection = projection_error(m, modes)?;
    damping.notes.push(format!("{projection:.2} % of the imaginary shapes lie outside the span of the real ones"));
    Ok(damping)
}

/// Most modes of the symmetric variant, whose unknowns are all pairs of them.
const MOST_MODES: usize = 40;

/// The variant whose `C` is symmetric.
///
/// # Errors
/// [`ClassicalError::Missing`] for more than 40 modes; else as [`original`].
pub fn symmetric(m: MatRef<'_, f64>, modes: &ModalData) -> Result<Damping, ClassicalError> {
    if modes.len() > MOST_MODES {
        let what =
            format!("at most {MOST_MODES} complex modes, not {}: its unknowns are all pairs of them", modes.len());
        return Err(ClassicalError::Missing { what });
    }
    let turned = turned(m, modes)?;
    let left = LeastSquares::new(turned.u.as_ref())?.pseudo_inverse();
    let skew = skew_part(&turned)?;
    let w = &turned.omega;
    let modal =
        filled(
            w.len(),
            w.len(),
            |j, p| {
                if j == p { turned.diagonal[p] } else { (w[p] * w[p] - w[j] * w[j]) * skew[(j, p)] }
            },
        );
    let c = left.transpose() * modal * &left;
    Ok(Damping::viscous(symmetrised(c.as_ref())))
}

/// `eps_p` (3.117), per cent: what part of the imaginary shapes the real ones cannot express.
///
/// # Errors
/// As [`original`].
pub fn projection_error(m: MatRef<'_, f64>, modes: &ModalData) -> Result<f64, ClassicalError> {
    let turned = turned(m, modes)?;
    let left = LeastSquares::new(turned.u.as_ref())?.pseudo_inverse();
    let outside = &turned.v - &turned.u * (&left * &turned.v);
    let size = turned.v.norm_l2();
    Ok(if size > 0.0 { 100.0 * outside.norm_l2() / size } else { 0.0 })
}

fn turned(m: MatRef<'_, f64>, modes: &ModalData) -> Result<Turned, ClassicalError> {
    modes.check(m.nrows(), 1)?;
    let n = m.nrows();
    let mut shapes = Mat::zeros(n, modes.len());
    for p in 0..modes.len() {
        let psi: Vec<c64> = super::linear::column(modes.shapes.as_ref(), p);
        // Scaled modes are turned by sqrt(2 i w_d); for any other scale psi^T M psi is made real and positive.
        let scaled = c64::new(1.0, 0.0) / c64::new(0.0, 2.0 * modes.poles[p].im);
        let root = if modes.scaled { scaled.sqrt() } else { form(&psi, m, &psi).sqrt() };
        let straight: Vec<c64> = psi.iter().map(|v| v / root).collect();
        let re: Vec<c64> = straight.iter().map(|v| c64::new(v.re, 0.0)).collect();
        let size = form(&re, m, &re).re.sqrt();
        for i in 0..n {
            shapes[(i, p)] = straight[i] / size;
        }
    }
    Ok(Turned {
        u: real(shapes.as_ref()),
        v: imaginary(shapes.as_ref()),
        omega: modes.poles.iter().map(|l| l.im).collect(),
        diagonal: modes.poles.iter().map(|l| -2.0 * l.re).collect(),
    })
}

/// Skew-symmetric `s` of `b_jp = w_p s_jp` with the least `|V - U B|`; the diagonal of `B` is free.
fn skew_part(turned: &Turned) -> Result<Mat<f64>, ClassicalError> {
    let (n, m) = turned.u.shape();
    let pair = |j: usize, p: usize| p * (p - 1) / 2 + j; // j < p
    let pairs = m * (m.max(1) - 1) / 2;
    let mut rows = Mat::zeros(n * m, pairs + m);
    let mut right = vec![0.0; n * m];
    for p in 0..m {
        for i in 0..n {
            let row = n * p + i;
            right[row] = turned.v[(i, p)];
            rows[(row, pairs + p)] = turned.u[(i, p)];
            for j in (0..m).filter(|&j| j != p) {
                let value = turned.omega[p] * turned.u[(i, j)];
                if j < p {
                    rows[(row, pair(j, p))] += value;
                } else {
                    rows[(row, pair(p, j))] -= value;
                }
            }
        }
    }
    let x = LeastSquares::new(rows.as_ref())?.solve(&right)?.x;
    Ok(filled(m, m, |j, p| match j.cmp(&p) {
        std::cmp::Ordering::Less => x[pair(j, p)],
        std::cmp::Ordering::Equal => 0.0,
        std::cmp::Ordering::Greater => -x[pair(p, j)],
    }))
}
