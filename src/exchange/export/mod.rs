//! Identified matrices and sources in the formats of other programs.

mod abaqus;
mod calculix;
mod csv;
mod dashpots;
mod files;
mod format;
mod identified;
mod json;
pub(crate) mod mat5;
mod mtx;
mod nastran;
mod outcome;
mod own_directions;
mod write;

pub use format::{ExportError, Format, Written};
pub use identified::{Identified, IdentifiedMode, IdentifiedSource};
pub use outcome::write_outcome;
pub use write::write;
