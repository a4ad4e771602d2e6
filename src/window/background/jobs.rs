//! What runs in the background on behalf of the window: reading, fitting, asking for files, exporting. Nothing of it may
//! hold up a frame.

use crate::control::Control;
use crate::session::jobs::{Job, JobError};
use crate::window::app::repaint::request_repaint;
use crate::window::document::{Document, Ready, Waiting};
use crate::window::files::{self, Pick};
use egui::Context;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// How a piece of work ended.
#[derive(Debug)]
pub(crate) enum Done {
    /// A project was read; whether unsaved changes of a crash were recovered.
    Loaded(Result<(Box<Document>, bool), String>),
    /// The records that a change waited for were read.
    Changed(Result<Box<Ready>, String>),
    /// Files were chosen, or none; with the name that was proposed and how long the dialog was open.
    Picked(Pick, String, Vec<PathBuf>, Duration),
    /// Something that ends with a sentence.
    Said(Result<String, String>),
}

/// All that runs.
#[derive(Debug, Default)]
pub(crate) struct Jobs {
    running: Vec<Job<(), Done>>,
}

impl Jobs {
    fn start(
        &mut self,
        ctx: &Context,
        name: &str,
        work: impl FnOnce(&Control) -> Done + Send + 'static,
    ) -> Result<(), String> {
        let job = Job::start(name, (), request_repaint(ctx), work).map_err(|e| e.to_string())?;
        self.running.push(job);
        Ok(())
    }

    /// Reads a project; one that is being read is given up.
    ///
    /// # Errors
    /// One line, where no thread can be started.
    pub(crate) fn load(&mut self, ctx: &Context, file: PathBuf) -> Result<(), String> {
        let name = file.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        self.running.retain(|job| !job.name().starts_with("Reading"));
        self.start(ctx, &format!("Reading {name}"), move |control| {
            Done::Loaded(Document::open(&file, control).map(|(document, recovered)| (Box::new(document), recovered)))
        })
    }

    /// Reads the records that a change waits for.
    ///
    /// # Errors
    /// One line, where no thread can be started.
    pub(crate) fn change(&mut self, ctx: &Context, waiting: Waiting) -> Result<(), String> {
        self.start(ctx, "Reading and fitting records", move |control| {
            Done::Changed(waiting.read(control).map(Box::new))
        })
    }

    /// Asks for files in the desktop's own dialog.
    ///
    /// # Errors
    /// One line, where no thread can be started.
    pub(crate) fn pick(&mut self, ctx: &Context, pick: Pick, name: String) -> Result<(), String> {
        if self.is_asking() {
            return Ok(());
        }
        let asked = files::ask(pick, &name);
        self.start(ctx, files::ASKING, move |_| {
            let begin = Instant::now();
            let paths = pollster::block_on(asked);
            Done::Picked(pick, name, paths, begin.elapsed())
        })
    }

    /// Whether a dialog of the desktop is open.
    pub(crate) fn is_asking(&self) -> bool {
        self.running.iter().any(|job| job.name() == files::ASKING)
    }

    /// Runs something that ends with a sentence.
    ///
    /// # Errors
    /// One line, where no thread can be started.
    pub(crate) fn say(
        &mut self,
        ctx: &Context,
        name: &str,
        work: impl FnOnce(&Control) -> Result<String, String> + Send + 'static,
    ) -> Result<(), String> {
        self.start(ctx, name, move |control| Done::Said(work(control)))
    }

    /// What has ended since the last look; work that broke down as its message.
    pub(crate) fn poll(&mut self) -> Vec<Result<Done, JobError>> {
        let mut ended = Vec::new();
        self.running.retain(|job| match job.poll() {
            Some(result) => {
                ended.push(result);
                false
            }
            None => true,
        });
        ended
    }

    /// Waits for everything that runs, each at most so long; for pictures and tests.
    pub(crate) fn wait(&mut self, longest: Duration) -> Vec<Result<Done, JobError>> {
        self.running.drain(..).filter_map(|job| job.wait(longest)).collect()
    }

    /// Name and progress of what runs; a file dialog is no work.
    pub(crate) fn running(&self) -> Option<(&str, f64)> {
        self.running.iter().find(|job| job.name() != files::ASKING).map(|job| (job.name(), job.progress()))
    }

    /// Gives up all that runs.
    pub(crate) fn cancel(&mut self) {
        self.running.clear();
    }
}
