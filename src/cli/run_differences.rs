//! What of an answer's error is no noise and nothing that is missing: how the steady runs differ from each other.

use crate::control::Control;
use crate::diagnosis::result::Diagnosis;
use crate::diagnosis::updating::scatter::of_diagnosis;
use crate::display::run_differences;
use crate::exchange::Project;
use crate::session::validation::{only_records, problem};

/// Noise floors from which on what is left is looked into.
const BEYOND: f64 = 3.0;

/// Sentences on the runs beside the last step; none where it leaves noise, or where channels were mended, for then the records are others.
pub(super) fn sentences(project: &Project, diagnosis: &Diagnosis, control: &Control) -> Vec<String> {
    let left = diagnosis.steps.last().map_or(0.0, |step| step.error);
    let is_noise = left < BEYOND * diagnosis.noise_floor;
    if is_noise || only_records(project) || !diagnosis.channel_faults.is_empty() {
        return Vec::new();
    }
    let scatter = of_diagnosis(&problem(project), diagnosis, control).ok().flatten();
    scatter.map_or_else(Vec::new, |scatter| run_differences::sentences(&scatter))
}

/// The same as lines of the table.
pub(super) fn text(sentences: &[String]) -> String {
    let lines: String = sentences.iter().map(|sentence| format!("  {sentence}\n")).collect();
    if lines.is_empty() { lines } else { format!("\nruns\n{lines}") }
}
