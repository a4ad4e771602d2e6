//! Damped modes: `(lambda^2 M + lambda C + K) psi = 0` (2.69, 2.70), scaled so that `psi^T (2 lambda M + C) psi = 1`.
//!
//! In undamped modal coordinates `x = Phi q`, with `z = (Omega q, q')`, the problem is the standard one
//!
//! ```text
//! z' = [ 0  Omega ; -Omega  -Phi^T C Phi ] z
//! ```
//!
//! which is skew-symmetric but for the damping: well balanced whatever the units, and singular nowhere (a rigid body mode
//! only loses its row of `Omega q`). A mode without stiffness has the pole 0 beside that of its damping.

use super::error::StructureError;
use super::matrices::SystemMatrices;
use super::modes;
use super::modes::{Modes, failure};
use crate::math::eigen;
use dashpot_numerics::{product, transposed_product};
use faer::{ColRef, Mat, MatRef, c64};
use std::f64::consts::TAU;

/// Poles below this part of the largest are those of rigid bodies.
const ZERO_POLE: f64 = 1e-12;

/// Relative distance of poles that count as one.
const SAME_POLE: f64 = 1e-10;
/// Square of the part of a shape that another one leaves, below which the two are parallel.
const PARALLEL: f64 = 1e-10;

/// One damped mode: a pair of complex poles, given by the one above the real axis, or one real (overdamped) pole.
#[derive(Debug, Clone, PartialEq)]
pub struct DampedMode {
    /// Pole, rad/s; 0 for a rigid body mode.
    pub lambda: c64,
    /// `|lambda| / 2 pi`, Hz.
    pub frequency_hz: f64,
    /// `-Re lambda / |lambda|`: 1 for an overdamped pole, 0 for a rigid body mode.
    pub damping_ratio: f64,
    /// Shape, n values, `psi^T (2 lambda M + C) psi = 1`; mass-normalised for a rigid body mode.
    pub shape: Vec<c64>,
}

/// First-order change of a pole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoleChange {
    /// Of the pole, rad/s.
    pub lambda: c64,
    /// Of `|lambda| / 2 pi`, Hz.
    pub frequency_hz: f64,
    /// Of the damping ratio.
    pub damping_ratio: f64,
}

impl DampedMode {
    fn new(lambda: c64, shape: Vec<c64>) -> Self {
        let magnitude = lambda.norm();
        let damping_ratio = if magnitude > 0.0 { -lambda.re / magnitude } else { 0.0 };
        Self { lambda, frequency_hz: magnitude / TAU, damping_ratio, shape }
    }

    /// Whether the pole is real: the motion dies out without oscillating.
    pub fn is_overdamped(&self) -> bool {
        self.lambda.im == 0.0 && self.lambda.re != 0.0
    }

    /// Derivatives by a damping coefficient `c_j` with `C = sum c_j C_j`, given `form = psi^T C_j psi`, which is
    /// `(L_j^T psi)^2` for a dashpot: `d lambda / d c_j = -lambda psi^T C_j psi`.
    pub fn sensitivity(&self, form: c64) -> PoleChange {
        let magnitude = self.lambda.norm();
        if magnitude == 0.0 {
            return PoleChange { lambda: c64::new(0.0, 0.0), frequency_hz: 0.0, damping_ratio: 0.0 };
        }
        let lambda = -self.lambda * form;
        let d_magnitude = (self.lambda.conj() * lambda).re / magnitude;
        PoleChange {
            lambda,
            frequency_hz: d_magnitude / TAU,
            damping_ratio: (self.lambda.re * d_magnitude / magnitude - lambda.re) / magnitude,
        }
    }

    /// `psi^T B psi` for a real n x n matrix `B`: the `form` of [`DampedMode::sensitivity`] for any damping matrix.
    pub fn quadratic_form(&self, b: MatRef<'_, f64>) -> c64 {
        let mut sum = c64::new(0.0, 0.0);
        for (j, right) in self.shape.iter().enumerate() {
            for (i, left) in self.shape.iter().enumerate() {
                sum += left * right * b[(i, j)];
            }
        }
        sum
    }
}

/// Damped modes of `M x'' + C x' + K x = 0`, all n x n, in ascending order of `|lambda|`; conjugate pairs count once.
///
/// # Errors
/// Those of [`modes::modes`] and of [`damped_modes_from`].
pub fn damped_modes(
    m: MatRef<'_, f64>,
    k: MatRef<'_, f64>,
    c: MatRef<'_, f64>,
) -> Result<Vec<DampedMode>, StructureError> {
    let undamped = modes::modes(&SystemMatrices { mass: m.to_owned(), stiffness: k.to_owned() })?;
    damped_modes_from(&undamped, c)
}

/// [`damped_modes`] from undamped modes that are already known.
///
/// # Errors
/// [`StructureError::DampingSize`] when `C` differs in size; [`StructureError::Modes`] when the iteration fails.
pub fn damped_modes_from(undamped: &Modes, c: MatRef<'_, f64>) -> Result<Vec<DampedMode>, StructureError> {
    let modal = modal_matrix(undamped, c)?;
    let rigid = undamped.omega.iter().take_while(|&&w| w == 0.0).count();
    let state = state_matrix(&undamped.omega, rigid, &modal);
    let (values, vectors) = eigen::real_general(state.as_ref()).map_err(|e| failure(&e))?;
    let largest = values.iter().fold(0.0_f64, |l, v| l.max(v.norm()));
    let smallest = if rigid > 0 { ZERO_POLE * largest } else { 0.0 };
    let kept: Vec<usize> = (0..values.len()).filter(|&r| values[r].im >= 0.0 && values[r].norm() > smallest).collect();
    let mut modal_shapes: Vec<Vec<c64>> = Vec::new();
    for (place, &r) in kept.iter().enumerate() {
        let mut q = displacement(&undamped.omega, rigid, values[r], vectors.col(r));
        normalise(&mut q, values[r], &modal);
        let alike = |&p: &usize| (values[kept[p]] - values[r]).norm() <= SAME_POLE * values[r].norm();
        for p in (0..place).filter(alike) {
            separate(&mut q, &modal_shapes[p], values[r], &modal);
        }
        modal_shapes.push(q);
    }
    let still = (0..rigid).map(|r| {
        let shape = undamped.shapes.col(r).iter().map(|&v| c64::new(v, 0.0)).collect();
        DampedMode::new(c64::new(0.0, 0.0), shape)
    });
    let moving =
        kept.iter().zip(physical(undamped, &modal_shapes)).map(|(&r, shape)| DampedMode::new(values[r], shape));
    let mut result: Vec<DampedMode> = still.chain(moving).collect();
    result.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    Ok(result)
}

/// `[0 Omega; -Omega -C]` without the rows of `Omega q` of the first `rigid` modes.
fn state_matrix(omega: &[f64], rigid: usize, modal: &Mat<f64>) -> Mat<f64> {
    let (n, elastic) = (omega.len(), omega.len() - rigid);
    let mut state = Mat::<f64>::zeros(elastic + n, elastic + n);
    for r in 0..elastic {
        state[(r, elastic + rigid + r)] = omega[rigid + r];
        state[(elastic + rigid + r, r)] = -omega[rigid + r];
    }
    for j in 0..n {
        for i in 0..n {
            state[(elastic + i, elastic + j)] = -modal[(i, j)];
        }
    }
    state
}

/// Modal displacement `q` from a state `(Omega q, q')`: of the two ways, the one that divides by the larger number.
fn displacement(omega: &[f64], rigid: usize, lambda: c64, state: ColRef<'_, c64>) -> Vec<c64> {
    let elastic = omega.len() - rigid;
    (0..omega.len())
        .map(|i| {
            if i >= rigid && omega[i] > lambda.norm() {
                state[i - rigid] / omega[i]
            } else {
                state[elastic + i] / lambda
            }
        })
        .collect()
}

/// `Phi^T C Phi`.
fn modal_matrix(undamped: &Modes, c: MatRef<'_, f64>) -> Result<Mat<f64>, StructureError> {
    let n = undamped.shapes.nrows();
    if c.shape() != (n, n) {
        return Err(StructureError::DampingSize { rows: c.nrows(), columns: c.ncols(), size: n });
    }
    let modal = transposed_product(undamped.shapes.as_ref(), product(c, undamped.shapes.as_ref()).as_ref());
    Ok(eigen::symmetrised(modal.as_ref()))
}

/// Takes the part of `other` out of `q`, a shape of the same pole: what a solver gives there is any basis, and a receptance is
/// the sum over shapes with `psi_p^T (2 lambda M + C) psi_q = 0`. Shapes of a defective pole are parallel and stay.
fn separate(q: &mut [c64], other: &[c64], lambda: c64, modal: &Mat<f64>) {
    let mut product = lambda * 2.0 * q.iter().zip(other).map(|(a, b)| a * b).sum::<c64>();
    for (j, right) in q.iter().enumerate() {
        let column: c64 = other.iter().enumerate().map(|(i, left)| left * modal[(i, j)]).sum();
        product += column * right;
    }
    let size = |v: &[c64]| v.iter().map(c64::norm_sqr).sum::<f64>();
    let mut rest: Vec<c64> = q.iter().zip(other).map(|(a, b)| a - product * b).collect();
    if size(&rest) > PARALLEL * size(q) {
        normalise(&mut rest, lambda, modal);
        q.copy_from_slice(&rest);
    }
}

/// Scales modal coordinates so that `2 lambda q^T q + q^T C q = 1`.
fn normalise(q: &mut [c64], lambda: c64, modal: &Mat<f64>) {
    let size = q.iter().map(c64::norm_sqr).sum::<f64>().sqrt();
    if size > 0.0 {
        scale(q, c64::new(1.0 / size, 0.0));
    }
    let mut a = lambda * 2.0 * q.iter().map(|v| v * v).sum::<c64>();
    for (j, right) in q.iter().enumerate() {
        let column: c64 = q.iter().enumerate().map(|(i, left)| left * modal[(i, j)]).sum();
        a += column * right;
    }
    // Zero only for a defective pole (critical damping), whose shape keeps unit length.
    if a.norm() > 0.0 {
        scale(q, c64::new(1.0, 0.0) / a.sqrt());
    }
}

fn scale(q: &mut [c64], factor: c64) {
    for v in q {
        *v *= factor;
    }
}

/// Shapes `Phi q`, for all modes in one product.
fn physical(undamped: &Modes, modal_shapes: &[Vec<c64>]) -> Vec<Vec<c64>> {
    let n = undamped.shapes.nrows();
    let part = |pick: fn(&c64) -> f64| {
        let q = Mat::from_fn(undamped.len(), modal_shapes.len(), |i, j| pick(&modal_shapes[j][i]));
        product(undamped.shapes.as_ref(), q.as_ref())
    };
    let (re, im) = (part(|v| v.re), part(|v| v.im));
    (0..modal_shapes.len()).map(|j| (0..n).map(|i| c64::new(re[(i, j)], im[(i, j)])).collect()).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use faer::mat;

    #[test]
    fn one_degree_of_freedom_under_and_over_critical() {
        let (m, k) = (mat![[2.0]], mat![[50.0]]); // omega = 5, critical c = 20
        let under = damped_modes(m.as_ref(), k.as_ref(), mat![[2.0]].as_ref()).unwrap();
        assert_eq!(under.len(), 1);
        assert!((under[0].damping_ratio - 0.1).abs() < 1e-14);
        assert!((under[0].frequency_hz * TAU - 5.0).abs() < 1e-13);
        let over = damped_modes(m.as_ref(), k.as_ref(), mat![[52.0]].as_ref()).unwrap();
        assert_eq!(over.len(), 2); // -1 and -25
        assert!(over.iter().all(DampedMode::is_overdamped));
        assert!((over[0].lambda.re + 1.0).abs() < 1e-13 && (over[1].lambda.re + 25.0).abs() < 1e-12);
    }

    #[test]
    fn rigid_body_with_a_damper_to_the_ground() {
        let (m, k) = (mat![[1.0, 0.0], [0.0, 1.0]], mat![[100.0, -100.0], [-100.0, 100.0]]);
        let c = mat![[0.2, 0.0], [0.0, 0.2]];
        let found = damped_modes(m.as_ref(), k.as_ref(), c.as_ref()).unwrap();
        assert_eq!(found.len(), 3);
        assert_eq!(found[0].lambda, c64::new(0.0, 0.0));
        assert!((found[1].lambda.re + 0.2).abs() < 1e-12 && found[1].is_overdamped());
        assert!((found[2].frequency_hz * TAU - 200f64.sqrt()).abs() < 1e-10);
        let free = damped_modes(m.as_ref(), k.as_ref(), Mat::zeros(2, 2).as_ref()).unwrap();
        assert_eq!(free.len(), 2);
    }
}
