//! An open project as panes see it.

use crate::window::app::view::View;
use crate::window::background::derived::Derived;
use crate::window::document::Document;

/// What a pane reads of an open project, and the one thing that it changes itself: what is looked at. All else it asks for.
#[derive(Debug)]
pub struct Opened<'a> {
    /// The project as it stands.
    pub document: &'a Document,
    /// What is computed from it; to look for a result starts its computation.
    pub derived: &'a mut Derived,
    /// What is looked at.
    pub view: &'a mut View,
}
