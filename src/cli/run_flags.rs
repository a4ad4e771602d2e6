//! What is wrong with the runs of a project, in words: beside a comparison, and where nothing is left to compare.

use crate::exchange::Project;
use crate::measurement::{Finding, Run, TransientRun};
use crate::session::validation::is_component;
use anyhow::bail;
use serde_json::{Value, json};
use std::path::Path;

/// Most runs whose flags are written out.
const MOST: usize = 12;

/// Findings of a run, each flag once.
fn once(findings: &[Finding]) -> Vec<&Finding> {
    let mut list: Vec<&Finding> = Vec::new();
    for finding in findings {
        if !list.iter().any(|f| f.flag == finding.flag) {
            list.push(finding);
        }
    }
    list
}

/// Name of a flag as files have it.
fn word(finding: &Finding) -> String {
    serde_json::to_value(finding.flag).ok().and_then(|v| v.as_str().map(str::to_owned)).unwrap_or_default()
}

/// Flags of a run, each once.
pub(super) fn flags(run: &Run) -> Vec<Value> {
    once(&run.findings).into_iter().map(|finding| json!(finding.flag)).collect()
}

/// Findings with their reasons, each flag once.
pub(super) fn findings(findings: &[Finding]) -> Vec<Value> {
    once(findings).into_iter().map(|finding| json!({"flag": finding.flag, "reason": finding.reason})).collect()
}

/// Records that are not steady, each with what is wrong with it and why it is not used, if it is not.
pub(super) fn records(project: &Project) -> Vec<Value> {
    let record = |run: &TransientRun| {
        json!({"file": run.file, "kind": run.kind.name(), "used": why_not(project, run).is_none(),
               "why_not_used": why_not(project, run), "findings": findings(&run.findings)})
    };
    project.transient_runs.iter().map(record).collect()
}

/// Why a record takes no part in a comparison.
fn why_not(project: &Project, run: &TransientRun) -> Option<&'static str> {
    if !run.enabled {
        return Some("it is switched off (`use = false`)");
    }
    let predicts = project.structure.matrices().is_some() || is_component(project);
    (!predicts).then_some("records in time need the masses and stiffnesses of the structure, which has none")
}

/// Lines of the records that are not steady.
fn of_records(project: &Project) -> String {
    let mut lines = String::new();
    for run in &project.transient_runs {
        if let Some(why) = why_not(project, run) {
            lines.push_str(&format!("{}: not used: {why}\n", run.file));
        }
        for finding in once(&run.findings) {
            lines.push_str(&format!("{}: {}: {}\n", run.file, word(finding), finding.reason));
        }
    }
    lines
}

/// A line a flag, with what becomes of the run.
pub(super) fn text(project: &Project) -> String {
    let flagged: Vec<&Run> = project.runs.iter().filter(|run| run.enabled && !run.findings.is_empty()).collect();
    let mut lines = String::new();
    for run in flagged.iter().take(MOST) {
        let left_out = if run.is_used() { "" } else { "left out, " };
        for finding in once(&run.findings) {
            lines.push_str(&format!("{}: {left_out}{}: {}\n", run.file, word(finding), finding.reason));
        }
    }
    if flagged.len() > MOST {
        lines.push_str(&format!("and {} more runs with flags\n", flagged.len() - MOST));
    }
    lines.push_str(&of_records(project));
    if lines.is_empty() { lines } else { format!("\nflags\n{lines}") }
}

/// Fails where no run that is wanted is of a steady motion, and where others need a model that is not there.
///
/// # Errors
/// One line with the reason of the first such run, and how to use it all the same.
pub(super) fn check(project: &Project, file: &Path) -> anyhow::Result<()> {
    let unsteady = project.transient_runs.len();
    if project.runs.is_empty() && unsteady > 0 && project.structure.matrices().is_none() {
        let (all, are) =
            if unsteady == 1 { ("its run", "is no steady state") } else { ("all runs", "are no steady states") };
        bail!(
            "{}: {all} {are}, and decays and transients need mass and stiffness: write a [structure] of kind \"beam\", \"chain\" or \
             \"matrices\" in place of points",
            file.display()
        );
    }
    let wanted: Vec<&Run> = project.runs.iter().filter(|run| run.enabled).collect();
    if wanted.is_empty() || wanted.iter().any(|run| run.is_used()) {
        return Ok(());
    }
    let first = wanted[0];
    let reason = first.why_not_steady().map_or_else(String::new, |finding| finding.reason.clone());
    let others = if wanted.len() > 1 { format!(", and {} others likewise", wanted.len() - 1) } else { String::new() };
    bail!(
        "{}: no run can be compared: {}: {reason}{others}; `use = true` at its [[run]] uses one all the same",
        file.display(),
        first.file
    )
}
