//! A structure: its degrees of freedom, matrices and elements, and how it came about.

use super::elastic_supports::ElasticSupports;
use super::geometry::{Direction, Dof, Node};
use super::lumped_mass::LumpedMass;
use super::matrices::{Element, SystemMatrices};
use super::modal_stiffness::ModalStiffness;
use super::mode_damping::DampingOfMode;
use super::reduction::outcome::Reduction;
use serde::{Deserialize, Serialize};

/// What the structure was made from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[expect(missing_docs, reason = "the names say it")]
pub enum StructureKind {
    Beam,
    Chain,
    Matrices,
    Points,
    /// One component in a testing machine.
    Component,
}

/// A structure whose labels are unique and whose matrices, where it has any, are symmetric with positive mass.
#[derive(Debug, Clone, PartialEq)]
pub struct Structure {
    pub(crate) kind: StructureKind,
    pub(crate) dofs: Vec<Dof>,
    pub(crate) nodes: Vec<Node>,
    pub(crate) lines: Vec<[usize; 2]>,
    pub(crate) matrices: Option<SystemMatrices>,
    pub(crate) elements: Vec<Element>,
    /// Rows with a lumped mass.
    pub(crate) lumped: Vec<usize>,
    pub(crate) origin: Origin,
}

/// A node whose displacements the files of a model state in directions of their own.
#[derive(Debug, Clone, PartialEq)]
pub struct TurnedNode {
    /// Label of the node.
    pub label: String,
    /// Its own directions 1, 2 and 3 as unit vectors in x, y and z.
    pub axes: [[f64; 3]; 3],
}

/// How an imported structure came about, beyond its matrices.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Origin {
    /// What the files hold that is not understood but could matter, a sentence each.
    pub notes: Vec<String>,
    /// Nodes whose displacements the files state in directions of their own: here they are along x, y and z.
    pub turned: Vec<TurnedNode>,
    /// How a larger model was reduced to the degrees of freedom that are here.
    pub reduction: Option<Reduction>,
    /// Mass of a component that moves with its force cell, kg.
    pub component_mass: f64,
    /// Modes whose damping by laws of the whole structure is corrected.
    pub damping_of_modes: Vec<DampingOfMode>,
    /// Modes whose stiffness is corrected, and their couplings.
    pub modal_stiffness: Option<ModalStiffness>,
    /// Supports that give way.
    pub elastic_supports: Option<ElasticSupports>,
}

impl Structure {
    /// What the structure was made from.
    pub fn kind(&self) -> StructureKind {
        self.kind
    }

    /// Number of degrees of freedom, n.
    pub fn len(&self) -> usize {
        self.dofs.len()
    }

    /// Whether there is no degree of freedom; never true for a structure that was built.
    pub fn is_empty(&self) -> bool {
        self.dofs.is_empty()
    }

    /// Degrees of freedom in the order of the matrix rows.
    pub fn dofs(&self) -> &[Dof] {
        &self.dofs
    }

    /// Nodes, supported ones included.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Pairs of nodes to draw a line between.
    pub fn lines(&self) -> &[[usize; 2]] {
        &self.lines
    }

    /// Mass and stiffness; `None` for `points`.
    pub fn matrices(&self) -> Option<&SystemMatrices> {
        self.matrices.as_ref()
    }

    /// Rows of the DOFs with a lumped mass.
    pub fn lumped(&self) -> &[usize] {
        &self.lumped
    }

    /// Finite elements; empty unless the structure is a beam.
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// Notes of the files and the reduction, where there is one.
    pub fn origin(&self) -> &Origin {
        &self.origin
    }

    /// Notes how the structure came about, and which of its nodes were turned; lumped masses ride on the base like all others.
    pub(crate) fn set_origin(
        &mut self,
        notes: Vec<String>,
        turned: Vec<TurnedNode>,
        mut reduction: Option<Reduction>,
        lumped: &[LumpedMass],
    ) {
        if let Some(reduction) = &mut reduction {
            for extra in lumped {
                let Some(row) = self.dof(&extra.dof) else { continue };
                if let Some(axis) = self.dofs[row].direction.axis() {
                    reduction.base_loads[axis][row] += extra.mass;
                }
            }
        }
        self.origin = Origin { notes, turned, reduction, ..Origin::default() };
    }

    /// Row of the DOF of that label; where no DOF has it, that of node and direction, such as `3z` of a beam.
    pub fn dof(&self, label: &str) -> Option<usize> {
        self.dofs.iter().position(|dof| dof.label == label).or_else(|| self.dof_at_node(label))
    }

    /// Row of the DOF of a node and direction that are written as one word, such as `12rz`.
    fn dof_at_node(&self, word: &str) -> Option<usize> {
        let digits = word.find(|c: char| !c.is_ascii_digit())?;
        let (node, direction) = word.split_at(digits);
        let direction = Direction::from_word(direction)?;
        self.dofs.iter().position(|dof| dof.direction == direction && self.nodes[dof.node].label == node)
    }

    /// Label of row `dof`.
    pub fn label(&self, dof: usize) -> &str {
        &self.dofs[dof].label
    }
}
