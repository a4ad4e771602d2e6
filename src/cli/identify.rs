//! `dashpot identify`: from a project to its sources, as a table or as one JSON document.

use super::arguments::Identify;
use super::identify_json::document;
use super::identify_table::report;
use crate::classical::FrequencyResponses;
use crate::classical::measured_ratios::{circle_ratios, half_power_ratios};
use crate::control::Control;
use crate::exchange::Project;
use crate::exchange::project::load;
use crate::exchange::ratios::read_ratios;
use crate::identify::{Measurements, Outcome, identify_measured};
use crate::measurement::proposal::propose;
use crate::measurement::{Kind, MeasuredRatio};
use crate::session::workers::Threads;
use anyhow::Context;
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Arc;

pub(super) fn run(arguments: &Identify) -> anyhow::Result<String> {
    let (project, outcome) = identified(&arguments.file, arguments.ratios.as_deref())?;
    for warning in &outcome.warnings {
        eprintln!("warning: {warning}");
    }
    if arguments.json {
        return Ok(format!("{:#}\n", document(&project, &outcome)));
    }
    Ok(report(&project, &outcome))
}

/// Loads and identifies a project, with damping ratios if they are asked for.
pub(super) fn identified(file: &Path, ratios: Option<&Path>) -> anyhow::Result<(Project, Outcome)> {
    let control = Control::unattended().with_workers(Arc::new(Threads));
    let project = load(file, &control)?;
    say_other_kinds(&project);
    super::remarks::tell_remarks(&project);
    super::reduction::warn(&project.structure);
    let ratios = ratios.map_or_else(|| Ok(Vec::new()), |choice| measured(&project, choice))?;
    for r in &ratios {
        let [value, deviation] = [r.ratio, r.deviation].map(|v| 100.0 * v);
        eprintln!("damping ratio at {:.4} Hz: {value:.4} % +- {deviation:.4} %", r.omega / TAU);
    }
    let (structure, sources) = (&project.structure, &project.sources);
    let measured = Measurements { runs: &project.runs, transient_runs: &project.transient_runs, ratios: &ratios };
    let outcome = identify_measured(structure, sources, measured, &project.settings, &control)
        .with_context(|| file.display().to_string())?;
    Ok((project, outcome))
}

/// Steady runs whose records look like something else, in words.
fn say_other_kinds(project: &Project) {
    for run in &project.runs {
        let Some(record) = &run.record else { continue };
        let proposal = propose(record);
        if proposal.kind != Kind::Steady {
            let (file, kind) = (&run.file, proposal.kind.name());
            eprintln!("warning: {file} is taken as steady but looks like kind = \"{kind}\": {}", proposal.reason);
        }
    }
}

fn measured(project: &Project, choice: &Path) -> anyhow::Result<Vec<MeasuredRatio>> {
    let by = match choice.to_str() {
        Some("half-power") => half_power_ratios,
        Some("circle-fit") => circle_ratios,
        _ => return Ok(read_ratios(choice)?),
    };
    let responses = FrequencyResponses::from_runs(&project.runs).context("no run has exactly one exciter")?;
    let found = by(&project.structure.modes()?, &responses);
    anyhow::ensure!(
        !found.is_empty(),
        "no resonance has three runs within its half-power band: measure more frequencies, or give the ratios in a file"
    );
    Ok(found)
}
