//! Files that were opened and are not a project yet: what is in them, what their channels are, then the project that
//! `dashpot import` would write. Everything is read in the background.

mod decided;
pub(crate) mod destination;
mod draft;
mod mapping;
mod places;
mod preview;
mod state;
mod tree;
mod view;

pub use draft::{Draft, OpenProject};
pub use state::{Importing, Made, Progress};
pub use view::show;
