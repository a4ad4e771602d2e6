//! The application: one document, what is derived from it, what is looked at; every frame reads and asks.

use super::commands::{self, Command};
use super::derived::Derived;
use super::document::{Document, Edit};
use super::frame;
use super::frame::dock::Desk;
use super::frame::panes::Pane;
use super::photograph::Photograph;
use super::plots::export::Exports;
use super::schematic::gesture::Intent;
use super::stages;
use super::theme::{Palette, space};
use super::view::{Stage, View};
use crate::effects::State;
use crate::identify::Status;
use crate::session::jobs::Job;
use egui::{CentralPanel, Context, Frame, Margin, Theme, Ui};
use std::path::PathBuf;

/// Longest wait for a project where nobody can cancel.
const LONGEST: std::time::Duration = std::time::Duration::from_mins(10);

/// A message that stays until it is closed.
#[derive(Debug, Clone, PartialEq)]
pub struct Message {
    /// What happened.
    pub text: String,
    /// Whether something failed.
    pub failed: bool,
}

/// What a pane may ask for.
#[derive(Debug, Clone, PartialEq)]
pub enum Ask {
    /// A command of the table.
    Command(Command),
    /// A change of the document.
    Edit(Edit),
    /// A project file.
    Open(PathBuf),
    /// A stage.
    Stage(Stage),
    /// Something on the schematic.
    Schematic(Intent),
    /// Open or close a pane of the stage.
    Pane(Pane, bool),
    /// Close the message.
    Dismiss,
}

type Loaded = Result<(Document, bool), String>;

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
    /// Last message.
    pub message: Option<Message>,
    /// A photograph that is to be taken.
    pub photograph: Option<Photograph>,
    /// Plots that are being written to files.
    pub exports: Exports,
    loading: Option<Job<(), Loaded>>,
    /// Time of the last autosave, s.
    kept: f64,
}

impl App {
    /// Starts to read a project file in the background.
    pub fn open(&mut self, ctx: &Context, file: PathBuf) {
        let name = file.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        let work = move |control: &crate::control::Control| Document::open(&file, control);
        let wake = ctx.clone();
        match Job::start(&format!("Reading {name}"), (), move || wake.request_repaint(), work) {
            Ok(job) => self.loading = Some(job),
            Err(error) => self.fail(error.to_string()),
        }
    }

    /// Waits for everything that runs; for pictures and tests.
    ///
    /// # Errors
    /// The message of what failed.
    pub fn settle(&mut self) -> Result<(), String> {
        if let Some(job) = self.loading.take() {
            let loaded = job.wait(LONGEST).ok_or("the project is read for ten minutes and has not ended")?;
            self.loaded(loaded.map_err(|e| e.to_string())?);
        }
        match &self.message {
            Some(message) if message.failed => Err(message.text.clone()),
            _ => Ok(()),
        }
    }

    fn loaded(&mut self, loaded: Loaded) {
        let (document, recovered) = match loaded {
            Ok(loaded) => loaded,
            Err(error) => return self.fail(error),
        };
        self.document = Some(document);
        self.derived = Derived::default();
        self.view = View { law: self.view.law, ..View::default() };
        let text = "Unsaved changes of the last session were recovered; Undo takes them back.".to_owned();
        self.message = recovered.then_some(Message { text, failed: false });
    }

    fn fail(&mut self, text: String) {
        self.message = Some(Message { text, failed: true });
    }

    fn poll(&mut self) {
        match self.loading.as_ref().and_then(Job::poll) {
            Some(Ok(loaded)) => {
                self.loading = None;
                self.loaded(loaded);
            }
            Some(Err(error)) => {
                self.loading = None;
                self.fail(error.to_string());
            }
            None => {}
        }
    }

    /// Name and progress of what runs.
    pub fn running(&self) -> Option<(&str, f64)> {
        self.loading.as_ref().map(|j| (j.name(), j.progress())).or_else(|| self.derived.running())
    }

    /// Draws one frame and does what was asked for in it.
    pub fn frame(&mut self, ui: &mut Ui) {
        self.poll();
        let ctx = ui.ctx().clone();
        let busy = self.running().is_some();
        if let Some(photograph) = &mut self.photograph {
            photograph.frame(&ctx, busy);
        }
        let mut asks: Vec<Ask> = commands::pressed(&ctx).into_iter().map(Ask::Command).collect();
        asks.extend(dropped(&ctx).map(Ask::Open));
        self.advance(&ctx);
        self.autosave(ctx.input(|i| i.time));
        if let Some(document) = &self.document {
            // What is downstream is computed by itself, in the background.
            self.derived.outcome(&ctx, document);
        }
        frame::top::show(ui, self, &mut asks);
        frame::status::show(ui, self, &mut asks);
        if self.document.is_some() {
            self.work(ui, &mut asks);
        } else {
            frame::start::show(ui, &mut asks);
        }
        frame::keys::show(&ctx, &mut self.view);
        if let Some((text, failed)) = self.exports.poll(&ctx) {
            self.message = Some(Message { text, failed });
        }
        for ask in asks {
            self.answer(&ctx, ask);
        }
    }

    fn work(&mut self, ui: &mut Ui, asks: &mut Vec<Ask>) {
        let palette = Palette::of(ui.visuals());
        let desk = Frame::new().fill(palette.desk).inner_margin(Margin::same(space::GAP as i8));
        CentralPanel::default().frame(desk).show(ui, |ui| frame::dock::show(ui, self, asks));
    }

    fn advance(&mut self, ctx: &Context) {
        if self.view.animate && self.document.is_some() {
            let step = f64::from(ctx.input(|i| i.stable_dt)).min(0.1);
            self.view.phase = (self.view.phase + 1.6 * std::f64::consts::PI * step) % std::f64::consts::TAU;
            ctx.request_repaint_after(std::time::Duration::from_millis(16));
        }
        if self.running().is_some() {
            ctx.request_repaint_after(std::time::Duration::from_millis(100));
        }
    }

    /// Does what was asked for.
    pub fn answer(&mut self, ctx: &Context, ask: Ask) {
        match ask {
            Ask::Command(command) => self.command(ctx, command),
            Ask::Edit(edit) => self.edit(&edit),
            Ask::Open(file) => self.open(ctx, file),
            Ask::Stage(stage) => self.view.stage = stage,
            Ask::Schematic(intent) => self.intent(intent),
            Ask::Pane(pane, open) => self.desk.set_open(self.view.stage, pane, open),
            Ask::Dismiss => self.message = None,
        }
    }

    fn edit(&mut self, edit: &Edit) {
        let Some(document) = &mut self.document else { return };
        match document.apply(edit) {
            Ok(drawn) => {
                self.message = None;
                self.view.step = None;
                let gone = matches!(edit, Edit::Remove(_) | Edit::ClearCandidates);
                self.view.source = drawn.or(self.view.source.filter(|_| !gone));
            }
            Err(error) => self.fail(error),
        }
    }

    fn intent(&mut self, intent: Intent) {
        match intent {
            Intent::SelectDof(dof) => (self.view.dof, self.view.source) = (Some(dof), None),
            Intent::SelectSource(source) => (self.view.dof, self.view.source) = (None, Some(source)),
            Intent::ClearSelection => (self.view.dof, self.view.source) = (None, None),
            Intent::Draw(dofs) => {
                self.view.dof = None;
                self.edit(&Edit::Draw(self.view.law, dofs));
            }
            Intent::CycleSource(source) => self.edit(&Edit::Cycle(source)),
            Intent::RemoveSource(source) => self.edit(&Edit::Remove(source)),
        }
    }

    fn command(&mut self, ctx: &Context, command: Command) {
        match command {
            Command::Open => self.ask_for_file(ctx),
            Command::Close => self.document = None,
            Command::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
            Command::Save => self.save(),
            Command::Undo => {
                self.document.as_mut().and_then(Document::undo);
                self.view.source = None;
            }
            Command::Redo => {
                self.document.as_mut().and_then(Document::redo);
                self.view.source = None;
            }
            Command::RemoveSelected => {
                if let Some(source) = self.view.source {
                    self.edit(&Edit::Remove(source));
                }
            }
            Command::ClearCandidates => self.edit(&Edit::ClearCandidates),
            Command::Theme => ctx.set_theme(if ctx.theme() == Theme::Dark { Theme::Light } else { Theme::Dark }),
            Command::Shape => self.view.shape = !self.view.shape,
            Command::Animate => self.view.animate = !self.view.animate,
            Command::Measure => self.view.stage = Stage::Measure,
            Command::Structure => self.view.stage = Stage::Structure,
            Command::Pattern => self.view.stage = Stage::Pattern,
            Command::Select => self.view.stage = Stage::Select,
            Command::Result => self.view.stage = Stage::Result,
            Command::StepBack => self.step(false),
            Command::StepOn => self.step(true),
            Command::PreviousRun => self.view.run = self.view.run.saturating_sub(1),
            Command::NextRun => {
                let last = self.document.as_ref().map_or(0, |d| d.project.runs.len().saturating_sub(1));
                self.view.run = (self.view.run + 1).min(last);
            }
            Command::StepEnd => self.view.step = None,
            Command::ResetLayout => self.desk.reset(self.view.stage),
            Command::Keys => self.view.keys = !self.view.keys,
        }
    }

    fn save(&mut self) {
        let Some(document) = &mut self.document else { return };
        match document.save() {
            Ok(()) => self.message = Some(Message { text: "Saved.".to_owned(), failed: false }),
            Err(error) => self.fail(error),
        }
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

    /// Looks at the set with one source more or less.
    fn step(&mut self, on: bool) {
        let Some(Some(Ok(outcome))) = self.document.as_ref().map(|d| self.derived.known_outcome(d)) else { return };
        let now = self.view.step.unwrap_or(outcome.accepted);
        let last = outcome.steps.len().saturating_sub(1);
        self.view.step = Some(if on { (now + 1).min(last) } else { now.saturating_sub(1).min(last) });
    }

    fn ask_for_file(&mut self, ctx: &Context) {
        let picked = rfd::FileDialog::new().add_filter("Dashpot project", &["toml"]).pick_file();
        if let Some(file) = picked {
            self.open(ctx, file);
        }
    }

    /// State of the stage for its mark: whether it needs attention and why, in one line.
    pub fn mark(&self, stage: Stage) -> frame::top::Mark {
        use frame::top::Mark;
        let Some(document) = &self.document else { return Mark::empty("No project is open.") };
        let p = &document.project;
        match stage {
            Stage::Measure if p.runs.is_empty() => Mark::empty("No runs: add [[run]] entries to the project file."),
            Stage::Measure => {
                let flagged = p.runs.iter().filter(|r| r.enabled && !r.findings.is_empty()).count();
                let used = p.runs.iter().filter(|r| r.enabled).count();
                if flagged > 0 {
                    Mark::attention(&format!("{flagged} of {used} used runs are flagged."))
                } else {
                    Mark::done(&format!("{used} runs are used, none is flagged."))
                }
            }
            Stage::Structure if p.structure.matrices().is_none() => {
                Mark::done("Points: energy balance only, no model.")
            }
            Stage::Structure => Mark::done(&format!("{} degrees of freedom.", p.structure.len())),
            Stage::Pattern => {
                let open = p.sources.iter().filter(|s| matches!(s.state, State::Candidate | State::Forced)).count();
                if open == 0 {
                    Mark::empty("No candidates: click on the schematic or add a family.")
                } else {
                    Mark::done(&format!("{open} candidates."))
                }
            }
            Stage::Select | Stage::Result => match self.derived.known_outcome(document) {
                None => Mark::empty("Identification has not ended yet."),
                Some(Err(error)) => Mark::attention(error),
                Some(Ok(outcome)) => {
                    let text = format!(
                        "{} sources: {}.",
                        outcome.accepted_step().count,
                        stages::select::status(outcome.status)
                    );
                    let good = matches!(outcome.status, Status::WithinNoise | Status::BelowAngle);
                    if good { Mark::done(&text) } else { Mark::attention(&text) }
                }
            },
        }
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        super::solid::install(ui.ctx(), frame.wgpu_render_state());
        self.frame(ui);
    }
}

fn dropped(ctx: &Context) -> impl Iterator<Item = PathBuf> {
    let files = ctx.input(|i| i.raw.dropped_files.clone());
    files.into_iter().map(|f| f.path().to_path_buf())
}
