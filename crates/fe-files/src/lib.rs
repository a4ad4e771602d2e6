//! Mass and stiffness matrices, nodes and lines in the files of finite-element programs.
//!
//! | program | read |
//! |---|---|
//! | NASTRAN bulk data and punch ([`nastran`]) | `GRID`, `GRDSET`, `SPOINT`, `CORD1R/C/S`, `CORD2R/C/S`, line and shell and solid elements for drawing, `DMIG` of real matrices; small, large and free field |
//! | NASTRAN `OUTPUT4` ([`op4`]) | real matrices in ascii and binary, both byte orders, dense and sparse columns |
//! | Abaqus ([`abaqus`]) | `*MATRIX GENERATE` output: matrix input, labels and coordinate |
//! | CalculiX ([`calculix`]) | `.sti`, `.mas` and `.dof` of `SOLVER=MATRIXSTORAGE` |
//! | Abaqus and CalculiX input ([`inp`]) | `*NODE` and `*ELEMENT`, for drawing |
//!
//! Only these cards are understood; what is met besides and could matter is said in `notes`. Matrices are real and
//! symmetric and come as entries of their lower triangle, each place once, so memory follows the file, not its header.
//! The units are those of the file. Nothing here knows what the matrices are for.

pub mod abaqus;
pub mod calculix;
mod edges;
mod error;
pub mod inp;
mod matrix;
pub mod nastran;
mod number;
pub mod op4;
mod turned;

pub use error::{FileError, Place, Problem};
pub use matrix::{Matrix, NodeDof};
pub use turned::Turned;

/// A point of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Number in the file.
    pub id: i64,
    /// Position in the basic system, units of the file.
    pub position: [f64; 3],
}

/// Nodes and what is drawn between them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Geometry {
    /// Nodes in the order of the file.
    pub nodes: Vec<Node>,
    /// Pairs of node numbers joined by a line, each pair once; of solids those of the surface only.
    pub lines: Vec<[i64; 2]>,
    /// Nodes whose displacements are in directions of their own; [`Matrix::in_basic`] turns them.
    pub turned: Vec<Turned>,
    /// What was met and is not understood but could matter, a sentence each.
    pub notes: Vec<String>,
}
