//! The application: one document, what is derived from it, what is looked at; every frame reads and asks.

pub use super::ask::{Ask, Message};
use super::commands;
use super::derived::Derived;
use super::document::{Applied, Document};
use super::edits::Edit;
use super::files::Pick;
use super::frame;
use super::frame::choose::Choosing;
use super::frame::dock::Desk;
use super::frame::leave::Leave;
use super::frame::panes::Pane;
use super::import::{dropped, is_project};
use super::importing::{self, Importing};
use super::learn::{self, Learn};
use super::photograph::Photograph;
use super::plots::export::Exports;
use super::schematic::gesture::Intent;
use super::stages;
use super::theme::{Palette, space};
use super::view::{Stage, View};
use super::wake::Guard;
use super::work::{Done, Work};
use crate::control::Control;
use crate::display::units;
use crate::session::recent::Recent;
use egui::{CentralPanel, Context, Frame, Margin, Ui};
use std::path::PathBuf;

/// Longest wait for a piece of work where nobody can cancel.
const LONGEST: std::time::Duration = std::time::Duration::from_mins(10);

/// Longest time between two looks at the progress of what runs.
const REFRESH: std::time::Duration = std::time::Duration::from_millis(50);

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
    /// The dialog for a file that is open in the window.
    pub choosing: Option<Choosing>,
    /// Whether the program may close.
    pub(super) closing: bool,
    /// Files on their way into a project.
    pub importing: Option<Importing>,
    /// The page of laws.
    pub learn: Learn,
    pub(super) work: Work,
    /// Lets no job hold the window when it closes.
    guard: Guard,
    /// Title of the window.
    named: String,
    /// Time of the last autosave, s.
    kept: f64,
}

impl App {
    /// Starts to read a project file in the background, or to look into a file of measurements.
    pub fn open(&mut self, ctx: &Context, file: PathBuf) {
        if !is_project(&file) {
            return self.import(ctx, &[file]);
        }
        let started = self.work.load(ctx, file);
        self.note(started);
    }

    /// Waits for everything that runs; for pictures and tests.
    ///
    /// # Errors
    /// The message of what failed.
    pub fn settle(&mut self, ctx: &Context) -> Result<(), String> {
        for done in self.work.wait(LONGEST) {
            match done {
                Ok(done) => self.done(ctx, done),
                Err(error) => self.fail(error.to_string()),
            }
        }
        self.settle_import(ctx, LONGEST);
        match &self.message {
            Some(message) if message.failed => Err(message.text.clone()),
            _ => Ok(()),
        }
    }

    fn poll(&mut self, ctx: &Context) {
        for done in self.work.poll() {
            match done {
                Ok(done) => self.done(ctx, done),
                Err(error) => self.fail(error.to_string()),
            }
        }
    }

    fn done(&mut self, ctx: &Context, done: Done) {
        match done {
            Done::Loaded(Ok((document, recovered))) => self.loaded(*document, recovered),
            Done::Changed(Ok(ready)) => {
                let finished = self.document.as_mut().map_or(Ok(()), |d| d.finish(*ready));
                self.note(finished);
                self.view.step = None;
            }
            Done::Picked(pick, paths) => self.picked(ctx, pick, paths),
            Done::Said(Ok(text)) => self.say(text),
            Done::Loaded(Err(error)) | Done::Changed(Err(error)) | Done::Said(Err(error)) => self.fail(error),
        }
    }

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
        let View { law, tour, limit_s, .. } = self.view;
        self.view = View { law, tour, limit_s, ..View::default() };
        self.message = None;
        if recovered {
            self.say("Unsaved changes of the last session were recovered; Undo takes them back.".to_owned());
        }
    }

    /// Says that something went well.
    pub fn say(&mut self, text: String) {
        self.message = Some(Message { text, failed: false });
        self.messages.extend(self.message.clone());
    }

    /// Says that something failed, with its reason.
    pub fn fail(&mut self, text: String) {
        self.message = Some(Message { text, failed: true });
        self.messages.extend(self.message.clone());
    }

    pub(super) fn note(&mut self, result: Result<(), String>) {
        if let Err(error) = result {
            self.fail(error);
        }
    }

    /// Name and progress of what runs.
    pub fn running(&self) -> Option<(&str, f64)> {
        let imported = || self.importing.as_ref().and_then(Importing::running);
        self.work.running().or_else(imported).or_else(|| self.derived.running()).or_else(|| self.learn.running())
    }

    /// Gives up what runs, on the user's wish.
    pub(super) fn stop(&mut self) {
        if self.running().is_none() {
            return;
        }
        self.work.cancel();
        self.derived.cancel();
        self.importing = self.importing.take().and_then(Importing::cancelled);
        self.learn.cancel();
        self.say("Cancelled.".to_owned());
    }

    /// Draws one frame and does what was asked for in it.
    pub fn frame(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.guard.watch(&ctx);
        self.poll(&ctx);
        self.step_import(&ctx);
        let busy = self.running().is_some();
        if let Some(photograph) = &mut self.photograph {
            photograph.frame(&ctx, busy);
        }
        let mut asks: Vec<Ask> = commands::pressed(&ctx).into_iter().map(Ask::Command).collect();
        asks.extend(dropped(&ctx));
        self.ask_before_closing(&ctx);
        self.name_window(&ctx);
        self.advance(&ctx);
        self.autosave(ctx.input(|i| i.time));
        if let Some(document) = &self.document {
            // What is downstream is computed by itself, in the background.
            self.derived.keep_up(document);
            self.derived.outcome(&ctx, document);
            stages::explain::keep_up(&mut self.view.explain, document, &self.derived.explained);
            let wanted = stages::explain::wanted(document, &self.view, &self.derived.explained);
            self.derived.explained.update(&ctx, document, &wanted);
        }
        frame::top::show(ui, self, &mut asks);
        frame::status::show(ui, self, &mut asks);
        if self.learn.open {
            learn::show(ui, self, &mut asks);
        } else if self.importing.is_some() {
            importing::show(ui, self, &mut asks);
        } else if self.document.is_some() {
            let desk = Frame::new().fill(Palette::of(ui.visuals()).desk).inner_margin(Margin::same(space::GAP as i8));
            CentralPanel::default().frame(desk).show(ui, |ui| frame::dock::show(ui, self, &mut asks));
        } else {
            frame::start::show(ui, self.recent.as_ref().map_or(&[], Recent::files), &mut asks);
        }
        frame::help::show(&ctx, self, &mut asks);
        frame::notice::show(&ctx, self, &mut asks);
        frame::leave::show(&ctx, self, &mut asks);
        frame::choose::show(&ctx, self, &mut asks);
        if let Some((text, failed)) = self.exports.poll(&ctx) {
            if failed { self.fail(text) } else { self.say(text) }
        }
        for ask in asks {
            self.answer(&ctx, ask);
        }
    }

    /// The project's title stands in the title of the window.
    fn name_window(&mut self, ctx: &Context) {
        let named = |d: &Document| {
            let mark = if d.session().is_dirty() { "*" } else { "" };
            format!("{}{mark} – Dashpot", d.project.title)
        };
        let name = self.document.as_ref().map_or_else(|| "Dashpot".to_owned(), named);
        if name != self.named {
            self.named.clone_from(&name);
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(name));
        }
    }

    fn advance(&mut self, ctx: &Context) {
        if self.view.animate && self.document.is_some() {
            let step = f64::from(ctx.input(|i| i.stable_dt)).min(0.1);
            self.view.phase = (self.view.phase + 1.6 * std::f64::consts::PI * step) % std::f64::consts::TAU;
            ctx.request_repaint_after(std::time::Duration::from_millis(16));
        }
        if self.running().is_some() {
            ctx.request_repaint_after(REFRESH);
        }
    }

    /// Does what was asked for.
    pub fn answer(&mut self, ctx: &Context, ask: Ask) {
        super::crash::remember(&ask.kind());
        match ask {
            Ask::Command(command) => self.command(ctx, command),
            Ask::Edit(edit) => self.edit(ctx, &edit),
            Ask::Open(file) => self.leave(ctx, Leave::Open(file)),
            Ask::New(template) => self.leave(ctx, Leave::New(template)),
            Ask::Leave(changes) => self.left(ctx, changes),
            Ask::Import(files) => self.import(ctx, &files),
            Ask::Importing(wish) => self.import_wish(ctx, wish),
            Ask::SaveAs(path) => self.save_as(&path),
            Ask::ExportAs(format) => self.pick(ctx, Pick::Export(format)),
            Ask::Export(format, path) => self.export(ctx, format, path),
            Ask::Stage(stage) => self.view.stage = stage,
            Ask::Schematic(intent) => self.intent(ctx, intent),
            Ask::Pane(pane, open) => self.desk.set_open(self.view.stage, pane, open),
            Ask::Explain(deed) => stages::explain::answer(self, ctx, deed),
            Ask::Pick(pick) => self.pick(ctx, pick),
            Ask::Picked(pick, paths) => self.picked(ctx, pick, paths),
            Ask::Dismiss => self.message = None,
        }
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
                let started = self.work.change(ctx, *waiting);
                self.note(started);
            }
            Err(error) => self.fail(error),
        }
    }

    fn intent(&mut self, ctx: &Context, intent: Intent) {
        match intent {
            Intent::SelectDof(dof) => (self.view.dof, self.view.source) = (Some(dof), None),
            Intent::SelectSource(source) => (self.view.dof, self.view.source) = (None, Some(source)),
            Intent::ClearSelection => (self.view.dof, self.view.source) = (None, None),
            Intent::Draw(dofs) => {
                self.view.dof = None;
                self.edit(ctx, &Edit::Draw(self.view.law, dofs));
            }
            Intent::CycleSource(source) => self.edit(ctx, &Edit::Cycle(source)),
            Intent::RemoveSource(source) => self.edit(ctx, &Edit::Remove(source)),
            Intent::Edit(edit) => self.edit(ctx, &edit),
        }
    }

    /// Makes a new project from a template.
    pub(super) fn new_from(&mut self, template: usize) {
        let Some(template) = super::templates::ALL.get(template) else { return };
        match Document::new(template.text) {
            Ok(document) => {
                self.loaded(document, false);
                self.view.stage = Stage::Structure;
                self.desk.set_open(Stage::Structure, Pane::Parameters, true);
                self.say("A new project; give it a name with Save as, then import measurements.".to_owned());
            }
            Err(error) => self.fail(error),
        }
    }

    /// Runs something in the background that ends with a sentence to say.
    pub fn run(
        &mut self,
        ctx: &Context,
        name: &str,
        work: impl FnOnce(&Control) -> Result<String, String> + Send + 'static,
    ) {
        let started = self.work.say(ctx, name, work);
        self.note(started);
    }

    /// Keeps unsaved changes beside the file now and then.
    fn autosave(&mut self, now: f64) {
        const EVERY: f64 = 20.0;
        if now - self.kept < EVERY {
            return;
        }
        self.kept = now;
        if let Some(Err(error)) = self.document.as_mut().map(Document::autosave) {
            self.fail(error);
        }
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        super::solid::install(ui.ctx(), frame.wgpu_render_state());
        self.frame(ui);
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, "desk", &self.desk);
        eframe::set_value(storage, "limit_s", &self.view.limit_s);
        eframe::set_value(storage, "units", &units::now());
    }
}
