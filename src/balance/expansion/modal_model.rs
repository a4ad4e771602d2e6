//! The structure in its modal coordinates, where a receptance costs little: `H = Phi_m Z_m^-1 Phi_m^T + Phi_r
//! diag(1 / (omega_r^2 - w^2)) Phi_r^T`, with `Z_m = diag(omega_k^2 - w^2) + Phi_m^T D Phi_m` and `D` the complex stiffness
//! of all sources.
//!
//! Up to `ALL` DOFs every mode is retained and `H` is exact; beyond, only the lowest modes are computed, and those above
//! respond without damping, as their damping does not show there ([`LowestModes::rest`]).

use crate::balance::action::Secant;
use crate::balance::error::BalanceError;
use crate::math::fill::{filled, filled_complex};
use crate::structure::lowest_modes::{LowestModes, Rest};
use crate::structure::modes::Modes;
use crate::structure::{Structure, SystemMatrices};
use dashpot_numerics::{ComplexLu, product};
use faer::{Mat, c64};

/// DOFs up to which every mode is retained.
const ALL: usize = 250;
/// Modes up to this multiple of the highest frequency are retained ...
const BAND: f64 = 6.0;
/// ... or where they are more than [`ALL`], up to this one: the series for the rest must still converge.
const NARROW: f64 = 2.0;
/// Error of a receptance over its column's largest entry where modes are left to the series.
const TRUNCATION: f64 = 1e-6;
/// Least number of retained modes.
const LEAST: usize = 60;

/// Undamped modes, mass-normalised, that feel the sources, and what the others add.
#[derive(Debug, Clone)]
pub struct ModalModel {
    modes: Modes,
    rest: Option<HigherModes>,
}

/// The modes that are not retained, by the columns of the receptance that were asked for at the start.
#[derive(Debug, Clone)]
struct HigherModes {
    lowest: LowestModes,
    dofs: Vec<usize>,
    columns: Vec<Rest>,
}

impl HigherModes {
    /// Column `dof` of what they add to the receptance at `omega`; DOFs not prepared cost a solution each.
    fn column(&self, matrices: &SystemMatrices, dof: usize, omega: f64) -> Vec<f64> {
        match self.dofs.binary_search(&dof) {
            Ok(place) => self.columns[place].at(omega),
            Err(_) => self.lowest.rest(matrices, &[dof])[0].at(omega),
        }
    }
}

impl ModalModel {
    /// Modes of a structure that has mass and stiffness; `highest_omega` (rad/s) is the highest frequency of interest, `dofs`
    /// (in any order) the DOFs whose columns of the receptance will be asked for again and again.
    ///
    /// # Errors
    /// [`BalanceError::Modes`].
    pub fn new(structure: &Structure, highest_omega: f64, mut dofs: Vec<usize>) -> Result<Self, BalanceError> {
        let failed = |e: crate::structure::StructureError| BalanceError::Modes { reason: e.to_string() };
        if let Some(matrices) = structure.matrices()
            && structure.len() > ALL
            && let Some(lowest) = lowest(matrices, highest_omega).map_err(failed)?
        {
            dofs.sort_unstable();
            dofs.dedup();
            let columns = lowest.rest(matrices, &dofs);
            return Ok(Self { modes: lowest.modes.clone(), rest: Some(HigherModes { lowest, dofs, columns }) });
        }
        Ok(Self { modes: structure.modes().map_err(failed)?, rest: None })
    }

    /// Error of a receptance over the largest of its column: 0 where every mode is retained. Far from the force, below the
    /// lowest mode, the sum of the modes is many orders smaller than its terms.
    pub fn truncation(&self) -> f64 {
        if self.rest.is_some() { TRUNCATION } else { 0.0 }
    }

    /// Number of DOFs.
    pub fn size(&self) -> usize {
        self.modes.shapes.nrows()
    }

    /// Entry of mode `mode` at a DOF.
    pub fn shape(&self, mode: usize, dof: usize) -> f64 {
        self.modes.shapes[(dof, mode)]
    }

    /// Modes in the order of their distance in frequency from `omega` (rad/s).
    pub fn by_distance(&self, omega: f64) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.modes.omega.len()).collect();
        order.sort_by(|&a, &b| (self.modes.omega[a] - omega).abs().total_cmp(&(self.modes.omega[b] - omega).abs()));
        order
    }

    /// Columns `dofs` of the receptance at `omega` (rad/s), n x `dofs.len()`, m/N.
    pub fn receptance(&self, structure: &Structure, omega: f64, secants: &[Secant], dofs: &[usize]) -> Mat<c64> {
        let m = self.modes.len();
        let mut z = Mat::<c64>::zeros(m, m);
        for k in 0..m {
            z[(k, k)] = c64::new(self.modes.omega[k].powi(2) - omega * omega, 0.0);
        }
        for secant in secants {
            self.add_secant(structure, omega, secant, &mut z);
        }
        // An undamped resonance hit exactly: the least loss that keeps the answer finite.
        for k in 0..m {
            if z[(k, k)].norm() < 1e-9 * omega * omega {
                z[(k, k)] += c64::new(0.0, 1e-9 * omega * omega);
            }
        }
        let right = Mat::from_fn(m, dofs.len(), |k, j| c64::new(self.modes.shapes[(dofs[j], k)], 0.0));
        let q = ComplexLu::new(z.as_ref()).solve(right.as_ref());
        let mut h = self.physical(&q);
        if let (Some(rest), Some(matrices)) = (&self.rest, structure.matrices()) {
            for (j, &dof) in dofs.iter().enumerate() {
                let column = rest.column(matrices, dof, omega);
                column.iter().enumerate().for_each(|(i, value)| h[(i, j)] += c64::new(*value, 0.0));
            }
        }
        h
    }

    /// `Phi_m q`.
    fn physical(&self, q: &Mat<c64>) -> Mat<c64> {
        let part = |pick: fn(&c64) -> f64| {
            let real = filled(q.nrows(), q.ncols(), |k, j| pick(&q[(k, j)]));
            product(self.modes.shapes.as_ref(), real.as_ref())
        };
        let (re, im) = (part(|v| v.re), part(|v| v.im));
        filled_complex(re.nrows(), re.ncols(), |i, j| c64::new(re[(i, j)], im[(i, j)]))
    }

    /// Adds `Phi_m^T D Phi_m` of one source at `omega`, rad/s.
    fn add_secant(&self, structure: &Structure, omega: f64, secant: &Secant, z: &mut Mat<c64>) {
        let m = self.modes.len();
        match secant {
            Secant::Legs(legs) => {
                for &(leg, value) in legs {
                    let row: Vec<f64> = (0..m).map(|k| leg.relative(|dof| self.modes.shapes[(dof, k)])).collect();
                    add_outer(z, &row, &row, value);
                }
            }
            Secant::Whole(basis, None, factor) => {
                for k in 0..m {
                    z[(k, k)] +=
                        factor * structure.mode_damping_at(k, omega) * basis.of_mode(self.modes.omega[k].powi(2));
                }
            }
            Secant::Whole(basis, Some(range), factor) => {
                let row = |i: usize| (0..m).map(|k| self.modes.shapes[(i, k)]).collect::<Vec<f64>>();
                for (i, j, value) in basis.entries(structure, *range) {
                    add_outer(z, &row(i), &row(j), factor * value);
                }
            }
        }
    }

    /// Covariance of the motion under unknown residual forces of covariance `K + omega^2 M`: `Phi diag(v) Phi^T` with
    /// `v_k = (omega_k^2 + w^2) / |omega_k^2 - w^2 + i loss omega_k^2|^2`; this returns `v`.
    pub fn residual_variances(&self, omega: f64, loss: f64) -> Vec<f64> {
        self.modes
            .omega
            .iter()
            .map(|w| {
                let detuning = w * w - omega * omega;
                let width = loss * w.max(0.1 * omega).powi(2);
                (w * w + omega * omega) / (detuning * detuning + width * width)
            })
            .collect()
    }
}

impl ModalModel {
    /// Columns `dofs` of `Phi diag(v) Phi^T`, n x `dofs.len()`.
    pub fn residual_covariance(&self, v: &[f64], dofs: &[usize]) -> Mat<f64> {
        let weighted = filled(v.len(), dofs.len(), |k, j| v[k] * self.modes.shapes[(dofs[j], k)]);
        product(self.modes.shapes.as_ref(), weighted.as_ref())
    }

    /// Diagonal of `Phi diag(v) Phi^T`.
    pub fn residual_diagonal(&self, v: &[f64]) -> Vec<f64> {
        let mut diagonal = vec![0.0; self.size()];
        for (k, value) in v.iter().enumerate() {
            let shape = self.modes.shapes.col(k);
            diagonal.iter_mut().enumerate().for_each(|(i, sum)| *sum += value * shape[i] * shape[i]);
        }
        diagonal
    }
}

/// The lowest modes of a large structure; `None` where too many would be needed.
fn lowest(
    matrices: &SystemMatrices,
    highest_omega: f64,
) -> Result<Option<LowestModes>, crate::structure::StructureError> {
    let wide = LowestModes::new(matrices, BAND * highest_omega, LEAST)?;
    match wide {
        Some(wide) if wide.modes.len() <= ALL => Ok(Some(wide)),
        _ => LowestModes::new(matrices, NARROW * highest_omega, LEAST),
    }
}

/// `z += value left right^T`.
fn add_outer(z: &mut Mat<c64>, left: &[f64], right: &[f64], value: c64) {
    for (j, r) in right.iter().enumerate() {
        let scaled = value * *r;
        for (i, l) in left.iter().enumerate() {
            z[(i, j)] += scaled * *l;
        }
    }
}
