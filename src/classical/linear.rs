//! Small dense helpers: complex matrices, linear systems, fixed points.

use super::error::ClassicalError;
use crate::math::fill::{filled, filled_complex};
use dashpot_numerics::{ComplexLu, RealLu};
use faer::{Mat, MatRef, c64};
use std::f64::consts::TAU;

/// Inverse of a complex matrix at a frequency (rad/s, for the message).
pub(super) fn inverse(a: MatRef<'_, c64>, what: &'static str, omega: f64) -> Result<Mat<c64>, ClassicalError> {
    let n = a.nrows();
    let identity = filled_complex(n, n, |i, j| c64::new(f64::from(u8::from(i == j)), 0.0));
    let x = ComplexLu::new(a).solve(identity.as_ref());
    let finite = x.col_iter().all(|c| c.iter().all(|v| v.re.is_finite() && v.im.is_finite()));
    if finite { Ok(x) } else { Err(ClassicalError::Singular { what, frequency_hz: omega / TAU }) }
}

/// Solution of `A X = B` for a general real matrix.
pub(super) fn solve(
    a: MatRef<'_, f64>,
    b: MatRef<'_, f64>,
    what: &'static str,
    omega: f64,
) -> Result<Mat<f64>, ClassicalError> {
    let x = RealLu::new(a).solve(b);
    let finite = x.col_iter().all(|c| c.iter().all(|v| v.is_finite()));
    if finite { Ok(x) } else { Err(ClassicalError::Singular { what, frequency_hz: omega / TAU }) }
}

/// The fixed point of `next` from `start`, and a note of the steps taken: at most `steps`, until one changes it by no more than the share
/// `settled`.
pub(super) fn fixed_point(
    start: Mat<f64>,
    steps: usize,
    settled: f64,
    next: impl Fn(&Mat<f64>) -> Result<Mat<f64>, ClassicalError>,
) -> Result<(Mat<f64>, String), ClassicalError> {
    let (mut x, mut change) = (start, f64::INFINITY);
    for step in 1..=steps {
        let new = next(&x)?;
        change = (&new - &x).norm_l2() / new.norm_l2().max(f64::MIN_POSITIVE);
        x = new;
        if change <= settled {
            return Ok((x, format!("settled in {step} steps")));
        }
        if !change.is_finite() {
            break;
        }
    }
    Err(ClassicalError::NoConvergence { steps, change })
}

/// Real part.
pub(super) fn real(a: MatRef<'_, c64>) -> Mat<f64> {
    filled(a.nrows(), a.ncols(), |i, j| a[(i, j)].re)
}

/// Imaginary part.
pub(super) fn imaginary(a: MatRef<'_, c64>) -> Mat<f64> {
    filled(a.nrows(), a.ncols(), |i, j| a[(i, j)].im)
}

/// A real matrix as a complex one.
pub(super) fn complex(a: MatRef<'_, f64>) -> Mat<c64> {
    filled_complex(a.nrows(), a.ncols(), |i, j| c64::new(a[(i, j)], 0.0))
}

/// `K - omega^2 M + i omega C`.
pub(super) fn dynamic_stiffness(m: MatRef<'_, f64>, c: MatRef<'_, f64>, k: MatRef<'_, f64>, omega: f64) -> Mat<c64> {
    filled_complex(m.nrows(), m.ncols(), |i, j| c64::new(k[(i, j)] - omega * omega * m[(i, j)], omega * c[(i, j)]))
}

/// Column `p` of a complex matrix.
pub(super) fn column(a: MatRef<'_, c64>, p: usize) -> Vec<c64> {
    a.col(p).iter().copied().collect()
}

/// `a^T B b` without conjugation, `B` real.
pub(super) fn form(a: &[c64], b: MatRef<'_, f64>, c: &[c64]) -> c64 {
    let mut sum = c64::new(0.0, 0.0);
    for j in 0..c.len() {
        for i in 0..a.len() {
            sum += a[i] * c[j] * b[(i, j)];
        }
    }
    sum
}

/// `B v`, `B` real.
pub(super) fn times(b: MatRef<'_, f64>, v: &[c64]) -> Vec<c64> {
    (0..b.nrows()).map(|i| v.iter().enumerate().map(|(j, x)| x * b[(i, j)]).sum()).collect()
}

/// Index of entry (i, j) of a symmetric matrix in the list of its upper triangle by columns.
pub(super) fn packed(i: usize, j: usize) -> usize {
    let (low, high) = (i.min(j), i.max(j));
    high * (high + 1) / 2 + low
}

/// The symmetric matrix of a packed upper triangle.
pub(super) fn unpacked(values: &[f64], n: usize) -> Mat<f64> {
    filled(n, n, |i, j| values[packed(i, j)])
}
