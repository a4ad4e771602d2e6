//! Project files: TOML to [`ProjectFile`] (as written), to [`Plan`] (built), to [`Project`](super::Project) (records
//! read and fitted).

pub(crate) mod base;
mod channel;
pub(crate) mod correction;
pub(crate) mod error;
pub(crate) mod excitation;
pub mod file;
pub(crate) mod frf;
mod kept;
mod keys;
mod keys_of;
pub mod label;
pub(crate) mod lines;
pub mod load;
pub(crate) mod load_base;
mod load_frf;
mod measured;
mod model;
mod modes;
mod named_files;
mod parse;
pub mod plan;
mod reader;
mod reduce;
pub(crate) mod reference_shapes;
pub(crate) mod relocate;
mod report;
pub(crate) mod rewrite;
pub(crate) mod ruled_out;
mod ruled_out_sources;
mod runs;
pub(crate) mod sources;
pub(crate) mod structure;

pub use channel::template;
pub use error::{ProjectError, TableProblem};
pub use file::{Lines, ProjectFile};
pub use frf::frf_template;
pub use load::load;
pub use measured::MeasurementTables;
pub use plan::{Fitted, Plan, PlannedBase, PlannedForce, PlannedRun, PlannedTest, open, plan};
