//! One frame: it takes over what has ended in the background, shows the panes, which read and ask, and answers them.

use crate::display::units;
use crate::session::recent::Recent;
use crate::window::app::commands;
use crate::window::app::leaving::Leave;
use crate::window::app::opened::Opened;
use crate::window::app::view::Stage;
use crate::window::app::{App, Ask};
use crate::window::appearance::theme::{Palette, space};
use crate::window::background::jobs::Done;
use crate::window::document::Document;
use crate::window::document::edits::Edit;
use crate::window::files::Pick;
use crate::window::files::import::{dropped, is_project};
use crate::window::frame;
use crate::window::frame::panes::Pane;
use crate::window::importing;
use crate::window::language::{self, Language};
use crate::window::learn;
use crate::window::schematic::gesture::Intent;
use crate::window::stages;
use crate::window::stages::explain::request::Request;
use egui::{CentralPanel, Context, Frame, Margin, Ui};
use std::path::PathBuf;

/// Longest wait for a piece of work where nobody can cancel.
const LONGEST: std::time::Duration = std::time::Duration::from_mins(10);

/// Longest time between two looks at the progress of what runs.
const REFRESH: std::time::Duration = std::time::Duration::from_millis(50);

impl App {
    /// Starts to read a project file in the background, or to look into a file of measurements.
    pub fn open(&mut self, ctx: &Context, file: PathBuf) {
        if !is_project(&file) {
            return self.import(ctx, &[file]);
        }
        let started = self.jobs.load(ctx, file);
        self.note(started);
    }

    /// Waits for everything that runs; for pictures and tests.
    ///
    /// # Errors
    /// The message of what failed.
    pub fn settle(&mut self, ctx: &Context) -> Result<(), String> {
        for done in self.jobs.wait(LONGEST) {
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
        for done in self.jobs.poll() {
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
            Done::Picked(pick, name, paths, open) => self.closed(ctx, pick, name, paths, open),
            Done::Said(Ok(text)) => self.say(text),
            Done::Loaded(Err(error)) | Done::Changed(Err(error)) | Done::Said(Err(error)) => self.fail(error),
        }
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
            learn::show(ui, &mut self.learn, &mut asks);
        } else if let Some(importing) = &mut self.importing {
            importing::show(ui, importing, &mut asks);
        } else if let Some(document) = &self.document {
            let desk = Frame::new().fill(Palette::of(ui.visuals()).desk).inner_margin(Margin::same(space::GAP as i8));
            let opened = Opened { document, derived: &mut self.derived, view: &mut self.view };
            CentralPanel::default().frame(desk).show(ui, |ui| frame::dock::show(ui, &mut self.desk, opened, &mut asks));
        } else {
            frame::start::show(ui, self.recent.as_ref().map_or(&[], Recent::files), &mut asks);
        }
        self.help(&ctx, &mut asks);
        frame::notice::show(&ctx, self.message.as_ref(), &mut asks);
        frame::notice::list(&ctx, &self.messages, &mut self.view.messages);
        if self.leaving.is_some() {
            let title = self.document.as_ref().map_or("", |d| &d.project.title);
            frame::leave::show(&ctx, title, &mut asks);
        }
        frame::report::show(&ctx, &mut self.reporting, &mut asks);
        frame::choose::show(&ctx, &mut self.choosing, &mut asks);
        frame::focus::show(&ctx, &mut self.view.by_keyboard);
        if let Some((text, failed)) = self.exports.poll(&ctx) {
            if failed { self.fail(text) } else { self.say(text) }
        }
        for ask in asks {
            self.answer(&ctx, ask);
        }
        self.ask_for_plot(&ctx);
    }

    /// The list of keys, what the program is, the tour.
    fn help(&mut self, ctx: &Context, asks: &mut Vec<Ask>) {
        frame::help::show(ctx, &mut self.view);
        if self.document.is_some() {
            frame::help::tour(ctx, &mut self.view, &mut self.desk);
        } else if self.view.tour.is_some() && self.running().is_none() {
            frame::help::begin_tour(&mut self.view, asks);
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
        crate::window::crash::remember(&ask.kind());
        match ask {
            Ask::Command(command) => self.command(ctx, command),
            Ask::Edit(edit) => self.edit(ctx, &edit),
            Ask::Open(file) => self.leave(ctx, Leave::Open(file)),
            Ask::New(template) => self.leave(ctx, Leave::New(template)),
            Ask::Leave(changes) => self.left(ctx, changes),
            Ask::Import(files) => self.import(ctx, &files),
            Ask::Importing(action) => self.act_on_import(ctx, action),
            Ask::SaveAs(path) => self.save_as(&path),
            Ask::ExportAs(format) => self.pick(ctx, Pick::Export(format)),
            Ask::Export(format, path) => self.export(ctx, format, path),
            Ask::Stage(stage) => self.view.stage = stage,
            Ask::Schematic(intent) => self.intent(ctx, intent),
            Ask::Pane(pane, open) => self.desk.set_open(self.view.stage, pane, open),
            Ask::Explain(request) => self.explain(ctx, request),
            Ask::Pick(pick) => self.pick(ctx, pick),
            Ask::Picked(pick, paths) => self.picked(ctx, pick, paths),
            Ask::Report(request) => self.want_report(ctx, *request),
            Ask::Refuse(why) => self.fail(why),
            Ask::Dismiss => self.message = None,
        }
    }

    /// Does what is requested in the stage Explain: what it changes in the project, then what is looked at.
    fn explain(&mut self, ctx: &Context, request: Request) {
        let Some(document) = &mut self.document else { return };
        let change = stages::explain::changes::change(&request, document, &self.derived);
        if let Request::Return(step) = request
            && stages::explain::go_back(document, &self.derived.explained.ledger, step)
        {
            self.view.source = None;
        }
        stages::explain::look_on(request, &mut self.view, &mut self.derived.explained);
        match change {
            Ok(Some(change)) => self.edit_and_say(ctx, &change.edit, change.said),
            Ok(None) => {}
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
    pub(crate) fn new_from(&mut self, template: usize) {
        let Some(template) = crate::window::document::templates::ALL.get(template) else { return };
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

    /// Keeps unsaved changes beside the file now and then.
    fn autosave(&mut self, now: f64) {
        const EVERY: f64 = 20.0;
        // A clock that jumps back must not put it off.
        if (now - self.kept).abs() < EVERY {
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
        crate::window::solid::install(ui.ctx(), frame.wgpu_render_state());
        self.frame(ui);
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, "desk", &self.desk);
        eframe::set_value(storage, "limit_s", &self.view.limit_s);
        // Where it is as the desktop asks, it goes on following the desktop.
        let own = Some(self.view.less_motion).filter(|less| *less != crate::window::appearance::motion::is_unwanted());
        eframe::set_value(storage, "less_motion", &own);
        eframe::set_value(storage, "units", &units::now());
        // The same of the language.
        let own = Some(language::now()).filter(|language| *language != Language::of_system());
        eframe::set_value(storage, "language", &own);
    }
}
