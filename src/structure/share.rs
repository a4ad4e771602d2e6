//! The parts of a structure, and what one of them adds to its matrices.

use faer::Mat;

/// A DOF of an element that a support holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct HeldDof {
    /// The element, from 0.
    pub element: usize,
    /// Which of its local DOFs.
    pub dof: usize,
}

/// A part of a structure; rows are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Part {
    /// All stiffness.
    Stiffness,
    /// All mass.
    Mass,
    /// Stiffness of the elements first..=last.
    ElementStiffness([usize; 2]),
    /// Mass of the elements first..=last.
    ElementMass([usize; 2]),
    /// Stiffness of one undamped mode.
    Mode(usize),
    /// Coupling of two undamped modes by stiffness, over `omega_r omega_s`: its factor is the exponential of it.
    ModeCoupling([usize; 2]),
    /// Damping that laws of the whole structure give one undamped mode.
    ModeDamping(usize),
    /// The same an octave above its natural frequency, over that at it: 1 as structural damping, 2 as viscous.
    ModeDampingPerOctave(usize),
    /// Spring from a DOF to the ground: the sum of its row.
    GroundSpring(usize),
    /// Spring between two DOFs: minus the entry of the stiffness matrix.
    Coupling([usize; 2]),
    /// Mass on the diagonal at a DOF.
    PointMass(usize),
    /// Support of a held DOF of a beam, taken for rigid: `k_s / (k_s + k_hh)` of a spring `k_s` in its stead, `k_hh` being the
    /// stiffness of the element there.
    Support(HeldDof),
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
