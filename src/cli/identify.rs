//! `dashpot identify`: from a project to its sources, as a table or as one JSON document.

use super::arguments::Identify;
use super::identify_json::document;
use super::identify_table::report;
use super::run_flags;
use super::table::{number, significant, with_deviation};
use crate::classical::FrequencyResponses;
use crate::classical::measured_ratios::{circle_ratios, half_power_ratios};
use crate::classical::poly_reference::extract;
use crate::control::Control;
use crate::exchange::Project;
use crate::exchange::project::load;
use crate::exchange::ratios::read_ratios;
use crate::identify::{IdentifyError, Outcome};
use crate::measurement::proposal::propose;
use crate::measurement::{Kind, MeasuredRatio};
use crate::session::validation::{compared_with_records, only_records};
use crate::session::workers::Threads;
use anyhow::Context;
use serde_json::json;
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Arc;

/// Error over the noise floor up to which a model agrees with its records.
const AGREES: f64 = 1.1;

pub(super) fn run(arguments: &Identify) -> anyhow::Result<String> {
    let (project, outcome) = match identified(&arguments.file, arguments.ratios.as_deref()) {
        Ok(found) => found,
        Err(error) => return nothing_fits(arguments, error),
    };
    for warning in &outcome.warnings {
        eprintln!("warning: {warning}");
    }
    if arguments.json {
        return Ok(format!("{:#}\n", document(&project, &outcome)));
    }
    Ok(report(&project, &outcome))
}

/// Where no set of sources fits: the answer that nothing is missing, if the model predicts the records as it is; else the error, after
/// what is wrong with the records.
fn nothing_fits(arguments: &Identify, error: anyhow::Error) -> anyhow::Result<String> {
    if !matches!(error.downcast_ref(), Some(IdentifyError::NothingFits)) {
        return Err(error);
    }
    let control = Control::unattended().with_workers(Arc::new(Threads));
    let project = load(&arguments.file, &control)?;
    let found = if only_records(&project) { compared_with_records(&project, &control)? } else { None };
    let Some(found) = found.filter(|found| found.error <= AGREES * found.noise_floor) else {
        for run in &project.transient_runs {
            run.findings.iter().for_each(|finding| eprintln!("warning: {}: {}", run.file, finding.reason));
        }
        return Err(error);
    };
    if arguments.json {
        let document = json!({"title": project.title, "nothing_missing": true, "error": found.error,
            "noise_floor": found.noise_floor, "sources": [], "record_findings": run_flags::records(&project)});
        return Ok(format!("{document:#}\n"));
    }
    let [left, floor] = [found.error, found.noise_floor].map(|x| number(100.0 * x));
    let words = format!(
        "Nothing is missing: the model as it is predicts the records to {left} %, their noise floor is {floor} %. No candidate takes energy."
    );
    Ok(format!("{}\n\n{words}\n{}", project.title, run_flags::text(&project)))
}

/// Loads and identifies a project, with damping ratios if they are asked for.
pub(super) fn identified(file: &Path, ratios: Option<&Path>) -> anyhow::Result<(Project, Outcome)> {
    let control = Control::unattended().with_workers(Arc::new(Threads));
    let project = load(file, &control)?;
    say_other_kinds(&project);
    super::remarks::tell_remarks(&project);
    super::reduction::warn(&project.structure);
    let ratios = ratios.map_or_else(|| Ok(Vec::new()), |choice| measured(&project, choice, &control))?;
    for r in &ratios {
        let [value, deviation] = [r.ratio, r.deviation].map(|v| 100.0 * v);
        eprintln!("damping ratio at {} Hz: {} %", significant(r.omega / TAU, 6), with_deviation(value, deviation));
    }
    let outcome = project.identify(&ratios, &control).with_context(|| file.display().to_string())?;
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

fn measured(project: &Project, choice: &Path, control: &Control) -> anyhow::Result<Vec<MeasuredRatio>> {
    let by = match choice.to_str() {
        Some("half-power") => half_power_ratios,
        Some("circle-fit") => circle_ratios,
        _ => return Ok(read_ratios(choice)?),
    };
    let responses = FrequencyResponses::from_runs(&project.runs).context("no run has exactly one exciter")?;
    // Where lines are too few for modes the peaks are looked at as they are.
    let modes = extract(&responses, control).map_or_else(|_| Vec::new(), |extraction| extraction.modes);
    let found = by(&project.structure.modes()?, &responses, &modes);
    anyhow::ensure!(
        !found.is_empty(),
        "no resonance has three runs within its half-power band: measure more frequencies, or give the ratios in a file"
    );
    Ok(found)
}
