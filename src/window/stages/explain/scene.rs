//! What the panes of the stage Explain read.

use crate::window::document::Document;
use crate::window::explained::Explained;

/// What the panes read.
pub struct Scene<'a> {
    /// The open project.
    pub document: &'a Document,
    /// What was computed from it.
    pub explained: &'a Explained,
}
