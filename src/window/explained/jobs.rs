//! The work behind the stage, one job each: pure functions of a project.

use super::first_suggestions::Mailbox;
use super::model::Search;
use crate::control::Control;
use crate::diagnosis::candidates::fingerprint_plot::{self as prints, Print};
use crate::diagnosis::candidates::restoring_force::RestoringForce;
use crate::diagnosis::records::compare::OneRecord;
use crate::diagnosis::result::Suggestion;
use crate::diagnosis::updating::scatter::{self, Scatter};
use crate::diagnosis::{self, Comparison, Diagnosis};
use crate::effects::Source;
use crate::exchange::Project;
use crate::plots::record_residual::RecordResidual;
use crate::plots::response_curve::{self, Curve};
use crate::session::time_limit::answer_within;
use crate::session::validation::{as_runs, compared_with_effects, diagnosed, missing_force, only_records, problem};
use std::sync::Arc;
use std::time::Duration;

/// The search for what is missing; it ends after `limit` with the best so far.
pub(super) fn search_job(
    p: &Arc<Project>,
    search: &Search,
    limit: Option<Duration>,
    told: Mailbox,
) -> impl FnOnce(&Control) -> Result<Diagnosis, String> + use<> {
    let (p, search) = (Arc::clone(p), search.clone());
    move |control| {
        if let Some(limit) = limit {
            answer_within(control, &p, limit);
        }
        let early = |found: &[Suggestion]| told.put(found);
        let p = Project { ruled_out: search.ruled_out().to_vec(), ..Project::clone(&p) };
        diagnosed(&p, control, &early).map_err(|e| e.to_string())
    }
}

/// The comparison, with an effect on trial.
pub(super) fn compare_job(
    p: &Arc<Project>,
    trial: Option<&Source>,
) -> impl FnOnce(&Control) -> Result<Comparison, String> + use<> {
    let (p, effects) = (Arc::clone(p), trial.cloned().into_iter().collect::<Vec<_>>());
    move |control| {
        if only_records(&p) {
            let found = compared_with_effects(&p, &effects, control).map_err(|e| e.to_string())?;
            let found = found.ok_or("records are compared with a model of mass and stiffness; points have none")?;
            return Ok(as_runs(&p, &found));
        }
        diagnosis::compare(&problem(&p), &effects, control).map_err(|e| e.to_string())
    }
}

/// Records that are not steady with the model's beside them, with an effect on trial.
pub(super) fn decay_job(
    p: &Arc<Project>,
    trial: Option<&Source>,
) -> impl FnOnce(&Control) -> Result<Vec<OneRecord>, String> + use<> {
    let (p, effects) = (Arc::clone(p), trial.cloned().into_iter().collect::<Vec<_>>());
    move |control| {
        let found = compared_with_effects(&p, &effects, control).map_err(|e| e.to_string())?;
        Ok(found.map_or_else(Vec::new, |found| found.records))
    }
}

/// One channel of a record that is not steady with the model's: the one of that name, else the one of greatest error.
pub(super) fn record_job(
    p: &Arc<Project>,
    found: Arc<Vec<OneRecord>>,
    index: usize,
    channel: Option<String>,
) -> impl FnOnce(&Control) -> Result<RecordResidual, String> + use<> {
    let p = Arc::clone(p);
    move |_| {
        let asked = |r: &&OneRecord| r.index == index;
        let record = found.iter().find(asked).zip(p.transient_runs.get(index));
        let (record, run) = record.ok_or("The record is switched off.")?;
        let residual = |name: Option<&str>| RecordResidual::new(&p.structure, run, record, name);
        let residual = residual(channel.as_deref()).or_else(|| residual(None));
        residual.ok_or_else(|| "No motion is measured in it.".to_owned())
    }
}

/// The fingerprint of a suggestion beside the other effects that were found.
pub(super) fn print_job(
    p: &Arc<Project>,
    diagnosis: Option<Arc<Diagnosis>>,
    source: &Source,
) -> impl FnOnce(&Control) -> Result<Option<Print>, String> + use<> {
    let (p, source) = (Arc::clone(p), source.clone());
    move |control| {
        let steps = diagnosis.as_ref().and_then(|d| d.steps.last());
        let found: Vec<Source> = steps.map_or_else(Vec::new, |s| s.added.iter().map(|a| a.source.clone()).collect());
        let corrections = diagnosis.as_ref().map_or(&[][..], |d| &d.corrections);
        prints::print(&problem(&p), &found, corrections, &source, control).map_err(|e| e.to_string())
    }
}

/// The missing force at the place of a suggestion beside the other effects that were found.
pub(super) fn force_job(
    p: &Arc<Project>,
    diagnosis: Arc<Diagnosis>,
    source: Option<Source>,
) -> impl FnOnce(&Control) -> Result<Option<RestoringForce>, String> + use<> {
    let p = Arc::clone(p);
    move |control| missing_force(&p, &diagnosis, source.as_ref(), control).map_err(|e| e.to_string())
}

/// What the data say of channels and runs beside what a search found.
pub(super) fn scatter_job(
    p: &Arc<Project>,
    diagnosis: Arc<Diagnosis>,
) -> impl FnOnce(&Control) -> Result<Option<Scatter>, String> + use<> {
    let p = Arc::clone(p);
    move |control| scatter::of_diagnosis(&problem(&p), &diagnosis, control).map_err(|e| e.to_string())
}

/// Response curves near a run, with an effect on trial.
pub(super) fn curve_job(
    p: &Arc<Project>,
    trial: Option<&Source>,
    run: usize,
) -> impl FnOnce(&Control) -> Result<Vec<Curve>, String> + use<> {
    let (p, effects) = (Arc::clone(p), trial.cloned().into_iter().collect::<Vec<_>>());
    move |control| response_curve::curves(&p, &effects, run, control)
}
