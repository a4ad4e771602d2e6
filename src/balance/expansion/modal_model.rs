//! The structure in its modal coordinates, where a receptance costs little: `H = Phi_m Z_m^-1 Phi_m^T + Phi_r
//! diag(1 / (omega_r^2 - w^2)) Phi_r^T`, with `Z_m = diag(omega_k^2 - w^2) + Phi_m^T D Phi_m` and `D` the complex stiffness
//! of all sources.
//!
//! Up to [`ALL`] DOFs every mode is retained and `H` is exact; beyond, the modes far above the frequencies of the runs
//! respond without damping, as their damping does not show there.

use crate::balance::BalanceError;
use crate::balance::action::Secant;
use crate::effects::law::Basis;
use crate::structure::Structure;
use dashpot_numerics::ComplexLu;
use faer::{Mat, c64};

/// DOFs up to which every mode is retained.
const ALL: usize = 250;
/// Modes up to this multiple of the highest frequency are retained.
const BAND: f64 = 6.0;
/// Least number of retained modes.
const LEAST: usize = 60;

/// Undamped modes, mass-normalised, and how many of them feel the sources.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalModel {
    omega: Vec<f64>,
    shapes: Mat<f64>,
    retained: usize,
}

impl ModalModel {
    /// Modes of a structure that has mass and stiffness; `highest_omega` (rad/s) is the highest frequency of interest.
    ///
    /// # Errors
    /// [`BalanceError::Modes`].
    pub fn new(structure: &Structure, highest_omega: f64) -> Result<Self, BalanceError> {
        let modes = structure.modes().map_err(|e| BalanceError::Modes { reason: e.to_string() })?;
        let in_band = modes.omega.iter().take_while(|&&w| w <= BAND * highest_omega).count();
        let n = modes.omega.len();
        let retained = if n <= ALL { n } else { in_band.clamp(LEAST, ALL) };
        Ok(Self { omega: modes.omega, shapes: modes.shapes, retained })
    }

    /// Number of DOFs.
    pub fn size(&self) -> usize {
        self.shapes.nrows()
    }

    /// Natural circular frequencies, rad/s.
    pub fn omega(&self) -> &[f64] {
        &self.omega
    }

    /// Entry of mode `mode` at a DOF.
    pub fn shape(&self, mode: usize, dof: usize) -> f64 {
        self.shapes[(dof, mode)]
    }

    /// Modes in the order of their distance in frequency from `omega` (rad/s).
    pub fn by_distance(&self, omega: f64) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.omega.len()).collect();
        order.sort_by(|&a, &b| (self.omega[a] - omega).abs().total_cmp(&(self.omega[b] - omega).abs()));
        order
    }

    /// Columns `dofs` of the receptance at `omega` (rad/s), n x `dofs.len()`, m/N.
    pub fn receptance(&self, structure: &Structure, omega: f64, secants: &[Secant], dofs: &[usize]) -> Mat<c64> {
        let m = self.retained;
        let mut z = Mat::<c64>::zeros(m, m);
        for k in 0..m {
            z[(k, k)] = c64::new(self.omega[k].powi(2) - omega * omega, 0.0);
        }
        for secant in secants {
            self.add_secant(structure, secant, &mut z);
        }
        // An undamped resonance hit exactly: the least loss that keeps the answer finite.
        for k in 0..m {
            if z[(k, k)].norm() < 1e-9 * omega * omega {
                z[(k, k)] += c64::new(0.0, 1e-9 * omega * omega);
            }
        }
        let right = Mat::from_fn(m, dofs.len(), |k, j| c64::new(self.shapes[(dofs[j], k)], 0.0));
        let q = ComplexLu::new(z.as_ref()).solve(right.as_ref());
        let rest: Vec<f64> = self.omega[m..].iter().map(|w| 1.0 / (w * w - omega * omega)).collect();
        Mat::from_fn(self.size(), dofs.len(), |i, j| {
            let low: c64 = (0..m).map(|k| q[(k, j)] * self.shapes[(i, k)]).sum();
            let high: f64 =
                rest.iter().enumerate().map(|(r, g)| self.shapes[(i, m + r)] * g * self.shapes[(dofs[j], m + r)]).sum();
            low + high
        })
    }

    /// Adds `Phi_m^T D Phi_m` of one source.
    fn add_secant(&self, structure: &Structure, secant: &Secant, z: &mut Mat<c64>) {
        let m = self.retained;
        match secant {
            Secant::Legs(legs) => {
                for &(leg, value) in legs {
                    let row: Vec<f64> = (0..m).map(|k| leg.relative(|dof| self.shapes[(dof, k)])).collect();
                    add_outer(z, &row, &row, value);
                }
            }
            Secant::Whole(basis, None, factor) => {
                for k in 0..m {
                    z[(k, k)] += factor * if *basis == Basis::Mass { 1.0 } else { self.omega[k].powi(2) };
                }
            }
            Secant::Whole(basis, Some([first, last]), factor) => {
                for element in structure.elements().iter().take(last + 1).skip(*first) {
                    let local = if *basis == Basis::Mass { &element.mass } else { &element.stiffness };
                    for (i, &a) in element.dofs.iter().enumerate() {
                        for (j, &b) in element.dofs.iter().enumerate() {
                            if let (Some(a), Some(b)) = (a, b) {
                                let left: Vec<f64> = (0..m).map(|k| self.shapes[(a, k)]).collect();
                                let right: Vec<f64> = (0..m).map(|k| self.shapes[(b, k)]).collect();
                                add_outer(z, &left, &right, factor * local[(i, j)]);
                            }
                        }
                    }
                }
            }
        }
    }

    /// Covariance of the motion under unknown residual forces of covariance `K + omega^2 M`: `Phi diag(v) Phi^T` with
    /// `v_k = (omega_k^2 + w^2) / |omega_k^2 - w^2 + i loss omega_k^2|^2`; this returns `v`.
    pub fn residual_variances(&self, omega: f64, loss: f64) -> Vec<f64> {
        self.omega
            .iter()
            .map(|w| {
                let detuning = w * w - omega * omega;
                let width = loss * w.max(0.1 * omega).powi(2);
                (w * w + omega * omega) / (detuning * detuning + width * width)
            })
            .collect()
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
