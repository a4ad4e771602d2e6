//! What a report holds, each part computed or with the reason why not.

use super::request::Request;
use crate::control::Control;
use crate::diagnosis::candidates::fingerprint_plot::{self as prints, Print};
use crate::diagnosis::candidates::restoring_force::RestoringForce;
use crate::diagnosis::records::RecordComparison;
use crate::diagnosis::result::{Suggestion, Verdict};
use crate::diagnosis::{self, Comparison, Diagnosis};
use crate::effects::Source;
use crate::exchange::Project;
use crate::identify::Outcome;
use crate::session::identified::{lacks_damping, take_over};
use crate::session::time_limit::answer_within;
use crate::session::validation::{
    compared_with_records, diagnosed, diagnosed_from_records, missing_force, only_records, problem,
};
use std::sync::Arc;

/// A result, or one line that says why there is none.
pub(super) type Found<T> = Result<Arc<T>, String>;

/// One model that was looked at on the way to the present one.
#[derive(Debug, Clone, PartialEq)]
pub struct LedgerRow {
    /// What was changed.
    pub label: String,
    /// Error of the model, a share.
    pub error: f64,
    /// What it would be were the model exact, a share.
    pub noise_floor: f64,
}

/// What is known before a report is written; what is `None` is computed for it.
#[derive(Debug, Clone, Default)]
pub struct Known {
    /// Identified sources.
    pub outcome: Option<Found<Outcome>>,
    /// Model against measurement.
    pub comparison: Option<Found<Comparison>>,
    /// What the model lacks.
    pub diagnosis: Option<Found<Diagnosis>>,
    /// The way to the model as it stands.
    pub ledger: Vec<LedgerRow>,
}

/// All that a report is made of.
#[derive(Debug)]
pub struct Content<'a> {
    /// The project.
    pub project: &'a Project,
    /// Identified sources.
    pub outcome: Found<Outcome>,
    /// The project with what was identified known, and that, where the model lacks its damping altogether: it is this that
    /// is compared.
    pub with_identified: Option<(Project, Vec<Source>)>,
    /// Model against measurement.
    pub comparison: Found<Comparison>,
    /// Model against records that are not steady, where there are any.
    pub records: Option<Found<RecordComparison>>,
    /// What the model lacks; `None` where it was not asked for.
    pub diagnosis: Option<Found<Diagnosis>>,
    /// Fingerprints of the first suggestions.
    pub fingerprints: Vec<(Source, Print)>,
    /// The missing force at the places of the first suggestions; without one, at the place that explains most.
    pub forces: Vec<(Option<Source>, RestoringForce)>,
    /// The way to the model as it stands.
    pub ledger: Vec<LedgerRow>,
}

/// Error beyond which a model lacks its damping altogether, and no search for a missing effect says anything.
const HOPELESS: f64 = 10.0;
/// Least probability of a suggestion that is told in full; the table has the others.
const TOLD_IN_FULL: f64 = 0.01;
/// Suggestions whose fingerprint is drawn.
const MOST_PRINTS: usize = 2;

impl<'a> Content<'a> {
    /// Computes what is not known.
    pub fn complete(project: &'a Project, known: Known, request: &Request, control: &Control) -> Self {
        let p = project;
        let outcome =
            known.outcome.unwrap_or_else(|| p.identify(&[], control).map(Arc::new).map_err(|e| e.to_string()));
        let compared =
            |p: &Project| diagnosis::compare(&problem(p), &[], control).map(Arc::new).map_err(|e| e.to_string());
        let as_it_is = known.comparison.unwrap_or_else(|| compared(p));
        let found = outcome.as_ref().ok().filter(|_| as_it_is.is_ok() && lacks_damping(p, control));
        let with_identified = found.and_then(|o| with_identified(p, o));
        let (p, comparison, told) = match &with_identified {
            Some((p, _)) => (p, compared(p), None),
            None => (p, as_it_is, known.diagnosis.filter(|_| !only_records(p))),
        };
        let search = || searched(p, &comparison, request, control);
        let diagnosis = request.needs_search().then(|| told.unwrap_or_else(search));
        let records = compared_with_records(p, control).map_err(|e| e.to_string()).map(|r| r.map(Arc::new)).transpose();
        let found = diagnosis.as_ref().and_then(|d| d.as_ref().ok());
        let fingerprints = found.map_or_else(Vec::new, |d| fingerprints(p, d, control));
        let forces = found.map_or_else(Vec::new, |d| forces(p, d, control));
        let mut ledger = known.ledger;
        let error = comparison.as_ref().map(|c| [c.error, c.noise_floor]);
        let of_records = || records.as_ref().and_then(|r| r.as_ref().ok()).map(|r| [r.error, r.noise_floor]);
        if let (true, Some([error, noise_floor])) = (ledger.is_empty(), error.ok().or_else(of_records)) {
            let label = if with_identified.is_some() { "Model with what was identified" } else { "Model as it stands" };
            let label = label.to_owned();
            ledger.push(LedgerRow { label, error, noise_floor });
        }
        Self { project, outcome, with_identified, comparison, records, diagnosis, fingerprints, forces, ledger }
    }

    /// The project whose known sources are compared with the measurement.
    pub fn compared(&self) -> &Project {
        self.with_identified.as_ref().map_or(self.project, |(p, _)| p)
    }
}

/// The project with what was identified known; `None` where nothing was.
fn with_identified(p: &Project, outcome: &Outcome) -> Option<(Project, Vec<Source>)> {
    let mut project = p.clone();
    let taken = take_over(&mut project, outcome);
    (!taken.is_empty()).then_some((project, taken))
}

/// What the model lacks, found within the time that was asked for.
fn searched(p: &Project, comparison: &Found<Comparison>, request: &Request, control: &Control) -> Found<Diagnosis> {
    let limited = request.limit.map(|limit| {
        // The rest of the report takes the time that it needs.
        let search = control.unhurried();
        answer_within(&search, p, limit);
        search
    });
    let control = limited.as_ref().unwrap_or(control);
    if only_records(p) {
        return diagnosed_from_records(p, control, &|_| {}).map(Arc::new).map_err(|e| e.to_string());
    }
    diagnose(p, comparison, control)
}

/// What is compared of a project.
fn diagnose(p: &Project, comparison: &Found<Comparison>, control: &Control) -> Found<Diagnosis> {
    let found = comparison.as_ref().map_err(Clone::clone)?;
    if found.error > HOPELESS {
        let why = "The model takes hardly any energy out at these frequencies; give it the damping that is known or \
                   take over what was identified, then its errors say something.";
        return Err(why.to_owned());
    }
    diagnosed(p, control, &|_| {}).map(Arc::new).map_err(|e| e.to_string())
}

/// Suggestions that are not next to impossible.
pub(super) fn told_in_full(diagnosis: &Diagnosis) -> impl Iterator<Item = &Suggestion> {
    diagnosis.suggestions.iter().filter(|s| s.probability >= TOLD_IN_FULL)
}

fn fingerprints(p: &Project, diagnosis: &Diagnosis, control: &Control) -> Vec<(Source, Print)> {
    let last = diagnosis.steps.last();
    let found: Vec<Source> = last.map_or_else(Vec::new, |s| s.added.iter().map(|a| a.source.clone()).collect());
    let fingerprint_of = |source: &Source| {
        let print = prints::print(&problem(p), &found, &diagnosis.corrections, source, control).ok()??;
        Some((source.clone(), print))
    };
    told_in_full(diagnosis).take(MOST_PRINTS).filter_map(|s| fingerprint_of(&s.added.source)).collect()
}

/// The missing force of the first suggestions; of the best place where nothing was named though something is missing.
fn forces(p: &Project, diagnosis: &Diagnosis, control: &Control) -> Vec<(Option<Source>, RestoringForce)> {
    let suggested = told_in_full(diagnosis).take(MOST_PRINTS).map(|s| Some(s.added.source.clone()));
    let mut wanted: Vec<Option<Source>> = suggested.collect();
    if wanted.is_empty() && diagnosis.verdict == Verdict::Unexplained {
        wanted.push(None);
    }
    let force_of = |source: Option<Source>| {
        let force = missing_force(p, diagnosis, source.as_ref(), control).ok()??;
        Some((source, force))
    };
    wanted.into_iter().filter_map(force_of).collect()
}
