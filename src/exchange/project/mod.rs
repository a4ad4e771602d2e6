//! Project files: TOML to [`ProjectFile`] (as written), to [`Plan`] (built), to [`Project`](super::Project) (records
//! read and fitted).

pub mod correction;
pub mod error;
pub mod file;
pub mod load;
mod parse;
pub mod plan;
mod reader;
pub mod relocate;
pub mod ruled_out;
mod sources;
mod structure;

pub use error::{Problem, ProjectError};
pub use file::{Lines, ProjectFile};
pub use load::load;
pub use plan::{Plan, PlannedForce, PlannedRun, open, plan};
