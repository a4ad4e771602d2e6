//! What each command of the table does.

use crate::exchange::Project;
use crate::exchange::export::Format;
use crate::exchange::project::file::ReportTable;
use crate::identify::Outcome;
use crate::report::{self, Known, LedgerRow, Origin, Request, Tables};
use crate::session::Command as Change;
use crate::window::app::App;
use crate::window::app::commands::Command;
use crate::window::app::leaving::{Changes, Leave};
use crate::window::app::view::Stage;
use crate::window::appearance::motion;
use crate::window::document::Document;
use crate::window::document::edits::Edit;
use crate::window::files::{self, Pick};
use crate::window::frame::menu_bar;
use crate::window::frame::report_choice::{ReportChoice, ReportRequest};
use egui::{Context, Theme, ViewportCommand};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

impl App {
    /// Does a command of the table.
    pub fn command(&mut self, ctx: &Context, command: Command) {
        match command {
            Command::Open => self.pick(ctx, Pick::Open),
            Command::Import => self.pick(ctx, Pick::Import),
            Command::Close => self.leave(ctx, Leave::Close),
            Command::Quit => self.leave(ctx, Leave::Quit),
            Command::Save => {
                self.save(ctx);
            }
            Command::Report => {
                self.reporting = self.document.as_ref().map(|d| ReportChoice::of(d.session().document().file()));
            }
            Command::SaveAs => self.pick(ctx, Pick::SaveAs),
            Command::Undo => self.history(Document::undo),
            Command::Redo => self.history(Document::redo),
            Command::RemoveSelected => {
                if let Some(source) = self.view.source {
                    self.edit(ctx, &Edit::Remove(source));
                }
            }
            Command::ClearCandidates => self.edit(ctx, &Edit::ClearCandidates),
            Command::Cancel => self.stop(),
            Command::Theme => ctx.set_theme(if ctx.theme() == Theme::Dark { Theme::Light } else { Theme::Dark }),
            Command::LessMotion => self.set_less_motion(ctx, !self.view.less_motion),
            Command::Shape => self.view.shape = !self.view.shape,
            Command::Animate => self.view.animate = !self.view.animate,
            Command::Measure => self.view.stage = Stage::Measure,
            Command::Structure => self.view.stage = Stage::Structure,
            Command::Pattern => self.view.stage = Stage::Pattern,
            Command::Select => self.view.stage = Stage::Select,
            Command::Result => self.view.stage = Stage::Result,
            Command::Explain => self.view.stage = Stage::Explain,
            Command::StepBack => self.step(false),
            Command::StepOn => self.step(true),
            Command::StepEnd => self.view.step = None,
            Command::PreviousRun => self.view.run = self.view.run.saturating_sub(1),
            Command::NextRun => {
                let last = self.document.as_ref().map_or(0, |d| d.project.runs.len().saturating_sub(1));
                self.view.run = (self.view.run + 1).min(last);
            }
            Command::ResetLayout => self.desk.reset(self.view.stage),
            Command::Messages => self.view.messages = !self.view.messages,
            Command::Menus => menu_bar::focus(ctx),
            Command::Tour => self.view.tour = if self.view.tour.is_some() { None } else { Some(0) },
            Command::Laws => self.learn.open = !self.learn.open,
            Command::Keys => self.view.keys = !self.view.keys,
            Command::About => self.view.about = !self.view.about,
        }
    }

    /// Leaves transitions out, and ends what moves, or lets them be.
    pub(crate) fn set_less_motion(&mut self, ctx: &Context, less: bool) {
        self.view.less_motion = less;
        self.view.animate &= !less;
        motion::set_less(ctx, less);
    }

    /// Back or forth in the history; what was selected may not be there any more.
    fn history(&mut self, step: fn(&mut Document) -> Option<String>) {
        self.document.as_mut().and_then(step);
        self.view.source = None;
        self.view.step = None;
    }

    /// Saves the project; whether it is saved now.
    fn save(&mut self, ctx: &Context) -> bool {
        let Some(document) = &mut self.document else { return false };
        if document.session().path().is_none() {
            self.pick(ctx, Pick::SaveAs);
            return false;
        }
        let saved = document.save();
        match &saved {
            Ok(()) => self.say("Saved.".to_owned()),
            Err(error) => self.fail(error.clone()),
        }
        saved.is_ok()
    }

    /// Goes, or asks first what becomes of unsaved changes.
    pub(crate) fn leave(&mut self, ctx: &Context, to: Leave) {
        if self.document.as_ref().is_some_and(|d| d.session().is_dirty()) {
            self.leaving = Some(to);
        } else {
            self.go(ctx, to);
        }
    }

    /// The answer to what becomes of unsaved changes.
    pub(crate) fn left(&mut self, ctx: &Context, changes: Changes) {
        let Some(to) = self.leaving.take() else { return };
        match changes {
            Changes::Keep => {}
            Changes::Save => {
                if self.save(ctx) {
                    self.go(ctx, to);
                }
            }
            Changes::Discard => {
                if let Some(Err(error)) = self.document.as_ref().map(Document::forget) {
                    self.fail(error);
                }
                self.go(ctx, to);
            }
        }
    }

    fn go(&mut self, ctx: &Context, to: Leave) {
        match to {
            Leave::Close => (self.document, self.importing) = (None, None),
            Leave::Open(file) => self.open(ctx, file),
            Leave::New(template) => self.new_from(template),
            Leave::Quit => {
                self.closing = true;
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
        }
    }

    /// Writes something of what was identified, in the background.
    fn write_identified(
        &mut self,
        ctx: &Context,
        name: &str,
        work: impl FnOnce(&Project, &Outcome) -> Result<String, String> + Send + 'static,
    ) {
        let Some(document) = &self.document else { return };
        match self.derived.known_outcome(document) {
            Some(Ok(outcome)) => {
                let project = document.project.clone();
                self.run(ctx, name, move |_| work(&project, &outcome));
            }
            Some(Err(error)) => self.fail(error),
            None => self.fail("Identification is still running; ask again when it has ended.".to_owned()),
        }
    }

    /// Hands what was identified to another program.
    pub(crate) fn export(&mut self, ctx: &Context, format: Format, path: PathBuf) {
        self.write_identified(ctx, "Exporting", move |p, outcome| files::export(p, outcome, format, &path));
    }

    /// Keeps what stands on the title page in the project, and asks where the report is to be written.
    pub(crate) fn want_report(&mut self, ctx: &Context, request: ReportRequest) {
        let changed = self.document.as_ref().is_some_and(|d| d.session().document().file().report != request.heading);
        if changed {
            self.edit(ctx, &Edit::Do(Change::SetReport(request.heading.clone())));
        }
        self.report_request = Some(request);
        self.pick(ctx, Pick::Report);
    }

    /// Writes the report of what there is; what has not been computed yet is computed for it.
    pub(crate) fn report(&mut self, ctx: &Context, path: PathBuf) {
        let Some(document) = &self.document else { return };
        let explained = &self.derived.explained;
        let row = |step: usize| {
            let step = &explained.ledger.steps()[step];
            LedgerRow { label: step.label.clone(), error: step.error, noise_floor: step.noise_floor }
        };
        let known = Known {
            outcome: self.derived.known_outcome(document),
            comparison: explained.comparison(document).cloned(),
            diagnosis: explained.diagnosis(document).cloned(),
            ledger: explained.ledger.path().into_iter().map(row).collect(),
        };
        let project = document.project.clone();
        let chosen = self
            .report_request
            .take()
            .unwrap_or_else(|| ReportChoice::of(document.session().document().file()).request());
        let on = document.session().document();
        let origin = Origin {
            path: document.session().path().map(Path::to_path_buf),
            folder: on.folder().to_owned(),
            file: on.file().clone(),
        };
        let request = Request {
            // What the title page says is in the project by now.
            heading: ReportTable::default(),
            sections: chosen.sections,
            limit: Some(Duration::from_secs_f64(chosen.limit_s)),
            tables: if chosen.tables { Tables::Beside } else { Tables::None },
            origin: Some(origin),
            made_s: now_s(),
        };
        self.run(ctx, "Report", move |control| report::write(&project, known, &request, &path, control));
    }

    /// The desktop wants to close the window: not before it is asked what becomes of unsaved changes.
    pub(crate) fn ask_before_closing(&mut self, ctx: &Context) {
        let asked = ctx.input(|i| i.viewport().close_requested());
        let dirty = self.document.as_ref().is_some_and(|d| d.session().is_dirty());
        if asked && dirty && !self.closing {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.leaving = Some(Leave::Quit);
        }
    }

    /// Looks at the set with one source more or less.
    fn step(&mut self, on: bool) {
        let Some(Some(Ok(outcome))) = self.document.as_ref().map(|d| self.derived.known_outcome(d)) else { return };
        let now = self.view.step.unwrap_or(outcome.accepted);
        let last = outcome.steps.len().saturating_sub(1);
        self.view.step = Some(if on { (now + 1).min(last) } else { now.saturating_sub(1).min(last) });
    }
}

/// Seconds since the beginning of 1970 (UTC).
#[expect(clippy::disallowed_methods, reason = "a report bears the date on which it is made; no result depends on it")]
fn now_s() -> Option<f64> {
    SystemTime::now().duration_since(UNIX_EPOCH).ok().map(|since| since.as_secs_f64())
}
