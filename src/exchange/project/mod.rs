//! Project files: TOML to [`ProjectFile`] (as written), to [`Plan`] (built), to [`Project`](super::Project) (records
//! read and fitted).

mod channel;
pub mod correction;
pub mod error;
pub mod excitation;
pub mod file;
pub mod frf;
pub mod load;
mod parse;
pub mod plan;
mod reader;
pub mod relocate;
pub mod ruled_out;
mod sources;
mod structure;

pub use channel::template;
pub use error::{Problem, ProjectError};
pub use file::{Lines, ProjectFile};
pub use load::load;
pub use plan::{Plan, PlannedForce, PlannedRun, PlannedTest, open, plan};
