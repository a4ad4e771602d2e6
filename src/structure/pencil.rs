//! Mass and stiffness of a structure as the search for its lowest modes needs them: products with blocks of vectors, and solutions
//! with `A = K + s M`. Matrices that are all but empty, those of chains and beams, are multiplied and factorised as sparse ones: a
//! block costs as many operations as they have entries, instead of n^2.

use super::matrices::SystemMatrices;
use crate::math::fill::filled;
use dashpot_numerics::{Cholesky, SparseCholesky, SparseSymmetric, product};
use faer::{Mat, MatRef};

/// Share of the entries of a matrix that are not zero, above which it is taken for full.
const FULL: f64 = 0.05;

/// Products with the matrices and solutions with `A = K + s M`, n x k each.
pub(super) trait Pencil {
    /// Number of rows, n.
    fn size(&self) -> usize;
    /// `M X`.
    fn by_mass(&self, x: MatRef<'_, f64>) -> Mat<f64>;
    /// `K X`.
    fn by_stiffness(&self, x: MatRef<'_, f64>) -> Mat<f64>;
    /// `A^-1 X`.
    fn solve(&self, x: MatRef<'_, f64>) -> Mat<f64>;
    /// Largest ratio of the diagonals of stiffness and mass, rad^2/s^2.
    fn stiffest(&self) -> f64;
    /// What rounding leaves of a residual over `|M phi|`, rad^2/s^2.
    fn residual_rounding(&self) -> f64 {
        0.0
    }
}

/// The factors of `A`, of sparse matrices with these.
#[derive(Debug, Clone)]
pub(super) enum Factor {
    /// Of full matrices.
    Full(Cholesky),
    /// Of sparse ones.
    Sparse {
        /// Of `A`.
        factor: SparseCholesky,
        /// `M`, kg.
        mass: SparseSymmetric,
        /// `K`, N/m.
        stiffness: SparseSymmetric,
    },
}

impl Factor {
    /// Those for the shift `s` (rad^2/s^2); `None` where `A` is not positive definite.
    pub(super) fn new(matrices: &SystemMatrices, shift: f64) -> Option<Self> {
        let (k, m) = (matrices.stiffness.as_ref(), matrices.mass.as_ref());
        if let (Some(mass), Some(stiffness)) = (sparse(m), sparse(k)) {
            let factor = SparseCholesky::new(&stiffness.plus(shift, &mass))?;
            return Some(Self::Sparse { factor, mass, stiffness });
        }
        let n = m.nrows();
        let shifted = filled(n, n, |i, j| k[(i, j)] + shift * m[(i, j)]);
        Cholesky::new(shifted.as_ref()).map(Self::Full)
    }
}

/// The lower triangle of a matrix as a sparse one; `None` where it is full.
fn sparse(full: MatRef<'_, f64>) -> Option<SparseSymmetric> {
    let n = full.nrows();
    let most = (0.5 * FULL * (n * n) as f64) as usize;
    let mut entries = Vec::new();
    for j in 0..n {
        entries.extend((j..n).map(|i| (i, j, full[(i, j)])).filter(|entry| entry.2 != 0.0));
        if entries.len() > most {
            return None;
        }
    }
    SparseSymmetric::from_entries(n, &entries)
}

/// The matrices with the factors of `A`.
pub(super) struct OfMatrices<'a> {
    /// Mass and stiffness.
    pub matrices: &'a SystemMatrices,
    /// Factors that were made of them.
    pub factor: &'a Factor,
}

impl Pencil for OfMatrices<'_> {
    fn size(&self) -> usize {
        self.matrices.mass.nrows()
    }

    fn by_mass(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        match self.factor {
            Factor::Full(_) => product(self.matrices.mass.as_ref(), x),
            Factor::Sparse { mass, .. } => mass.times(x),
        }
    }

    fn by_stiffness(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        match self.factor {
            Factor::Full(_) => product(self.matrices.stiffness.as_ref(), x),
            Factor::Sparse { stiffness, .. } => stiffness.times(x),
        }
    }

    fn solve(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        match self.factor {
            Factor::Full(factor) => factor.solve(x),
            Factor::Sparse { factor, .. } => factor.solve(x),
        }
    }

    fn stiffest(&self) -> f64 {
        let ratio = |i: usize| self.matrices.stiffness[(i, i)] / self.matrices.mass[(i, i)];
        (0..self.size()).map(ratio).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::common::models::{cantilever, uniform_chain};

    /// A chain of hundred masses is sparse, a beam of four elements is not: both multiply and solve as their matrices do.
    #[test]
    fn sparse_and_full_matrices_multiply_and_solve_alike() {
        for (structure, is_sparse) in [(uniform_chain(100, 2.0, 3e3), true), (cantilever(4), false)] {
            let matrices = structure.matrices().unwrap();
            let (shift, n) = (70.0, structure.len());
            let factor = Factor::new(matrices, shift).unwrap();
            assert_eq!(matches!(factor, Factor::Sparse { .. }), is_sparse);
            let pencil = OfMatrices { matrices, factor: &factor };
            let x = Mat::from_fn(n, 3, |i, j| (1.3 * i as f64 + j as f64).sin());
            let (m, k) = (&matrices.mass, &matrices.stiffness);
            let near = |a: &Mat<f64>, b: &Mat<f64>| (a - b).norm_max() < 1e-12 * b.norm_max();
            assert!(near(&pencil.by_mass(x.as_ref()), &(m * &x)));
            assert!(near(&pencil.by_stiffness(x.as_ref()), &(k * &x)));
            let back = pencil.solve((k * &x + m * &x * faer::Scale(shift)).as_ref());
            assert!((&back - &x).norm_max() < 1e-8, "{}", (&back - &x).norm_max());
        }
        let unstable = SystemMatrices { mass: Mat::identity(50, 50), stiffness: Mat::zeros(50, 50) };
        assert!(Factor::new(&unstable, -1.0).is_none());
    }
}
