//! The one engine that the window, the command line and the tests speak to: a document, commands that change it, undo,
//! jobs in the background, results that know what they were computed from, and saving.

pub mod adoption;
pub(crate) mod apply;
pub(crate) mod command;
pub(crate) mod corrections;
pub(crate) mod document;
pub mod history;
pub mod identified;
pub mod jobs;
mod mending;
pub mod recent;
mod refusal;
pub mod save;
pub mod script;
mod sensors;
#[expect(clippy::module_inception, reason = "the session is what the floor is for")]
pub(crate) mod session;
mod sources;
pub mod states;
mod structure;
pub mod time_limit;
pub mod validation;
pub mod workers;

pub use command::{Command, Setting, SourceAt, SourceSpec};
pub use document::{Document, Revisions};
pub use refusal::Refusal;
pub use session::Session;
