//! What is computed from the document, each remembering the revision it was computed from.

use super::document::Document;
use super::explained::Explained;
use super::forward;
use super::plots::bode::Response;
use super::plots::hysteresis::Loop;
use super::plots::pyramid::Pyramid;
use super::schematic::Scene;
use super::view::View;
use crate::identify::{self, Outcome};
use crate::math::spectrum::Spectrum;
use crate::measurement::Quantity;
use crate::session::Revisions;
use crate::session::jobs::{Job, JobError};
use crate::structure::modes::Modes;
use std::collections::HashMap;
use std::sync::Arc;

/// One channel of a record, ready to be drawn.
#[derive(Debug)]
pub struct Trace {
    /// Record minus fit, at every sample.
    pub residual: Arc<Pyramid>,
    /// The record.
    pub record: Arc<Pyramid>,
    /// Its spectrum; `None` where it is too short.
    pub spectrum: Option<Spectrum>,
}

/// Displacement of every DOF in a run; empty where it cannot be expanded.
pub type Motion = Vec<faer::c64>;

/// Revision, response DOF, excited DOF.
type Asked = (u64, usize, usize);

/// Everything derived.
#[derive(Debug, Default)]
pub struct Derived {
    scene: Option<(u64, Arc<Scene>)>,
    modes: Option<Result<Arc<Modes>, String>>,
    modes_job: Option<Job<u64, Result<Modes, String>>>,
    outcome: Option<(u64, Result<Arc<Outcome>, String>)>,
    outcome_job: Option<Job<u64, Result<Outcome, String>>>,
    response: Option<(Asked, Result<Arc<Response>, String>)>,
    response_job: Option<Job<Asked, Result<Response, String>>>,
    motions: Option<(u64, Result<Arc<Vec<Motion>>, String>)>,
    motions_job: Option<Job<u64, Result<Vec<Motion>, String>>>,
    seen: Revisions,
    loops: Option<((u64, usize), Result<Vec<Loop>, String>)>,
    traces: HashMap<(usize, usize), Arc<Trace>>,
    /// Of the stage Explain.
    pub explained: Explained,
}

impl Derived {
    /// Forgets what no longer belongs to the document as it stands.
    pub fn keep_up(&mut self, document: &Document) {
        let now = document.session().revisions();
        if self.seen.structure != now.structure {
            (self.modes, self.modes_job) = (None, None);
        }
        if self.seen.structure != now.structure || self.seen.measurements != now.measurements {
            self.traces.clear();
        }
        self.seen = now;
    }

    /// Gives up what is being computed; it starts again with the next change.
    pub fn cancel(&mut self, document: &Document) {
        const WHY: &str = "It was cancelled; the next change computes it again.";
        self.explained.cancel();
        if self.outcome_job.take().is_some() {
            self.outcome = Some((document.revision(), Err(WHY.to_owned())));
        }
        if let Some(job) = self.response_job.take() {
            self.response = Some((*job.key(), Err(WHY.to_owned())));
        }
        if self.modes_job.take().is_some() {
            self.modes = Some(Err(WHY.to_owned()));
        }
        if self.motions_job.take().is_some() {
            self.motions = Some((document.revision(), Err(WHY.to_owned())));
        }
    }

    /// The motion of every DOF in every run at its fundamental, m or rad: measured where it is, expanded where it is not.
    pub fn motions(&mut self, ctx: &egui::Context, document: &Document) -> Option<Result<Arc<Vec<Motion>>, String>> {
        let outcome = self.known_outcome(document)?.as_ref().ok().map(Arc::clone);
        let revision = document.revision();
        if let Some((done, motions)) = &self.motions
            && *done == revision
        {
            return Some(motions.clone());
        }
        if self.motions_job.as_ref().is_none_or(|job| *job.key() != revision) {
            let p = document.project.clone();
            let work = move |_: &crate::control::Control| forward::motions(&p, outcome.as_deref());
            match Job::start("Expanding the runs", revision, wake(ctx), work) {
                Ok(job) => self.motions_job = Some(job),
                Err(error) => self.motions = Some((revision, Err(error.to_string()))),
            }
        }
        let result = self.motions_job.as_ref().and_then(Job::poll)?;
        self.motions_job = None;
        self.motions = Some((revision, joined(result)));
        self.motions.as_ref().map(|(_, motions)| motions.clone())
    }

    /// The scene of the schematic.
    pub fn scene(&mut self, document: &Document) -> Arc<Scene> {
        if let Some((revision, scene)) = &self.scene
            && *revision == document.revision()
        {
            return Arc::clone(scene);
        }
        let p = &document.project;
        let scene = Arc::new(Scene::new(&p.structure, &p.sources, &p.runs));
        self.scene = Some((document.revision(), Arc::clone(&scene)));
        scene
    }

    /// Undamped modes, computed in the background.
    pub fn modes(&mut self, ctx: &egui::Context, document: &Document) -> Option<Result<Arc<Modes>, String>> {
        if self.modes.is_none() && self.modes_job.is_none() {
            let structure = document.project.structure.clone();
            let work = move |_: &crate::control::Control| structure.modes().map_err(|e| e.to_string());
            match Job::start("Modes", document.revision(), wake(ctx), work) {
                Ok(job) => self.modes_job = Some(job),
                Err(error) => self.modes = Some(Err(error.to_string())),
            }
        }
        if let Some(result) = self.modes_job.as_ref().and_then(Job::poll) {
            self.modes = Some(joined(result));
            self.modes_job = None;
        }
        self.modes.clone()
    }

    /// Name and progress of the job that runs, if one does.
    pub fn running(&self) -> Option<(&str, f64)> {
        let outcome = self.outcome_job.as_ref().map(|j| (j.name(), j.progress()));
        let modes = self.modes_job.as_ref().map(|j| (j.name(), j.progress()));
        let response = self.response_job.as_ref().map(|j| (j.name(), j.progress()));
        let motions = self.motions_job.as_ref().map(|j| (j.name(), j.progress()));
        outcome.or(modes).or(response).or(motions).or_else(|| self.explained.running())
    }

    /// A channel of a run, by its index in the fit; `None` where the run has no record of it.
    pub fn trace(&mut self, document: &Document, run: usize, channel: usize) -> Option<Arc<Trace>> {
        if let Some(trace) = self.traces.get(&(run, channel)) {
            return Some(Arc::clone(trace));
        }
        let r = document.project.runs.get(run)?;
        let (record, fit) = (r.record.as_ref()?, r.fit.channels.get(channel)?);
        let row = record.channels().iter().position(|c| *c == fit.channel)?;
        let (time, samples) = (record.time(), record.samples(row));
        let middle = 0.5 * (time.first()? + time.last()?);
        let residual: Vec<f64> = time
            .iter()
            .zip(samples)
            .map(|(&t, y)| y - super::plots::record::fitted(fit, r.fit.omega, middle, t))
            .collect();
        let step = (time.last()? - time.first()?) / (time.len().max(2) - 1) as f64;
        let trace = Arc::new(Trace {
            residual: Arc::new(Pyramid::new(time, &residual)),
            record: Arc::new(Pyramid::new(time, samples)),
            spectrum: Spectrum::new(samples, step),
        });
        self.traces.insert((run, channel), Arc::clone(&trace));
        Some(trace)
    }

    /// The answer of the identification for the document as it stands; `None` while it is computed.
    pub fn outcome(&mut self, ctx: &egui::Context, document: &Document) -> Option<Result<Arc<Outcome>, String>> {
        if let Some((revision, outcome)) = &self.outcome
            && *revision == document.revision()
        {
            return Some(outcome.clone());
        }
        if self.outcome_job.as_ref().is_none_or(|j| *j.key() != document.revision()) {
            let p = document.project.clone();
            let work = move |control: &crate::control::Control| {
                identify::identify(&p.structure, &p.sources, &p.runs, &p.settings, control).map_err(|e| e.to_string())
            };
            match Job::start("Identifying", document.revision(), wake(ctx), work) {
                Ok(job) => self.outcome_job = Some(job),
                Err(error) => self.outcome = Some((document.revision(), Err(error.to_string()))),
            }
        }
        let result = self.outcome_job.as_ref().and_then(Job::poll)?;
        self.outcome_job = None;
        self.outcome = Some((document.revision(), joined(result)));
        self.outcome.as_ref().map(|(_, outcome)| outcome.clone())
    }

    /// The answer, if it is there and fresh; starts nothing.
    pub fn known_outcome(&self, document: &Document) -> Option<&Result<Arc<Outcome>, String>> {
        self.outcome.as_ref().filter(|(revision, _)| *revision == document.revision()).map(|(_, outcome)| outcome)
    }

    /// Receptance of the identified model between the selected DOF (else the first sensor) and the exciter.
    pub fn response(
        &mut self,
        ctx: &egui::Context,
        document: &Document,
        view: &View,
    ) -> Option<Result<Arc<Response>, String>> {
        let outcome = match self.known_outcome(document)? {
            Ok(outcome) => Arc::clone(outcome),
            Err(error) => return Some(Err(error.clone())),
        };
        let p = &document.project;
        let channels = || p.runs.iter().flat_map(|r| &r.fit.channels).map(|c| &c.channel);
        let excitation = channels().find(|c| c.quantity == Quantity::Force).map(|c| c.dof);
        let sensor = channels().filter(|c| c.quantity != Quantity::Force).map(|c| c.dof).next_back();
        let (Some(excitation), Some(sensor)) = (excitation, sensor) else {
            return Some(Err("No run has a force and a motion.".to_owned()));
        };
        let asked = (document.revision(), view.dof.unwrap_or(sensor), excitation);
        if let Some((done, response)) = &self.response
            && *done == asked
        {
            return Some(response.clone());
        }
        if self.response_job.as_ref().is_none_or(|job| *job.key() != asked) {
            let (structure, sources) = (p.structure.clone(), forward::acting(p, &outcome));
            let omega = forward::frequencies(p, &outcome);
            let work = move |control: &crate::control::Control| {
                forward::receptance(&structure, &sources, omega, [asked.1, asked.2], control)
            };
            match Job::start("Frequency response", asked, wake(ctx), work) {
                Ok(job) => self.response_job = Some(job),
                Err(error) => self.response = Some((asked, Err(error.to_string()))),
            }
        }
        let result = self.response_job.as_ref().and_then(Job::poll)?;
        self.response_job = None;
        self.response = Some((asked, joined(result)));
        self.response.as_ref().map(|(_, response)| response.clone())
    }

    /// Hysteresis loops of a run from the identified model's steady state.
    pub fn loops(&mut self, document: &Document, run: usize) -> Result<&[Loop], String> {
        let key = (document.revision(), run);
        if self.loops.as_ref().is_none_or(|(done, _)| *done != key) {
            let outcome = match self.known_outcome(document) {
                Some(Ok(outcome)) => Arc::clone(outcome),
                Some(Err(error)) => return Err(error.clone()),
                None => return Err("Identification is running.".to_owned()),
            };
            self.loops = Some((key, forward::run_loops(&document.project, &outcome, run)));
        }
        match &self.loops {
            Some((_, Ok(loops))) => Ok(loops),
            Some((_, Err(error))) => Err(error.clone()),
            None => Err(String::new()),
        }
    }
}

/// Asks for a frame once a job has ended.
fn wake(ctx: &egui::Context) -> impl FnOnce() + Send + 'static {
    let ctx = ctx.clone();
    move || ctx.request_repaint()
}

/// The two ways in which a job can fail, as one.
fn joined<T>(result: Result<Result<T, String>, JobError>) -> Result<Arc<T>, String> {
    result.map_err(|e| e.to_string())?.map(Arc::new)
}
