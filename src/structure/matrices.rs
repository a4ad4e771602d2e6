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

impl Element {
    /// Entries `(row, column, value)` of a local matrix in the rows of the system, those of supported DOFs left out.
    pub fn entries<'a>(&'a self, local: &'a Mat<f64>) -> impl Iterator<Item = (usize, usize, f64)> + 'a {
        let count = self.dofs.len();
        let pairs = (0..count).flat_map(move |a| (0..count).map(move |b| (a, b)));
        pairs.filter_map(|(a, b)| Some((self.dofs[a]?, self.dofs[b]?, local[(a, b)])))
    }
}
