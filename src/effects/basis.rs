//! The two matrices of a structure on which laws of the whole structure act, or those of a range of its elements.

use crate::structure::{Structure, SystemMatrices};
use faer::Mat;

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

    /// Entries `(row, column, value)` of the matrices of the elements `first..=last` in the rows of the system; several of
    /// one row and column add up. Lumped masses belong to no element.
    pub fn entries(
        self,
        structure: &Structure,
        [first, last]: [usize; 2],
    ) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        structure.elements().iter().take(last + 1).skip(first).flat_map(move |element| {
            let local = if self == Self::Mass { &element.mass } else { &element.stiffness };
            let count = element.dofs.len();
            let pairs = (0..count).flat_map(move |a| (0..count).map(move |b| (a, b)));
            pairs.filter_map(move |(a, b)| Some((element.dofs[a]?, element.dofs[b]?, local[(a, b)])))
        })
    }

    /// The matrix of a range of elements alone, n x n.
    pub fn of_elements(self, structure: &Structure, range: [usize; 2]) -> Mat<f64> {
        let mut sum = Mat::zeros(structure.len(), structure.len());
        self.entries(structure, range).for_each(|(row, column, value)| sum[(row, column)] += value);
        sum
    }
}
