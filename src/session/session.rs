//! A document that is being worked on: commands in, undo and redo, what is unsaved, where it is saved.

use super::command::Command;
use super::document::{Document, Revisions};
use super::history::{Gesture, History};
use super::refusal::Refusal;
use super::save::{self, SaveError};
use crate::exchange::project::file::ProjectFile;
use crate::exchange::project::open;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A document with its history.
#[derive(Debug, Clone)]
pub struct Session {
    document: Document,
    history: History<Document>,
    revisions: Revisions,
    path: Option<PathBuf>,
    /// The document as it was opened or saved last.
    saved: Option<Arc<ProjectFile>>,
    /// What the file on the disk held then, as it is written there.
    disk: Option<ProjectFile>,
    /// What the autosave holds.
    kept: Option<Arc<ProjectFile>>,
}

impl Session {
    /// A session on a new document that has no file yet.
    pub fn new(document: Document) -> Self {
        let (history, revisions) = (History::default(), Revisions::default());
        Self { document, history, revisions, path: None, saved: None, disk: None, kept: None }
    }

    /// Opens the project at `path`. Records are not read: that is long work.
    ///
    /// # Errors
    /// What the reader of projects says, or what makes the document invalid.
    pub fn open(path: &Path) -> Result<Self, Refusal> {
        let document = Document::from(open(path)?);
        let saved = Some(document.file().clone());
        Ok(Self { path: Some(path.to_owned()), saved, disk: save::on_disk(path), ..Self::new(document) })
    }

    /// The unsaved changes that a crash left beside the file, as one action that can be undone. Returns whether there were
    /// any.
    ///
    /// # Errors
    /// [`Refusal`] where they make no valid document.
    pub fn recover(&mut self) -> Result<bool, Refusal> {
        let Some(kept) = self.path.as_deref().and_then(save::recoverable) else { return Ok(false) };
        let document = self.document.with(kept)?;
        self.go_to(document, "recover unsaved changes".into(), None);
        Ok(true)
    }

    /// Does a command.
    ///
    /// # Errors
    /// [`Refusal`] with the reason; then nothing has changed.
    pub fn apply(&mut self, command: &Command) -> Result<(), Refusal> {
        self.apply_in(command, None)
    }

    /// Does a command as a part of a gesture; commands of one gesture are undone together.
    ///
    /// # Errors
    /// [`Refusal`] with the reason; then nothing has changed.
    pub fn apply_in(&mut self, command: &Command, gesture: Option<Gesture>) -> Result<(), Refusal> {
        let document = self.document.after(command)?;
        self.go_to(document, command.label(), gesture);
        Ok(())
    }

    fn go_to(&mut self, document: Document, label: String, gesture: Option<Gesture>) {
        if document == self.document {
            return;
        }
        let before = std::mem::replace(&mut self.document, document);
        self.revisions.advance(before.file(), self.document.file());
        self.history.record(label, gesture, before);
    }

    /// Takes the last action back and returns its label.
    pub fn undo(&mut self) -> Option<String> {
        self.step(History::undo)
    }

    /// Does the last action that was taken back again and returns its label.
    pub fn redo(&mut self) -> Option<String> {
        self.step(History::redo)
    }

    fn step(&mut self, step: impl Fn(&mut History<Document>, &mut Document) -> Option<String>) -> Option<String> {
        let before = self.document.file().clone();
        let label = step(&mut self.history, &mut self.document)?;
        self.revisions.advance(&before, self.document.file());
        Some(label)
    }

    /// Goes back to a document as it was earlier, as an action that can be undone.
    pub fn return_to(&mut self, document: &Document, label: &str) {
        self.go_to(document.clone(), label.into(), None);
    }

    /// The document.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Labels of what can be undone and redone.
    pub fn history(&self) -> &History<Document> {
        &self.history
    }

    /// How often each part was changed.
    pub fn revisions(&self) -> Revisions {
        self.revisions
    }

    /// File of the project.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Whether the document differs from its file.
    pub fn is_dirty(&self) -> bool {
        self.saved.as_ref() != Some(self.document.file())
    }

    /// Saves the document to its file.
    ///
    /// # Errors
    /// [`SaveError`], also where another window or program has changed the project there; then the file is as it was and the
    /// document still unsaved.
    pub fn save(&mut self) -> Result<(), SaveError> {
        let path = self.path.clone().ok_or(SaveError::NoPath)?;
        if save::on_disk(&path).is_some_and(|now| self.disk.as_ref() != Some(&now)) {
            return Err(SaveError::ChangedElsewhere { path });
        }
        save::save(&self.document.file_in(parent(&path))?, &path, Some(&path))?;
        self.saved_to(&path);
        Ok(())
    }

    fn saved_to(&mut self, path: &Path) {
        self.saved = Some(self.document.file().clone());
        self.disk = save::on_disk(path);
        self.kept = None;
    }

    /// Saves the document under another name and goes on with that; files are then named from its folder.
    ///
    /// # Errors
    /// [`SaveError`]; then the session goes on with the old file.
    pub fn save_as(&mut self, path: &Path) -> Result<(), SaveError> {
        save::save(&self.document.file_in(parent(path))?, path, self.path.as_deref())?;
        self.path = Some(path.to_owned());
        self.saved_to(path);
        Ok(())
    }

    /// Keeps unsaved changes beside the file, unless they are kept already. Returns whether anything was written.
    ///
    /// # Errors
    /// [`SaveError`].
    pub fn autosave(&mut self) -> Result<bool, SaveError> {
        let Some(path) = self.path.as_deref() else { return Ok(false) };
        if !self.is_dirty() || self.kept.as_ref() == Some(self.document.file()) {
            return Ok(false);
        }
        save::autosave(&self.document.file_in(parent(path))?, path)?;
        self.kept = Some(self.document.file().clone());
        Ok(true)
    }
}

fn parent(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}
