//! The application: one document, what is derived from it, what is looked at.

mod actions;
pub mod ask;
pub mod commands;
pub(crate) mod leaving;
pub(crate) mod opened;
pub(crate) mod repaint;
mod update;
pub mod view;

use crate::control::Control;
use crate::session::recent::Recent;
pub use crate::window::app::ask::{Ask, Message};
use crate::window::app::leaving::Leave;
use crate::window::app::repaint::RepaintGuard;
use crate::window::app::view::{Stage, View};
use crate::window::background::derived::Derived;
use crate::window::background::jobs::Jobs;
use crate::window::document::edits::Edit;
use crate::window::document::{Applied, Document};
use crate::window::frame::choose::Choosing;
use crate::window::frame::desk::Desk;
use crate::window::frame::panes::Pane;
use crate::window::frame::report_choice::{ReportChoice, ReportRequest};
use crate::window::headless::photograph::Photograph;
use crate::window::importing::Importing;
use crate::window::learn::Learn;
use crate::window::plots::export::Exports;
use egui::Context;
use std::path::PathBuf;

/// Runs from which on the first look is at all of them.
const MANY_RUNS: usize = 24;

/// The whole window.
#[derive(Debug, Default)]
pub struct App {
    /// Open project.
    pub document: Option<Document>,
    /// What is computed from it.
    pub derived: Derived,
    /// What is looked at.
    pub view: View,
    /// How the panes lie.
    pub desk: Desk,
    /// Last message, until it is closed.
    pub message: Option<Message>,
    /// All messages, oldest first.
    pub messages: Vec<Message>,
    /// A photograph that is to be taken.
    pub photograph: Option<Photograph>,
    /// Plots that are being written to files.
    pub exports: Exports,
    /// Files opened last, where they are remembered.
    pub recent: Option<Recent>,
    /// Where the user wants to go, while it is asked what becomes of unsaved changes.
    pub leaving: Option<Leave>,
    /// Whether files are chosen inside the window: the desktop has no dialogs.
    pub own_dialogs: bool,
    /// What the report is to be, while it is asked.
    pub reporting: Option<ReportChoice>,
    /// What was decided of it, while it is asked where to.
    pub(super) report_request: Option<ReportRequest>,
    /// The dialog for a file that is open in the window.
    pub choosing: Option<Choosing>,
    /// Whether the program may close.
    pub(super) closing: bool,
    /// Files on their way into a project.
    pub importing: Option<Importing>,
    /// The page of laws.
    pub learn: Learn,
    pub(super) jobs: Jobs,
    /// Lets no job hold the window when it closes.
    pub(super) guard: RepaintGuard,
    /// Title of the window.
    pub(super) named: String,
    /// Time of the last autosave, s.
    pub(super) kept: f64,
}

impl App {
    /// Takes over a project that was read or made.
    pub fn loaded(&mut self, document: Document, recovered: bool) {
        if let (Some(recent), Some(path)) = (&mut self.recent, document.session().path()) {
            let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
            let kept = recent.add(&path).map_err(|e| e.to_string());
            self.note(kept);
        }
        if document.project.runs.len() > MANY_RUNS {
            self.desk.set_open(Stage::Measure, Pane::Overview, true);
        }
        self.document = Some(document);
        self.importing = None;
        self.derived = Derived::default();
        let View { law, tour, limit_s, less_motion, .. } = self.view;
        self.view = View { law, less_motion, tour, limit_s, ..View::default() };
        self.message = None;
        if recovered {
            self.say("Unsaved changes of the last session were recovered; Undo takes them back.".to_owned());
        }
    }

    /// Says that something went well.
    pub fn say(&mut self, text: String) {
        self.message = Some(Message { text, failed: false, restore: None });
        self.messages.extend(self.message.clone());
    }

    /// Says that something failed, with its reason.
    pub fn fail(&mut self, text: String) {
        self.message = Some(Message { text, failed: true, restore: None });
        self.messages.extend(self.message.clone());
    }

    /// Offers the project that was open when the program broke down, whose unsaved changes come back with it.
    pub fn offer(&mut self, text: String, project: Option<PathBuf>) {
        self.message = Some(Message { text, failed: true, restore: project });
        self.messages.extend(self.message.clone());
    }

    pub(crate) fn note(&mut self, result: Result<(), String>) {
        if let Err(error) = result {
            self.fail(error);
        }
    }

    /// Name and progress of what runs.
    pub fn running(&self) -> Option<(&str, f64)> {
        let imported = || self.importing.as_ref().and_then(Importing::running);
        self.jobs.running().or_else(imported).or_else(|| self.derived.running()).or_else(|| self.learn.running())
    }

    /// Gives up what runs, as the user asked.
    pub(crate) fn stop(&mut self) {
        if self.running().is_none() {
            return;
        }
        self.jobs.cancel();
        self.derived.cancel();
        self.importing = self.importing.take().and_then(Importing::cancelled);
        self.learn.cancel();
        self.say("Cancelled.".to_owned());
    }

    /// Changes the document, at once or when its records are read; or says why not.
    pub fn edit(&mut self, ctx: &Context, edit: &Edit) {
        let Some(document) = &mut self.document else { return };
        match document.apply(edit) {
            Ok(Applied::Done(drawn)) => {
                self.message = None;
                self.view.step = None;
                let gone = matches!(edit, Edit::Remove(_) | Edit::ClearCandidates);
                self.view.source = drawn.or(self.view.source.filter(|_| !gone));
            }
            Ok(Applied::Waits(waiting)) => {
                let started = self.jobs.change(ctx, *waiting);
                self.note(started);
            }
            Err(error) => self.fail(error),
        }
    }

    /// The same, and says so where it is done.
    pub fn edit_and_say(&mut self, ctx: &Context, edit: &Edit, said: String) {
        self.edit(ctx, edit);
        if self.message.as_ref().is_none_or(|m| !m.failed) {
            self.say(said);
        }
    }

    /// Runs something in the background that ends with a sentence to say.
    pub fn run(
        &mut self,
        ctx: &Context,
        name: &str,
        work: impl FnOnce(&Control) -> Result<String, String> + Send + 'static,
    ) {
        let started = self.jobs.say(ctx, name, work);
        self.note(started);
    }
}
