//! What the panes of the stage Explain read.

use crate::diagnosis::Diagnosis;
use crate::effects::{Source, State};
use crate::session::adoption::Adoption;
use crate::session::{Command, Refusal};
use crate::window::document::Document;
use crate::window::explained::Explained;

/// What the panes read.
pub(super) struct Scene<'a> {
    /// The open project.
    pub document: &'a Document,
    /// What was computed from it.
    pub explained: &'a Explained,
}

impl<'a> Scene<'a> {
    /// What the search found, once it has ended.
    pub(super) fn diagnosis(&self) -> Option<&'a Diagnosis> {
        self.explained.diagnosis(self.document)?.as_ref().ok().map(AsRef::as_ref)
    }

    /// The sources that act in the model, in the order of the project.
    pub(super) fn known(&self) -> Vec<Source> {
        self.explained.known(self.document)
    }

    /// The commands that take over into the project what `step` does.
    ///
    /// # Errors
    /// One sentence that says why it cannot be done.
    pub(super) fn commands(
        &self,
        step: impl FnOnce(&mut Adoption) -> Result<(), Refusal>,
    ) -> Result<Vec<Command>, String> {
        let mut adoption = Adoption::new(self.document.session().document());
        step(&mut adoption).map_err(|refusal| refusal.to_string())?;
        Ok(adoption.commands)
    }
}

/// Whether no damping acts in the model yet though sources are sought: its errors say nothing of what is missing then.
pub(super) fn is_undamped(document: &Document) -> bool {
    let sources = &document.project.sources;
    let acts = |s: &Source| s.state == State::Known;
    let sought = |s: &Source| s.state.is_sought();
    document.project.structure.matrices().is_some() && sources.iter().any(sought) && !sources.iter().any(acts)
}
