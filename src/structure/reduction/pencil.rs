//! The lowest modes of a sparse pair by shift-invert block Lanczos ([`crate::structure::lowest_modes`]).

use super::request::SparseSystem;
use crate::structure::error::StructureError;
use crate::structure::lowest_modes::search;
use crate::structure::matrices::SystemMatrices;
use crate::structure::modes::{Modes, modes};
use crate::structure::pencil::Pencil;
use dashpot_numerics::{SparseCholesky, SparseSymmetric};
use faer::{Mat, MatRef};
use std::f64::consts::TAU;

/// Shift over the square of the highest frequency.
const SHIFT: f64 = 1e-3;
/// Rows up to which all modes are computed.
const FEW: usize = 40;
/// Multiple of rounding of the stiffest row that a residual cannot fall below. Frequencies are off by its square only.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// Memory that three bases of vectors may take, bytes.
const MEMORY: usize = 1_600_000_000;

/// A system with the factors of `A = K + s M`.
pub(super) struct Shifted<'a> {
    system: &'a SparseSystem,
    factor: SparseCholesky,
    /// `s`, rad^2/s^2.
    pub shift: f64,
}

impl<'a> Shifted<'a> {
    /// The shift for frequencies up to `highest_hz`; `None` where `A` is not positive definite.
    pub(super) fn new(system: &'a SparseSystem, highest_hz: f64) -> Option<Self> {
        let shift = SHIFT * (TAU * highest_hz).powi(2);
        let factor = SparseCholesky::new(&system.stiffness.plus(shift, &system.mass))?;
        Some(Self { system, factor, shift })
    }

    /// All modes up to `highest_hz`, perhaps none.
    pub(super) fn modes(&self, highest_hz: f64) -> Result<Modes, StructureError> {
        let n = self.size();
        if n <= FEW {
            return self.all_modes(highest_hz);
        }
        let most = (MEMORY / (24 * n)).min(n);
        let found = search(self, self.shift, TAU * highest_hz, 0, most)?;
        found.ok_or(StructureError::TooManyModes { most, up_to_hz: highest_hz })
    }
}

impl Shifted<'_> {
    /// The same of a small system, from all its modes.
    fn all_modes(&self, highest_hz: f64) -> Result<Modes, StructureError> {
        let full = |a: &SparseSymmetric| a.times(Mat::identity(a.size(), a.size()).as_ref());
        let matrices = SystemMatrices { mass: full(&self.system.mass), stiffness: full(&self.system.stiffness) };
        let Modes { mut omega, shapes } = modes(&matrices)?;
        omega.truncate(omega.partition_point(|&w| w <= TAU * highest_hz));
        let shapes = shapes.subcols(0, omega.len()).to_owned();
        Ok(Modes { omega, shapes })
    }
}

impl Pencil for Shifted<'_> {
    fn size(&self) -> usize {
        self.system.mass.size()
    }

    fn by_mass(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        self.system.mass.times(x)
    }

    fn by_stiffness(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        self.system.stiffness.times(x)
    }

    fn solve(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        self.factor.solve(x)
    }

    fn stiffest(&self) -> f64 {
        let (k, m) = (self.system.stiffness.diagonal(), self.system.mass.diagonal());
        k.iter().zip(&m).filter(|(_, m)| **m > 0.0).map(|(k, m)| k / m).fold(0.0, f64::max)
    }

    fn residual_rounding(&self) -> f64 {
        ROUNDING * self.stiffest()
    }
}
