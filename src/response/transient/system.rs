//! The linear part in its damped modes: each coordinate moves by itself, for any length of step.
//!
//! ```text
//! y = [s p; p'],   y' = A y + B f,   A V = V Lambda,   z = V^-1 y,   z_k' = lambda_k z_k + beta_k f
//! ```
//!
//! with `M p'' + C p' + K p = B f` in reduced coordinates. Of each conjugate pair one is kept: `y = Re sum_k w_k V_k z_k`,
//! `w_k = 2`, or 1 for a real eigenvalue. A parameter of `M, C, K` adds `A_theta y + B_theta f` to the motion of its
//! derivative; in damped modes that is `sum_j (P_kj z_j + Q_kj conj z_j)`.

use super::error::TransientError;
use dashpot_numerics::{Cholesky, ComplexLu, product, real_general};
use faer::{Mat, c64};

/// Frequency given to rigid body coordinates, as a share of the greatest frequency.
const RIGID: f64 = 1e-7;

/// Reduced matrices, coordinates x coordinates.
#[derive(Debug, Clone)]
pub(super) struct Matrices {
    pub mass: Mat<f64>,
    pub damping: Mat<f64>,
    pub stiffness: Mat<f64>,
}

impl Matrices {
    pub(super) fn zeros(size: usize) -> Self {
        let zeros = Mat::zeros(size, size);
        Self { mass: zeros.clone(), damping: zeros.clone(), stiffness: zeros }
    }

    /// Natural frequency of each coordinate by itself, rad/s.
    pub(super) fn frequencies(&self) -> Vec<f64> {
        let square = |r: usize| self.stiffness[(r, r)] / self.mass[(r, r)];
        (0..self.mass.nrows()).map(|r| square(r).max(0.0).sqrt()).collect()
    }
}

/// A linear functional of the state: what a sensor or an element sees.
#[derive(Debug, Clone)]
pub(super) struct Functional {
    /// On a flat state: `Re sum_k c_k z_k`.
    pub row: Vec<f64>,
    /// On the inputs: only accelerations feel forces at once.
    pub inputs: Vec<f64>,
}

/// How the linear part changes with one parameter.
#[derive(Debug, Clone)]
pub(super) struct LinearChange {
    /// `P`, kept x kept, row by row.
    pub direct: Vec<c64>,
    /// `Q`, kept x kept; zero columns for real eigenvalues.
    pub conjugate: Vec<c64>,
    /// Derivative of `beta`, one list an input.
    pub inputs: Vec<Vec<c64>>,
    /// `A_theta` below, coordinates x 2 coordinates.
    rates: Mat<f64>,
    /// `B_theta` below, coordinates x inputs.
    pushes: Mat<f64>,
}

/// The eigendecomposition.
#[derive(Debug, Clone)]
pub(super) struct LinearSystem {
    pub lambda: Vec<c64>,
    /// Weight of each kept mode, 2 or 1.
    weight: Vec<f64>,
    /// Rows of `V^-1` of the kept modes.
    forward: Mat<c64>,
    /// Columns of `V` of the kept modes.
    backward: Mat<c64>,
    /// `beta`, one list an input; and flat.
    pub beta: Vec<Vec<c64>>,
    pub patterns: Vec<Vec<f64>>,
    /// Scale of displacements, rad/s.
    scale: Vec<f64>,
    /// `[A_21 A_22]`, coordinates x 2 coordinates.
    rates: Mat<f64>,
    /// `M^-1 B`, coordinates x inputs.
    pushes: Mat<f64>,
    stiffness: Mat<f64>,
    damping: Mat<f64>,
    mass: Cholesky,
}

impl LinearSystem {
    /// Of the reduced matrices and force patterns (coordinates x inputs).
    pub(super) fn new(matrices: &Matrices, patterns: &Mat<f64>) -> Result<Self, TransientError> {
        let m = matrices.mass.nrows();
        let mass = Cholesky::new(matrices.mass.as_ref()).ok_or(TransientError::NotPositive)?;
        let mut stiffness = matrices.stiffness.clone();
        let greatest = (0..m).fold(0.0_f64, |g, r| g.max(stiffness[(r, r)])).sqrt().max(1e-6);
        for r in 0..m {
            stiffness[(r, r)] = stiffness[(r, r)].max((RIGID * greatest).powi(2));
        }
        let scale: Vec<f64> = (0..m).map(|r| stiffness[(r, r)].abs().sqrt()).collect();
        let (k, c) = (mass.solve(stiffness.as_ref()), mass.solve(matrices.damping.as_ref()));
        let rates = Mat::from_fn(m, 2 * m, |i, j| if j < m { -k[(i, j)] / scale[j] } else { -c[(i, j - m)] });
        let a = Mat::from_fn(2 * m, 2 * m, |i, j| match i {
            i if i < m => scale[i] * f64::from(u8::from(j == i + m)),
            i => rates[(i - m, j)],
        });
        let (values, vectors, inverse) = decomposed(&a, greatest)?;
        let kept: Vec<usize> = (0..2 * m).filter(|&k| values[k].im >= 0.0).collect();
        let forward = Mat::from_fn(kept.len(), 2 * m, |k, j| inverse[(kept[k], j)]);
        let backward = Mat::from_fn(2 * m, kept.len(), |i, k| vectors[(i, kept[k])]);
        let lambda: Vec<c64> = kept.iter().map(|&k| values[k]).collect();
        let weight = lambda.iter().map(|l| if l.im > 0.0 { 2.0 } else { 1.0 }).collect();
        let pushes = if patterns.ncols() == 0 { patterns.clone() } else { mass.solve(patterns.as_ref()) };
        let beta: Vec<Vec<c64>> = (0..patterns.ncols()).map(|i| lifted(&forward, &pushes, i)).collect();
        let patterns = beta.iter().map(|b| flat(b)).collect();
        let damping = matrices.damping.clone();
        Ok(Self { lambda, weight, forward, backward, beta, patterns, scale, rates, pushes, stiffness, damping, mass })
    }

    /// Number of reduced coordinates.
    pub(super) fn coordinates(&self) -> usize {
        self.scale.len()
    }

    /// Flat state with displacement and velocity of the coordinates.
    pub(super) fn modes_of(&self, displacement: &[f64], velocity: &[f64]) -> Vec<f64> {
        let m = self.coordinates();
        let sum = |k: usize| {
            (0..m)
                .map(|r| {
                    self.forward[(k, r)] * self.scale[r] * displacement[r] + self.forward[(k, m + r)] * velocity[r]
                })
                .sum()
        };
        flat(&(0..self.lambda.len()).map(sum).collect::<Vec<c64>>())
    }

    /// Displacements and velocities of the coordinates in the flat state `z`.
    pub(super) fn coordinates_of(&self, z: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let (m, count) = (self.coordinates(), self.lambda.len());
        let modal_part = |i: usize, k: usize| (self.backward[(i, k)] * c64::new(z[k], z[count + k])).re;
        let row = |i: usize| (0..count).map(|k| self.weight[k] * modal_part(i, k)).sum::<f64>();
        ((0..m).map(|r| row(r) / self.scale[r]).collect(), (0..m).map(|r| row(m + r)).collect())
    }

    /// Displacement (`order` 0), velocity (1) or acceleration (2) along `pattern`, one entry a coordinate.
    pub(super) fn functional(&self, pattern: &[f64], order: i32) -> Functional {
        let m = self.coordinates();
        let row: Vec<f64> = match order {
            0 => (0..2 * m).map(|j| if j < m { pattern[j] / self.scale[j] } else { 0.0 }).collect(),
            1 => (0..2 * m).map(|j| if j < m { 0.0 } else { pattern[j - m] }).collect(),
            _ => weighted_rows(pattern, &self.rates),
        };
        let inputs = if order == 2 { weighted_rows(pattern, &self.pushes) } else { vec![0.0; self.beta.len()] };
        Functional { row: self.on_modes(&row), inputs }
    }

    /// How an acceleration along `pattern` changes with a parameter at a fixed state.
    pub(super) fn acceleration_change(&self, pattern: &[f64], change: &LinearChange) -> Functional {
        let row = self.on_modes(&weighted_rows(pattern, &change.rates));
        Functional { row, inputs: weighted_rows(pattern, &change.pushes) }
    }

    /// The row on flat states of one on the states of the coordinates.
    fn on_modes(&self, row: &[f64]) -> Vec<f64> {
        let on_mode = |k: usize| {
            (row.iter().enumerate().map(|(i, r)| self.backward[(i, k)] * *r).sum::<c64>() * self.weight[k]).conj()
        };
        flat(&(0..self.lambda.len()).map(on_mode).collect::<Vec<c64>>())
    }

    /// Of the derivatives of the reduced matrices by a parameter.
    pub(super) fn change(&self, by: &Matrices) -> LinearChange {
        let m = self.coordinates();
        let solved = |a: &Mat<f64>| self.mass.solve(a.as_ref());
        let lost = solved(&by.mass);
        let (k, c) = (solved(&self.stiffness), solved(&self.damping));
        let change = |direct: &Mat<f64>, through: &Mat<f64>| {
            let through = product(lost.as_ref(), through.as_ref());
            let direct = solved(direct);
            Mat::from_fn(m, m, |i, j| through[(i, j)] - direct[(i, j)])
        };
        let (by_p, by_v) = (change(&by.stiffness, &k), change(&by.damping, &c));
        let rates = Mat::from_fn(m, 2 * m, |i, j| if j < m { by_p[(i, j)] / self.scale[j] } else { by_v[(i, j - m)] });
        let none = self.pushes.ncols() == 0;
        let through = if none { self.pushes.clone() } else { product(lost.as_ref(), self.pushes.as_ref()) };
        let pushes = Mat::from_fn(m, through.ncols(), |i, j| -through[(i, j)]);
        let count = self.lambda.len();
        let (mut direct, mut conjugate) = (Vec::with_capacity(count * count), Vec::with_capacity(count * count));
        for row in 0..count {
            for j in 0..count {
                let (mut p, mut q) = (c64::new(0.0, 0.0), c64::new(0.0, 0.0));
                for i in 0..m {
                    let rate: c64 = (0..2 * m).map(|s| self.backward[(s, j)] * rates[(i, s)]).sum();
                    p += self.forward[(row, m + i)] * rate;
                    q += self.forward[(row, m + i)] * rate.conj();
                }
                direct.push(p);
                conjugate.push(if self.weight[j] > 1.0 { q } else { c64::new(0.0, 0.0) });
            }
        }
        let inputs = (0..pushes.ncols()).map(|i| lifted(&self.forward, &pushes, i)).collect();
        LinearChange { direct, conjugate, inputs, rates, pushes }
    }
}

/// The real parts, behind them the imaginary parts.
fn flat(z: &[c64]) -> Vec<f64> {
    z.iter().map(|z| z.re).chain(z.iter().map(|z| z.im)).collect()
}

/// `V^-1 [0; b]` of column `input`.
fn lifted(forward: &Mat<c64>, pushes: &Mat<f64>, input: usize) -> Vec<c64> {
    let m = pushes.nrows();
    (0..forward.nrows()).map(|k| (0..m).map(|r| forward[(k, m + r)] * pushes[(r, input)]).sum()).collect()
}

fn weighted_rows(pattern: &[f64], matrix: &Mat<f64>) -> Vec<f64> {
    (0..matrix.ncols()).map(|j| pattern.iter().enumerate().map(|(r, p)| p * matrix[(r, j)]).sum()).collect()
}

/// Eigenvalues, vectors and their inverse. Where two eigenvalues meet (critical damping), the matrix is moved by a part in
/// ten million, which no record shows.
fn decomposed(a: &Mat<f64>, greatest: f64) -> Result<(Vec<c64>, Mat<c64>, Mat<c64>), TransientError> {
    let n = a.nrows();
    for attempt in 0..3 {
        let moved = Mat::from_fn(n, n, |i, j| {
            let shift = f64::from(attempt) * 1e-7 * greatest * (1.0 + i as f64 / n as f64);
            if i == j && i >= n / 2 { a[(i, j)] - shift } else { a[(i, j)] }
        });
        let (values, vectors) = real_general(moved.as_ref()).ok_or(TransientError::NoModes)?;
        let identity = Mat::from_fn(n, n, |i, j| c64::new(f64::from(u8::from(i == j)), 0.0));
        let inverse = ComplexLu::new(vectors.as_ref()).solve(identity.as_ref());
        let largest = (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|at| inverse[at].norm()).fold(0.0, f64::max);
        if largest.is_finite() && largest < 1e9 {
            return Ok((values, vectors, inverse));
        }
    }
    Err(TransientError::NoModes)
}
