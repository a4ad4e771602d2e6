//! What the window does with measurement files: looks into them, makes a project of them, or adds them to the one that is open.

use crate::exchange::importing::Request;
use crate::exchange::mapping::is_own_record;
use crate::session::Command;
use crate::window::app::App;
use crate::window::app::ask::Ask;
use crate::window::document::edits::Edit;
use crate::window::files::Pick;
use crate::window::importing::destination::ImportAction;
use crate::window::importing::{Importing, Made, OpenProject, Progress};
use egui::Context;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

impl App {
    /// Opens measurement files. Records in the program's own form go into the open project at once.
    pub(crate) fn import(&mut self, ctx: &Context, files: &[PathBuf]) {
        if let Some(Importing::Ready(draft)) = &self.importing {
            // Files that are given one after the other belong together.
            let mut request = Request { channels: None, frf: None, ..draft.request.clone() };
            let more = Request::of(files.to_vec());
            request.files.extend(more.files);
            request.mass = more.mass.or(request.mass);
            request.stiffness = more.stiffness.or(request.stiffness);
            request.nodes = more.nodes.or(request.nodes);
            return self.look_again(ctx, request);
        }
        if self.document.is_some() && files.iter().all(|file| is_own_record(file)) {
            let files = files.iter().map(|file| file.display().to_string()).collect();
            return self.edit(ctx, &Edit::Do(Command::ImportRuns(files)));
        }
        match Importing::of(ctx, files.to_vec(), self.open_project()) {
            Ok(importing) => self.importing = Some(importing),
            Err(error) => self.fail(error),
        }
    }

    /// What an import must know of the open project.
    fn open_project(&self) -> Option<OpenProject> {
        let document = self.document.as_ref()?;
        Some(OpenProject {
            path: document.session().path().map(Path::to_owned),
            dofs: document.project.structure.dofs().iter().map(|dof| dof.label.clone()).collect(),
            channels: document.session().document().file().channel.clone(),
        })
    }

    fn look_again(&mut self, ctx: &Context, request: Request) {
        match Importing::again(ctx, request, self.open_project()) {
            Ok(importing) => self.importing = Some(importing),
            Err(error) => self.fail(error),
        }
    }

    /// Lays the chosen files of a model under the measurements.
    pub(crate) fn lay_under(&mut self, ctx: &Context, files: Vec<PathBuf>) {
        let Some(Importing::Ready(draft)) = &self.importing else { return };
        let mut request = draft.decided();
        // Whatever their ending, they were chosen as a model.
        let model = Request::of(files);
        let mut others = model.files.into_iter();
        request.mass = model.mass.or_else(|| others.next()).or(request.mass);
        request.stiffness = model.stiffness.or_else(|| others.next()).or(request.stiffness);
        request.nodes = model.nodes.or(request.nodes);
        self.look_again(ctx, request);
    }

    /// Does what was asked for on the page.
    pub(crate) fn act_on_import(&mut self, ctx: &Context, action: ImportAction) {
        match action {
            ImportAction::Cancel => self.importing = None,
            ImportAction::Model => self.pick(ctx, Pick::Model),
            ImportAction::NoModel => {
                let Some(Importing::Ready(draft)) = &self.importing else { return };
                let request = Request { mass: None, stiffness: None, nodes: None, ..draft.request.clone() };
                self.look_again(ctx, request);
            }
            // A new project takes the place of the open one.
            ImportAction::Accept if self.would_lose_changes() => {
                self.fail("The open project has unsaved changes: save it first, then make the new project.".to_owned());
            }
            ImportAction::Accept => {
                let Some(Importing::Ready(draft)) = self.importing.take() else { return };
                match draft.accepted(ctx) {
                    Ok(making) => self.importing = Some(making),
                    Err(error) => self.fail(error),
                }
            }
        }
    }

    /// Whether accepting would close a project with unsaved changes.
    fn would_lose_changes(&self) -> bool {
        let dirty = self.document.as_ref().is_some_and(|document| document.session().is_dirty());
        dirty && matches!(&self.importing, Some(Importing::Ready(draft)) if !draft.into_open())
    }

    /// Waits, at most so long, until files are read or their project is made.
    pub(crate) fn settle_import(&mut self, ctx: &Context, longest: Duration) {
        let start = Instant::now();
        while matches!(self.importing, Some(Importing::Looking(_) | Importing::Making(..))) && start.elapsed() < longest
        {
            self.step_import(ctx);
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    /// Takes over what the work of an import has come to.
    pub(crate) fn step_import(&mut self, ctx: &Context) {
        let Some(importing) = self.importing.take() else { return };
        match importing.step(ctx) {
            Progress::Wait(importing) => self.importing = Some(importing),
            Progress::Failed(error, importing) => {
                self.importing = importing;
                self.fail(error);
            }
            Progress::Made(Made::Project(document, summary)) => {
                self.loaded(*document, false);
                self.say(summary);
            }
            Progress::Made(Made::Tables(tables, summary)) => {
                self.edit(ctx, &Edit::Do(Command::ImportTables(tables)));
                if self.message.as_ref().is_none_or(|message| !message.failed) {
                    self.say(summary);
                }
            }
        }
    }
}

/// Whether a file is a project by its name.
pub(crate) fn is_project(file: &Path) -> bool {
    file.extension().is_some_and(|end| end.eq_ignore_ascii_case("toml"))
}

/// A dropped project is opened, dropped records are appended.
pub(crate) fn dropped(ctx: &Context) -> Vec<Ask> {
    let files: Vec<PathBuf> = ctx.input(|i| i.raw.dropped_files.iter().map(|f| f.path().to_path_buf()).collect());
    let (projects, records): (Vec<PathBuf>, Vec<PathBuf>) = files.into_iter().partition(|f| is_project(f));
    let records = (!records.is_empty()).then_some(Ask::Import(records));
    projects.into_iter().map(Ask::Open).chain(records).collect()
}
