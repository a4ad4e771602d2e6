//! Files on their way into a project, read and made in the background.

use super::draft::{Draft, OpenProject};
use crate::control::Control;
use crate::exchange::atomic::write_atomically;
use crate::exchange::importing::{Request, import};
use crate::session::jobs::Job;
use crate::window::app::repaint::request_repaint;
use crate::window::background::cache::Background;
use crate::window::document::Document;
use egui::Context;
use std::path::{Path, PathBuf};

/// What came of files that were accepted.
#[derive(Debug)]
pub enum Made {
    /// A project that was written and opened, and what was assumed.
    Project(Box<Document>, String),
    /// Tables for the open project, and what was assumed.
    Tables(String, String),
}

/// Files on their way into a project.
#[derive(Debug)]
pub enum Importing {
    /// They are being read.
    Looking(Job<(), Result<Draft, String>>),
    /// They are shown and wait for a decision.
    Ready(Box<Draft>),
    /// The project is being made; the draft comes back where it cannot be.
    Making(Box<Draft>, Job<(), Result<Made, String>>),
}

/// What a look at the work gives.
#[derive(Debug)]
pub enum Progress {
    /// Nothing new.
    Wait(Importing),
    /// The files cannot be read, or no project can be made of them: why, and what is still shown.
    Failed(String, Option<Importing>),
    /// It is done.
    Made(Made),
}

impl Importing {
    /// Begins to read `paths`, files and folders.
    ///
    /// # Errors
    /// One line, where no job can be started.
    pub fn of(ctx: &Context, paths: Vec<PathBuf>, open: Option<OpenProject>) -> Result<Self, String> {
        Self::look(ctx, move |_| Draft::of(&paths, open))
    }

    /// Reads the files of a draft anew, by what was changed of its request.
    ///
    /// # Errors
    /// One line, where no job can be started.
    pub fn again(ctx: &Context, request: Request, open: Option<OpenProject>) -> Result<Self, String> {
        Self::look(ctx, move |_| Draft::by(request, open))
    }

    fn look(
        ctx: &Context,
        work: impl FnOnce(&Control) -> Result<Draft, String> + Send + 'static,
    ) -> Result<Self, String> {
        Job::start("Reading measurements", (), request_repaint(ctx), work).map(Self::Looking).map_err(|e| e.to_string())
    }

    /// Goes on where work has ended; a draft that fits the mapping of the open project is accepted at once.
    pub fn step(self, ctx: &Context) -> Progress {
        match self {
            Self::Looking(job) => match job.poll() {
                None => Progress::Wait(Self::Looking(job)),
                Some(Err(error)) => Progress::Failed(error.to_string(), None),
                Some(Ok(Err(error))) => Progress::Failed(error, None),
                Some(Ok(Ok(draft))) if draft.fits => match draft.accepted(ctx) {
                    Ok(making) => Progress::Wait(making),
                    Err(error) => Progress::Failed(error, None),
                },
                Some(Ok(Ok(draft))) => Progress::Wait(Self::Ready(Box::new(draft))),
            },
            Self::Making(draft, job) => match job.poll() {
                None => Progress::Wait(Self::Making(draft, job)),
                Some(Err(error)) => Progress::Failed(error.to_string(), Some(Self::Ready(draft))),
                Some(Ok(Err(error))) => Progress::Failed(error, Some(Self::Ready(draft))),
                Some(Ok(Ok(made))) => Progress::Made(made),
            },
            ready @ Self::Ready(_) => Progress::Wait(ready),
        }
    }

    /// Name and progress of what runs.
    pub fn running(&self) -> Option<(&str, f64)> {
        match self {
            Self::Looking(job) => job.running(),
            Self::Making(_, job) => job.running(),
            Self::Ready(draft) => draft.preview.running(),
        }
    }

    /// Gives up what runs; what is shown stays.
    pub fn cancelled(self) -> Option<Self> {
        match self {
            Self::Looking(_) => None,
            Self::Making(draft, _) | Self::Ready(draft) => Some(Self::Ready(draft)),
        }
    }
}

impl Draft {
    /// Starts to make the project, or the tables of the open one, as they are decided.
    ///
    /// # Errors
    /// One line, where no job can be started.
    pub fn accepted(self, ctx: &Context) -> Result<Importing, String> {
        let (request, target) = (self.decided(), self.destination());
        let into = self.into_open();
        let job = Job::start("Importing", (), request_repaint(ctx), move |control: &Control| {
            make(&request, &target, into, control)
        });
        job.map(|job| Importing::Making(Box::new(self), job)).map_err(|e| e.to_string())
    }
}

/// Makes what was decided: the text is that of `dashpot import`.
fn make(request: &Request, target: &Path, into: bool, control: &Control) -> Result<Made, String> {
    let imported = import(request, target, control).map_err(|e| e.to_string())?;
    let summary = imported.summary.trim_end().to_owned();
    if into {
        return Ok(Made::Tables(imported.tables, summary));
    }
    if target.exists() {
        return Err(format!("{}: is there already; give the project another name", target.display()));
    }
    write_atomically(target, imported.text().as_bytes()).map_err(|error| {
        format!("{}: the project cannot be written: {error}; choose another folder", target.display())
    })?;
    let (document, _) = Document::open(target, control)?;
    Ok(Made::Project(Box::new(document), summary))
}
