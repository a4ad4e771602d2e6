//! The matrices of a structure and of its finite elements.

use faer::Mat;

/// Mass and stiffness, both symmetric n x n; lumped masses are included.
#[derive(Debug, Clone, PartialEq)]
pub struct SystemMatrices {
    /// Mass, kg (kg m^2 for rotations), positive definite.
    pub mass: Mat<f64>,
    /// Stiffness, N/m, positive semi-definite.
    pub stiffness: Mat<f64>,
}

/// One finite element, kept for laws that are restricted to a range of elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Element {
    /// Row of the system matrices of each local DOF; `None` where it is supported.
    pub dofs: Vec<Option<usize>>,
    /// Local mass matrix.
    pub mass: Mat<f64>,
    /// Local stiffness matrix.
    pub stiffness: Mat<f64>,
}
