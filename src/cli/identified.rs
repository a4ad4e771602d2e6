//! Takes over what `identify` finds before a model is compared: a project whose damping is still to be found has a model
//! without any, and nothing limits its response at resonance.

use super::named_sources::labels;
use crate::control::Control;
use crate::diagnosis::compare;
use crate::effects::Source;
use crate::exchange::Project;
use crate::identify::identify;
use crate::session::identified;
use crate::session::validation::problem;
use anyhow::Context;
use serde_json::{Value, json};
use std::path::Path;

/// Error of an undamped model, relative, from which on the comparison tells only that its damping is missing.
const MEANINGLESS: f64 = 10.0;
/// Error of a model that predicts no motion at all.
const NO_BETTER: f64 = 1.0;

/// Whether what `identify` finds is to be made known first: where `asked`, or where the model has no damping, candidates for
/// it, and an error that says nothing else.
pub(super) fn is_needed(project: &Project, asked: bool, control: &Control) -> bool {
    asked || is_meaningless(project, control)
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
    let outcome = identify(&project.structure, &project.sources, &project.runs, &project.settings, control)
        .with_context(|| format!("{}: what damps it could not be identified", file.display()))?;
    let taken = identified::take_over(project, &outcome);
    eprintln!("{}", sentence(project, &taken, asked));
    Ok(taken)
}

/// Whether nothing damps the model, something might, and it is at a resonance without it.
fn is_meaningless(project: &Project, control: &Control) -> bool {
    let damps = |s: &Source| s.effect.dissipates();
    let known = problem(project).known().iter().any(damps);
    let sought = project.sources.iter().any(|s| identified::is_sought(s) && damps(s));
    let error = || compare(&problem(project), &[], control).map_or(0.0, |c| c.error);
    // Of frequency responses nothing is looked for but what is in proportion to the motion, as what `identify` finds.
    let linear = project.runs.iter().filter(|run| run.is_used()).all(|run| run.per_unit_force);
    !known && sought && error() > if linear { NO_BETTER } else { MEANINGLESS }
}

fn sentence(project: &Project, taken: &[Source], asked: bool) -> String {
    let place = |s: &Source| {
        let labels = labels(&project.structure, &s.place).join("-");
        if labels.is_empty() { s.effect.to_string() } else { format!("{} at {labels}", s.effect) }
    };
    let names: Vec<String> = taken.iter().map(place).collect();
    let what = if names.is_empty() { "nothing".to_owned() } else { names.join(", ") };
    let why = if asked { "" } else { "the model has no damping yet; " };
    format!("{why}what `identify` finds is taken as known: {what}")
}

/// What was taken over, as in the suggestions.
pub(super) fn document(project: &Project, taken: &[Source]) -> Value {
    let entry = |s: &Source| {
        let names = s.effect.parameters().iter().map(|p| p.name);
        let values: serde_json::Map<String, Value> =
            names.zip(&s.parameters).map(|(name, v)| (name.to_owned(), json!(v))).collect();
        json!({"effect": s.effect.name(), "dofs": labels(&project.structure, &s.place), "parameters": values})
    };
    Value::Array(taken.iter().map(entry).collect())
}
