//! `dashpot identify`: from a project to its sources, as a table or as one JSON document.

use super::arguments::Identify;
use super::identify_json::document;
use super::identify_table::report;
use crate::control::Control;
use crate::exchange::Project;
use crate::exchange::project::load;
use crate::identify::{Outcome, identify};
use anyhow::Context;
use std::path::Path;

pub(super) fn run(arguments: &Identify) -> anyhow::Result<String> {
    let (project, outcome) = identified(&arguments.file)?;
    for warning in &outcome.warnings {
        eprintln!("warning: {warning}");
    }
    if arguments.json {
        return Ok(format!("{:#}\n", document(&project, &outcome)));
    }
    Ok(report(&project, &outcome))
}

/// Loads and identifies a project.
pub(super) fn identified(file: &Path) -> anyhow::Result<(Project, Outcome)> {
    let control = Control::unattended();
    let project = load(file, &control)?;
    let outcome = identify(&project.structure, &project.sources, &project.runs, &project.settings, &control)
        .with_context(|| file.display().to_string())?;
    Ok((project, outcome))
}
