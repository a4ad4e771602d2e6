//! Takes over what `identify` finds before a model is compared: a project whose damping is still to be found has a model
//! without any, and nothing limits its response at resonance.

use super::source_json;
use super::table::number;
use crate::control::Control;
use crate::diagnosis::compare;
use crate::diagnosis::result::{Diagnosis, Verdict};
use crate::effects::Source;
use crate::exchange::Project;
use crate::identify::{SelectionStatus, identify};
use crate::session::identified;
use crate::session::validation::{only_records, problem};
use anyhow::Context;
use serde_json::{Value, json};
use std::path::Path;

/// Probability from which on a suggestion names what `identify` found; below, it is as good as excluded.
const NAMED: f64 = 0.01;

/// Whether what `identify` finds is to be made known first: where `asked`, or where the model has no damping, candidates for
/// it, and a resonance whose width it lacks.
pub(super) fn is_needed(project: &Project, asked: bool, control: &Control) -> bool {
    asked || identified::lacks_damping(project, control)
}

/// Makes what `identify` finds known in `project`, where that is needed. Gives what was taken over.
///
/// # Errors
/// What keeps the project from being identified.
pub(super) fn take_over(
    project: &mut Project,
    asked: bool,
    file: &Path,
    control: &Control,
) -> anyhow::Result<Vec<Source>> {
    if !is_needed(project, asked, control) {
        return Ok(Vec::new());
    }
    identify_known(project, asked, file, control)
}

/// Makes what `identify` finds known in `project`. Gives what was taken over.
///
/// # Errors
/// What keeps the project from being identified.
pub(super) fn identify_known(
    project: &mut Project,
    asked: bool,
    file: &Path,
    control: &Control,
) -> anyhow::Result<Vec<Source>> {
    let outcome = project.identify(&[], control).with_context(|| {
        let channels = "no channel looks reversed, exchanged, misread or elsewhere";
        format!("{}: what damps it could not be identified, and {channels}", file.display())
    })?;
    let taken = identified::take_over(project, &outcome);
    eprintln!("{}", sentence(project, &taken, asked));
    Ok(taken)
}

/// What `identify` finds among the candidates of a project, where it explains the runs at least as well as the first suggestion
/// of a search that did not take it as known: several sources of the law that a project asks for then are as likely as one of
/// another law, which fewer parameters speak for.
pub(super) struct Alternative {
    sources: Vec<Source>,
    /// Error of the model with them, relative.
    error: f64,
    /// Error that the first suggestion leaves.
    suggested: f64,
}

impl Alternative {
    /// The alternative to a diagnosis that names a missing effect; none where `identify` does not reach the noise or explains less.
    pub(super) fn of(project: &Project, diagnosis: &Diagnosis, control: &Control) -> Option<Self> {
        let suggested = diagnosis.suggestions.first()?.error_after;
        if !matches!(diagnosis.verdict, Verdict::Missing | Verdict::Undecided) || only_records(project) {
            return None;
        }
        let mut project = project.clone();
        let outcome = identify(&project.structure, &project.sources, &project.runs, &project.settings, control).ok()?;
        let sources = identified::take_over(&mut project, &outcome);
        let error = compare(&problem(&project), &[], control).ok()?.error;
        let named = |source: &Source| {
            diagnosis.suggestions.iter().any(|s| s.probability > NAMED && s.added.source.is_same(source))
        };
        let is_as_good =
            outcome.status == SelectionStatus::WithinNoise && error <= suggested && !sources.iter().any(named);
        is_as_good.then_some(Self { sources, error, suggested })
    }

    pub(super) fn document(&self, project: &Project) -> Value {
        json!({"sources": document(project, &self.sources), "error": self.error})
    }

    pub(super) fn words(&self, project: &Project) -> String {
        let [error, suggested] = [self.error, self.suggested].map(|x| number(100.0 * x));
        format!(
            "\n`identify` finds {} among the candidates of the project: error {error} %, after the first suggestion {suggested} %; \
             --identified takes it as known before anything is looked for\n",
            names(project, &self.sources)
        )
    }
}

/// Sources with their places, in words.
fn names(project: &Project, sources: &[Source]) -> String {
    let names: Vec<String> = sources.iter().map(|source| source.phrase(&project.structure)).collect();
    if names.is_empty() { "nothing".to_owned() } else { names.join(", ") }
}

fn sentence(project: &Project, taken: &[Source], asked: bool) -> String {
    let what = names(project, taken);
    let why = if asked { "" } else { "the model has no damping yet; " };
    format!("{why}what `identify` finds is taken as known: {what}")
}

/// What was taken over, as in the suggestions.
pub(super) fn document(project: &Project, taken: &[Source]) -> Value {
    let entry = |s: &Source| {
        let mut map = source_json::of_effect(s, &project.structure);
        map.insert("parameters".into(), source_json::parameters(s));
        Value::Object(map)
    };
    Value::Array(taken.iter().map(entry).collect())
}
