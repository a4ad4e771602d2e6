//! What is wrong with the runs of a project, in words: beside a comparison, and where nothing is left to compare.

use crate::exchange::Project;
use crate::measurement::{Finding, Run};
use anyhow::bail;
use serde_json::{Value, json};
use std::path::Path;

/// Most runs whose flags are written out.
const MOST: usize = 12;

/// Findings of a run, each flag once.
fn once(run: &Run) -> Vec<&Finding> {
    let mut list: Vec<&Finding> = Vec::new();
    for finding in &run.findings {
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
    once(run).into_iter().map(|finding| json!(finding.flag)).collect()
}

/// The same with their reasons.
pub(super) fn findings(run: &Run) -> Vec<Value> {
    once(run).into_iter().map(|finding| json!({"flag": finding.flag, "reason": finding.reason})).collect()
}

/// A line a flag, with what becomes of the run.
pub(super) fn text(project: &Project) -> String {
    let flagged: Vec<&Run> = project.runs.iter().filter(|run| run.enabled && !run.findings.is_empty()).collect();
    let mut lines = String::new();
    for run in flagged.iter().take(MOST) {
        let left_out = if run.is_used() { "" } else { "left out, " };
        for finding in once(run) {
            lines.push_str(&format!("{}: {left_out}{}: {}\n", run.file, word(finding), finding.reason));
        }
    }
    if flagged.len() > MOST {
        lines.push_str(&format!("and {} more runs with flags\n", flagged.len() - MOST));
    }
    if lines.is_empty() { lines } else { format!("\nflags\n{lines}") }
}

/// Fails where no run that is wanted is of a steady motion.
///
/// # Errors
/// One line with the reason of the first such run, and how to use it all the same.
pub(super) fn check(project: &Project, file: &Path) -> anyhow::Result<()> {
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
