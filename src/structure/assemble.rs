//! The last steps that every kind of structure shares: lumped masses and the checks that make a [`Structure`] valid.

use super::error::{StructureError, nearest, positive};
use super::geometry::{Direction, Dof, Node};
use super::lumped_mass::LumpedMass;
use super::matrices::{Element, SystemMatrices};
use super::system::{Origin, Structure, StructureKind};
use crate::math::eigen;
use dashpot_numerics::Cholesky;
use faer::{Mat, MatRef};
use std::collections::HashSet;

/// Relative difference of two mirrored entries that counts as rounding of the file they were read from.
const SYMMETRY_TOLERANCE: f64 = 1e-6;

/// Largest number of degrees of freedom: dense matrices of this size still fit in memory.
pub const MOST_DOFS: usize = 10_000;

/// Everything a structure is made from, before it is checked.
pub(super) struct Parts {
    pub kind: StructureKind,
    pub dofs: Vec<Dof>,
    pub nodes: Vec<Node>,
    pub lines: Vec<[usize; 2]>,
    pub matrices: Option<SystemMatrices>,
    pub elements: Vec<Element>,
}

impl Parts {
    /// Adds the lumped masses, checks everything, and makes the structure.
    pub(super) fn finish(self, lumped: &[LumpedMass]) -> Result<Structure, StructureError> {
        let Self { kind, dofs, nodes, lines, matrices, elements } = self;
        check_labels(&dofs, &nodes)?;
        let origin = Origin::default();
        let mut structure =
            Structure { kind, dofs, nodes, lines, matrices: None, elements, lumped: Vec::new(), origin };
        structure.lumped = lumped.iter().filter_map(|mass| structure.dof(&mass.dof)).collect();
        structure.matrices = matrices.map(|matrices| checked(matrices, lumped, &structure)).transpose()?;
        Ok(structure)
    }
}

fn check_labels(dofs: &[Dof], nodes: &[Node]) -> Result<(), StructureError> {
    if dofs.is_empty() {
        return Err(StructureError::NoDofs);
    }
    if dofs.iter().any(|dof| dof.label.trim().is_empty()) {
        return Err(StructureError::EmptyLabel);
    }
    let mut seen = HashSet::new();
    if let Some(dof) = dofs.iter().find(|dof| !seen.insert(dof.label.as_str())) {
        return Err(StructureError::DuplicateDof { label: dof.label.clone() });
    }
    seen.clear();
    match nodes.iter().find(|node| !seen.insert(node.label.as_str())) {
        Some(node) => Err(StructureError::DuplicateNode { label: node.label.clone() }),
        None => Ok(()),
    }
}

fn checked(
    matrices: SystemMatrices,
    lumped: &[LumpedMass],
    structure: &Structure,
) -> Result<SystemMatrices, StructureError> {
    let SystemMatrices { mass, stiffness } = matrices;
    let n = structure.len();
    if mass.shape() != (n, n) || stiffness.shape() != (n, n) {
        return Err(StructureError::Sizes {
            mass_rows: mass.nrows(),
            mass_columns: mass.ncols(),
            stiffness_rows: stiffness.nrows(),
            stiffness_columns: stiffness.ncols(),
        });
    }
    let mut mass = symmetric("mass", mass.as_ref())?;
    let stiffness = symmetric("stiffness", stiffness.as_ref())?;
    for extra in lumped {
        positive(format!("lumped mass at DOF {}", extra.dof), extra.mass, "kg")?;
        let row = structure.require_dof(&extra.dof)?;
        mass[(row, row)] += extra.mass;
    }
    if Cholesky::new(mass.as_ref()).is_none() {
        return Err(mass_error(mass.as_ref(), structure));
    }
    Ok(SystemMatrices { mass, stiffness })
}

/// The symmetric part, if what is left over is no more than rounding.
fn symmetric(matrix: &'static str, a: MatRef<'_, f64>) -> Result<Mat<f64>, StructureError> {
    let n = a.nrows();
    let mut worst = (0.0, 0, 0);
    for column in 0..n {
        for row in 0..n {
            let value = a[(row, column)];
            if !value.is_finite() {
                return Err(StructureError::NotFinite { matrix, row: row + 1, column: column + 1, value });
            }
        }
    }
    for column in 0..n {
        for row in 0..column {
            // Entries of different units are compared with their own diagonal, not with the largest of all.
            let own = (a[(row, row)].abs() * a[(column, column)].abs()).sqrt();
            let scale = own.max(a[(row, column)].abs()).max(a[(column, row)].abs());
            let relative = if scale > 0.0 { (a[(row, column)] - a[(column, row)]).abs() / scale } else { 0.0 };
            if relative > worst.0 {
                worst = (relative, row, column);
            }
        }
    }
    let (relative, row, column) = worst;
    if relative > SYMMETRY_TOLERANCE {
        let (upper, lower) = (a[(row, column)], a[(column, row)]);
        return Err(StructureError::Asymmetric { matrix, row: row + 1, column: column + 1, upper, lower, relative });
    }
    Ok(eigen::symmetrised(a))
}

/// Names the DOF that takes the largest part in the eigenvector of the least eigenvalue.
fn mass_error(mass: MatRef<'_, f64>, structure: &Structure) -> StructureError {
    let Ok(eigen) = eigen::symmetric(mass) else {
        return StructureError::MassNotPositive { least: f64::NAN, dof: structure.label(0).to_string() };
    };
    let share = |i: usize| eigen.vectors[(i, 0)].abs();
    let row = (0..mass.nrows()).max_by(|&i, &j| share(i).total_cmp(&share(j)));
    let least = eigen.values[0];
    StructureError::MassNotPositive { least, dof: structure.label(row.unwrap_or(0)).to_string() }
}

impl Structure {
    /// Row of the DOF of that label.
    ///
    /// # Errors
    /// [`StructureError::UnknownDof`] with the labels most like it.
    pub fn require_dof(&self, label: &str) -> Result<usize, StructureError> {
        self.dof(label).ok_or_else(|| StructureError::UnknownDof {
            label: label.to_string(),
            near: nearest(label, self.dofs.iter().map(|dof| dof.label.as_str())),
        })
    }

    /// Rows of the translations, in order.
    pub fn translations(&self) -> Vec<usize> {
        (0..self.len()).filter(|&i| !self.dofs[i].direction.is_rotation()).collect()
    }

    /// Rows in space, at which something can act: all but generalised coordinates.
    pub fn in_space(&self) -> Vec<usize> {
        (0..self.len()).filter(|&i| self.dofs[i].direction != Direction::Q).collect()
    }

    /// Every pair of neighbouring translations: consecutive nodes of a beam, consecutive masses, equal directions of
    /// nodes joined by a line for imported matrices or, without lines, coupled by the stiffness, every pair for points.
    pub fn neighbours(&self) -> Vec<[usize; 2]> {
        let rows = self.translations();
        if let Some(coupled) = self.coupled() {
            return coupled.pairs;
        }
        if self.kind == StructureKind::Points {
            return rows.iter().enumerate().flat_map(|(k, &i)| rows[k + 1..].iter().map(move |&j| [i, j])).collect();
        }
        let mut pairs: Vec<[usize; 2]> = Vec::new();
        for &[first, second] in &self.lines {
            for &i in rows.iter().filter(|&&i| self.dofs[i].node == first) {
                let same =
                    |j: &&usize| self.dofs[**j].node == second && self.dofs[**j].direction == self.dofs[i].direction;
                pairs.extend(rows.iter().find(same).map(|&j| if i < j { [i, j] } else { [j, i] }));
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }
}
