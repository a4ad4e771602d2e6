//! Runs that do not fit the others in `dashpot diagnose`, in words and as JSON.

use super::table::number;
use crate::diagnosis::run_fault::{Misreading, RunFault};
use crate::measurement::Run;
use serde_json::{Value, json};

/// A run that was left out in the JSON document.
pub(super) fn document(fault: &RunFault, runs: &[Run]) -> Value {
    let (kind, channel, factor) = match &fault.misreading {
        Some(Misreading::Motions(factor)) => ("motions", None, Some(factor)),
        Some(Misreading::Channel(channel, factor)) => ("channel", Some(channel), Some(factor)),
        None => ("different", None, None),
    };
    json!({
        "fault": kind,
        "run": fault.run,
        "file": runs.get(fault.run).map(|run| &run.file),
        "channel": channel,
        "factor": factor,
        "words": fault.words(runs),
        "error_before": fault.error_before,
        "error_after": fault.error_after,
    })
}

/// The runs that were left out in sentences.
pub(super) fn text(faults: &[RunFault], runs: &[Run]) -> String {
    let Some(first) = faults.first() else { return String::new() };
    let [before, after] = [first.error_before, first.error_after].map(|error| number(100.0 * error));
    let which = if faults.len() > 1 { "them" } else { "it" };
    let lines: String = faults.iter().map(|fault| format!("  {}\n", fault.words(runs))).collect();
    format!(
        "\nruns first; all that follows is without {which}\n{lines}    what is found leaves {before} % with all runs, {after} % without\n"
    )
}
