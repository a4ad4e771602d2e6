//! Fritzen's instrumental-variable method (3.60, 3.63) on the equation of motion of any harmonic loads,
//!
//! ```text
//! (K + i w C - w^2 M) x = f        A p = b, p the entries of symmetric M, C and K
//! p_new = (W^T A)^-1 W^T b         W like A, with the motion that the last estimate predicts in place of the measured one
//! ```
//!
//! **Needs** the motion of *all* DOFs under known harmonic forces, 3 (n + 1) / 4 loads or more at different frequencies; one
//! exciter will do. **Limits**: every DOF must be measured; the loads must bring out every mode.

use super::data::{Damping, LoadCase};
use super::error::ClassicalError;
use super::instrumental::Identified;
use super::linear::{dynamic_stiffness, fixed_point, inverse, packed, solve, unpacked};
use crate::math::fill::filled;
use crate::math::least_squares::LeastSquares;
use faer::{Mat, c64};

/// Most DOFs: above, the unknowns are too many for a dense solution.
pub const MOST_DEGREES: usize = 20;
/// Most steps.
const STEPS: usize = 50;
/// Relative change of the estimate at which it has settled.
const SETTLED: f64 = 1e-9;

/// Mass, damping and stiffness from load cases.
///
/// # Errors
/// [`ClassicalError::Few`], [`ClassicalError::TooLarge`], [`ClassicalError::NoConvergence`], [`ClassicalError::Singular`].
pub fn fritzen(loads: &[LoadCase]) -> Result<Identified, ClassicalError> {
    let n = loads.first().map_or(0, |load| load.displacement.len());
    let needed = (3 * (n + 1)).div_ceil(4).max(2);
    if loads.len() < needed {
        let what = "harmonic loads with the motion of every DOF";
        return Err(ClassicalError::Few { what, needed, found: loads.len() });
    }
    if n > MOST_DEGREES {
        return Err(ClassicalError::TooLarge { limit: MOST_DEGREES, found: n });
    }
    let reference = loads.iter().map(|load| load.omega).fold(0.0, f64::max);
    let motion: Vec<Vec<c64>> = loads.iter().map(|load| load.displacement.clone()).collect();
    let (a, b) = (rows(loads, &motion, reference), right(loads));
    let start = LeastSquares::new(a.as_ref())?;
    if start.rank() < a.ncols() {
        let what = "loads that bring out every mode at different frequencies".to_string();
        return Err(ClassicalError::Missing { what });
    }
    let (x, b) = (start.solve(&b)?.x, filled(b.len(), 1, |i, _| b[i]));
    // Columns of unit length keep the normal matrix regular.
    let scale: Vec<f64> = (0..a.ncols()).map(|j| a.col(j).norm_l2().max(f64::MIN_POSITIVE)).collect();
    let scaled = |m: &Mat<f64>| filled(m.nrows(), m.ncols(), |i, j| m[(i, j)] / scale[j]);
    let tall = scaled(&a);
    let next = |p: &Mat<f64>| -> Result<Mat<f64>, ClassicalError> {
        let wide = scaled(&rows(loads, &predicted(p, loads, n, reference)?, reference));
        let normal = wide.transpose() * &tall;
        let y = solve(normal.as_ref(), (wide.transpose() * &b).as_ref(), "the instrumental matrix", 0.0)?;
        Ok(filled(a.ncols(), 1, |i, _| y[(i, 0)] / scale[i]))
    };
    let (p, steps) = fixed_point(filled(a.ncols(), 1, |i, _| x[i]), STEPS, SETTLED, next)?;
    let mut identified = split(&p, n, reference);
    identified.damping.notes.push(steps);
    Ok(identified)
}

/// Real and imaginary rows of the equation of motion for the packed entries of `r^2 M`, `r C` and `K`.
fn rows(loads: &[LoadCase], motion: &[Vec<c64>], reference: f64) -> Mat<f64> {
    let n = motion[0].len();
    let entries = n * (n + 1) / 2;
    let mut a = Mat::zeros(2 * n * loads.len(), 3 * entries);
    for (k, (load, x)) in loads.iter().zip(motion).enumerate() {
        let (ratio, size) = (load.omega / reference, weight(load));
        let factors = [c64::new(-ratio * ratio, 0.0), c64::new(0.0, ratio), c64::new(1.0, 0.0)];
        for i in 0..n {
            let row = 2 * (n * k + i);
            for (j, value) in x.iter().enumerate() {
                for (block, factor) in factors.iter().enumerate() {
                    let term = factor * value * size;
                    a[(row, entries * block + packed(i, j))] += term.re;
                    a[(row + 1, entries * block + packed(i, j))] += term.im;
                }
            }
        }
    }
    a
}

/// Loads count alike whatever their force.
fn weight(load: &LoadCase) -> f64 {
    1.0 / load.force.iter().map(c64::norm_sqr).sum::<f64>().sqrt().max(f64::MIN_POSITIVE)
}

fn right(loads: &[LoadCase]) -> Vec<f64> {
    let values = loads.iter().flat_map(|load| load.force.iter().map(move |f| f * weight(load)));
    values.flat_map(|f| [f.re, f.im]).collect()
}

/// Motion that an estimate predicts under every load.
fn predicted(p: &Mat<f64>, loads: &[LoadCase], n: usize, reference: f64) -> Result<Vec<Vec<c64>>, ClassicalError> {
    let one = split(p, n, reference);
    let (m, c, k) = (one.mass.as_ref(), one.damping.viscous.as_ref(), one.stiffness.as_ref());
    loads
        .iter()
        .map(|load| {
            let h = inverse(dynamic_stiffness(m, c, k, load.omega).as_ref(), "the dynamic stiffness", load.omega)?;
            Ok((0..n).map(|i| (0..n).map(|j| h[(i, j)] * load.force[j]).sum()).collect())
        })
        .collect()
}

fn split(p: &Mat<f64>, n: usize, reference: f64) -> Identified {
    let entries = n * (n + 1) / 2;
    let block = |b: usize, scale: f64| {
        let values: Vec<f64> = (0..entries).map(|i| p[(entries * b + i, 0)] / scale).collect();
        unpacked(&values, n)
    };
    Identified {
        mass: block(0, reference * reference),
        damping: Damping::viscous(block(1, reference)),
        stiffness: block(2, 1.0),
    }
}
