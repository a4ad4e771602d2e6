//! The two matrices of a structure on which laws of the whole structure act, or those of a range of its elements.

use crate::structure::{DampingOfMode, Structure, SystemMatrices};
use faer::{Mat, c64};

/// Which matrix of the structure a whole-structure law multiplies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Basis {
    /// Mass matrix, lumped masses included.
    Mass,
    /// Stiffness matrix, the chain's ground springs included.
    Stiffness,
}

impl Basis {
    /// The matrix of the whole structure, n x n.
    pub fn of_system(self, matrices: &SystemMatrices) -> &Mat<f64> {
        match self {
            Self::Mass => &matrices.mass,
            Self::Stiffness => &matrices.stiffness,
        }
    }

    /// The matrix on which a law of the whole structure acts, or of a `range` of its elements, n x n: [`Self::of_system`] with the damping of
    /// modes as it is corrected ([`crate::structure::mode_damping`]), or the matrices of the elements alone. `None` without matrices.
    pub fn matrix(self, structure: &Structure, range: Option<[usize; 2]>) -> Option<Mat<f64>> {
        let system = structure.matrices()?;
        if let Some(range) = range {
            let mut sum = Mat::zeros(structure.len(), structure.len());
            self.entries(structure, range).for_each(|(row, column, value)| sum[(row, column)] += value);
            return Some(sum);
        }
        let mut matrix = self.of_system(system).clone();
        for mode in structure.damping_of_modes() {
            let (v, size) = (&mode.pattern, self.more_of(mode));
            matrix += Mat::from_fn(v.len(), v.len(), |i, j| size * v[i] * v[j]);
        }
        Some(matrix)
    }

    /// `factor B x` at `omega`, rad/s, with `B` as [`Self::matrix`] has it, its damping of modes as it is there; zeros without matrices.
    pub(crate) fn times(
        self,
        structure: &Structure,
        range: Option<[usize; 2]>,
        omega: f64,
        factor: c64,
        x: &[c64],
    ) -> Vec<c64> {
        let mut product = vec![c64::new(0.0, 0.0); structure.len()];
        if let Some(range) = range {
            self.entries(structure, range).for_each(|(i, j, value)| product[i] += factor * x[j] * value);
        } else if let Some(system) = structure.matrices() {
            product = multiply(self.of_system(system), factor, x);
            for mode in structure.damping_of_modes() {
                add_along(&mode.pattern, factor * self.more_of_at(mode, omega), x, &mut product);
            }
        }
        product
    }

    /// What the matrix of a structure has more of a mode than that of the system, `(f - 1) b`.
    fn more_of(self, mode: &DampingOfMode) -> f64 {
        (mode.factor - 1.0) * self.of_mode(mode.square)
    }

    /// The same for the forces at `omega`, rad/s.
    pub(crate) fn more_of_at(self, mode: &DampingOfMode, omega: f64) -> f64 {
        (mode.factor_at(omega) - 1.0) * self.of_mode(mode.square)
    }

    /// The modal mass or stiffness of a mass-normalised mode of this square of the natural circular frequency, rad^2/s^2.
    pub(crate) fn of_mode(self, square: f64) -> f64 {
        match self {
            Self::Mass => 1.0,
            Self::Stiffness => square,
        }
    }

    /// Entries `(row, column, value)` of the matrices of the elements `first..=last` in the rows of the system; several of
    /// one row and column add up. Lumped masses belong to no element.
    pub fn entries(
        self,
        structure: &Structure,
        [first, last]: [usize; 2],
    ) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        structure.elements().iter().take(last + 1).skip(first).flat_map(move |element| {
            element.entries(if self == Self::Mass { &element.mass } else { &element.stiffness })
        })
    }
}

/// Adds `factor v v^T x` to `result`.
pub(crate) fn add_along(v: &[f64], factor: c64, x: &[c64], result: &mut [c64]) {
    let along = v.iter().zip(x).fold(c64::new(0.0, 0.0), |sum, (v, x)| sum + *x * *v);
    result.iter_mut().zip(v).for_each(|(r, v)| *r += factor * along * *v);
}

/// `factor B x`.
pub(crate) fn multiply(matrix: &Mat<f64>, factor: c64, x: &[c64]) -> Vec<c64> {
    let mut result = vec![c64::new(0.0, 0.0); matrix.nrows()];
    for (j, &value) in x.iter().enumerate() {
        let scaled = factor * value;
        if scaled.norm_sqr() > 0.0 {
            for (r, a) in result.iter_mut().zip(matrix.col_as_slice(j)) {
                *r += scaled * *a;
            }
        }
    }
    result
}
