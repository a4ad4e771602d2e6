//! Neighbours of imported matrices that come without lines: the pairs of translations that the stiffness couples.
//!
//! ```text
//! s_ij = k_ij^2 / (k_ii k_jj),      0 <= s_ij <= 1
//! ```
//!
//! is the squared correlation of two displacements in the stiffness: 0 where nothing joins them, 1 where a spring between
//! them is all that holds either. Finite elements couple only what is joined. Reduced matrices (Guyan, Craig-Bampton) are
//! dense, and `s_ij` falls with distance: there the strongest of each DOF are taken.

use super::matrices::SystemMatrices;
use super::system::{Structure, StructureKind};

/// Coupling below which an entry is rounding of a file with eight digits.
const COUPLED: f64 = 1e-14;

/// Pairs a DOF from which on matrices count as dense: a grid of plate elements couples eight others to each.
const DENSE: usize = 4;

/// Strongest pairs of each DOF that are taken of dense matrices: both sides of a beam, and one more where it branches.
const STRONGEST: usize = 3;

/// Neighbours found in the stiffness.
#[derive(Debug, Clone, PartialEq)]
pub struct Coupled {
    /// Pairs of rows, the lower first, in order.
    pub pairs: Vec<[usize; 2]>,
    /// Whether the matrices couple nearly everything, so that only the strongest of each DOF were taken.
    pub strongest_only: bool,
}

impl Structure {
    /// The pairs of translations of one direction that the stiffness couples; `None` unless the structure is given by
    /// matrices without lines.
    pub fn coupled(&self) -> Option<Coupled> {
        let matrices = self.matrices.as_ref()?;
        if self.kind != StructureKind::Matrices || !self.lines.is_empty() {
            return None;
        }
        let rows = self.translations();
        let all = self.all_coupled(&rows, matrices);
        let strongest_only = all.len() > DENSE * rows.len();
        let mut pairs: Vec<[usize; 2]> = if strongest_only {
            rows.iter().flat_map(|&i| strongest(i, &all)).collect()
        } else {
            all.into_iter().map(|(pair, _)| pair).collect()
        };
        pairs.sort_unstable();
        pairs.dedup();
        Some(Coupled { pairs, strongest_only })
    }

    /// All coupled pairs of one direction with their coupling.
    fn all_coupled(&self, rows: &[usize], matrices: &SystemMatrices) -> Vec<([usize; 2], f64)> {
        let k = &matrices.stiffness;
        let mut all = Vec::new();
        for (n, &i) in rows.iter().enumerate() {
            for &j in &rows[n + 1..] {
                let scale = k[(i, i)] * k[(j, j)];
                let coupling = if scale > 0.0 { k[(i, j)].powi(2) / scale } else { 0.0 };
                if coupling > COUPLED && self.dofs[i].direction == self.dofs[j].direction {
                    all.push(([i, j], coupling));
                }
            }
        }
        all
    }
}

/// The strongest pairs of row `i`.
fn strongest(i: usize, all: &[([usize; 2], f64)]) -> Vec<[usize; 2]> {
    let mut own: Vec<&([usize; 2], f64)> = all.iter().filter(|(pair, _)| pair.contains(&i)).collect();
    own.sort_by(|a, b| b.1.total_cmp(&a.1));
    own.into_iter().take(STRONGEST).map(|(pair, _)| *pair).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use crate::common::models::{cantilever, chain};
    use crate::math::least_squares::solve_symmetric;
    use crate::structure::imported::{ImportedDof, ImportedParameters};
    use crate::structure::{Direction, Structure};
    use faer::Mat;

    fn imported(structure: &Structure) -> ImportedParameters {
        let matrices = structure.matrices().unwrap();
        let dof = |d: &crate::structure::Dof| ImportedDof {
            label: d.label.clone(),
            node: structure.nodes()[d.node].label.clone(),
            direction: d.direction,
        };
        ImportedParameters {
            mass: matrices.mass.clone(),
            stiffness: matrices.stiffness.clone(),
            nodes: None,
            dofs: Some(structure.dofs().iter().map(dof).collect()),
            lines: Vec::new(),
        }
    }

    #[test]
    fn matrices_without_lines_have_the_neighbours_of_the_structure_they_came_from() {
        let chain = chain(&[1.0, 2.0, 3.0, 1.0], &[1e4, 0.0, 0.0, 5e3], &[1e5, 2e5, 5e4]);
        for structure in [chain, cantilever(6)] {
            let again = imported(&structure).build(&[]).unwrap();
            assert!(!structure.neighbours().is_empty());
            assert_eq!(again.neighbours(), structure.neighbours());
            assert!(!again.coupled().unwrap().strongest_only);
            assert_eq!(structure.coupled(), None);
        }
    }

    /// A beam reduced statically to its translations (Guyan) couples each to all others.
    #[test]
    fn of_dense_reduced_matrices_the_strongest_are_taken() {
        let full = cantilever(14);
        let matrices = full.matrices().unwrap();
        let (kept, gone): (Vec<usize>, Vec<usize>) =
            (0..full.len()).partition(|&i| !full.dofs()[i].direction.is_rotation());
        let part = |rows: &[usize], columns: &[usize]| {
            Mat::from_fn(rows.len(), columns.len(), |i, j| matrices.stiffness[(rows[i], columns[j])])
        };
        let slopes = solve_symmetric(part(&gone, &gone).as_ref(), part(&gone, &kept).as_ref()).unwrap();
        let parameters = ImportedParameters {
            mass: Mat::identity(kept.len(), kept.len()),
            stiffness: part(&kept, &kept) - part(&kept, &gone) * slopes,
            nodes: None,
            dofs: None,
            lines: Vec::new(),
        };
        let reduced = parameters.build(&[]).unwrap();
        assert_eq!(reduced.dofs()[0].direction, Direction::Z);
        let coupled = reduced.coupled().unwrap();
        assert!(coupled.strongest_only);
        assert!((1..kept.len()).all(|i| coupled.pairs.contains(&[i - 1, i])), "{:?}", coupled.pairs);
        assert!(coupled.pairs.len() <= 3 * kept.len());
        assert_eq!(reduced.neighbours(), coupled.pairs);
    }
}
