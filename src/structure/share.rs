//! What one part of a structure adds to its matrices.

use faer::Mat;

/// A DOF of an element that a support holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct HeldDof {
    /// The element, from 0.
    pub element: usize,
    /// Which of its local DOFs.
    pub dof: usize,
}

/// Entries of a symmetric matrix, `(row, column, value)`, both triangles.
pub(crate) type Triplets = Vec<(usize, usize, f64)>;

/// The share of one part in the matrices.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Share {
    /// Of the stiffness matrix, N/m.
    pub stiffness: Triplets,
    /// Of the mass matrix, kg.
    pub mass: Triplets,
}

impl Share {
    pub(super) fn of_stiffness(stiffness: Triplets) -> Self {
        Self { stiffness, mass: Triplets::new() }
    }

    pub(super) fn of_mass(mass: Triplets) -> Self {
        Self { stiffness: Triplets::new(), mass }
    }
}

/// Adds `factor` times some entries to a matrix.
pub(super) fn add(matrix: &mut Mat<f64>, entries: &Triplets, factor: f64) {
    for &(i, j, value) in entries {
        matrix[(i, j)] += factor * value;
    }
}
