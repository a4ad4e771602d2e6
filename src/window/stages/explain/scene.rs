//! What the panes of the stage Explain read.

use crate::effects::{Source, State};
use crate::window::document::Document;
use crate::window::explained::Explained;

/// What the panes read.
pub(super) struct Scene<'a> {
    /// The open project.
    pub document: &'a Document,
    /// What was computed from it.
    pub explained: &'a Explained,
}

/// Whether no damping acts in the model yet though sources are sought: its errors say nothing of what is missing then.
pub(super) fn is_undamped(document: &Document) -> bool {
    let sources = &document.project.sources;
    let acts = |s: &Source| s.state == State::Known;
    let sought = |s: &Source| s.state.is_sought();
    document.project.structure.matrices().is_some() && sources.iter().any(sought) && !sources.iter().any(acts)
}
