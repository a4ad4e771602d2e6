//! Where each stage stands, and why in one line.

use super::app::App;
use super::frame::top::Mark;
use super::stages;
use super::view::Stage;
use crate::display::words;
use crate::effects::State;
use crate::identify::Status;
use crate::session::validation::has_records;

impl App {
    /// State of the stage for its mark: whether it needs attention and why, in one line.
    pub fn mark(&self, stage: Stage) -> Mark {
        let Some(document) = &self.document else { return Mark::empty("No project is open.") };
        let p = &document.project;
        match stage {
            Stage::Measure if p.runs.is_empty() && !p.transient_runs.is_empty() => {
                let used = p.transient_runs.iter().filter(|r| r.enabled).count();
                Mark::done(&format!("{} not steady: decays, transients.", words::counted(used, "record")))
            }
            Stage::Measure if p.runs.is_empty() => Mark::empty("No runs: import measurements."),
            Stage::Measure => {
                let flagged = p.runs.iter().filter(|r| r.enabled && !r.findings.is_empty()).count();
                let used = p.runs.iter().filter(|r| r.enabled).count();
                if flagged > 0 {
                    Mark::attention(&format!("{flagged} of {used} used runs are flagged."))
                } else {
                    Mark::done(&format!("{used} runs are used, none is flagged."))
                }
            }
            Stage::Structure if p.structure.matrices().is_none() => {
                Mark::done("Points: energy balance only, no model.")
            }
            Stage::Structure => Mark::done(&format!("{} degrees of freedom.", p.structure.len())),
            Stage::Pattern => {
                let open = p.sources.iter().filter(|s| matches!(s.state, State::Candidate | State::Forced)).count();
                if open == 0 {
                    Mark::empty("No candidates: click on the schematic or add a family.")
                } else {
                    Mark::done(&format!("{open} candidates."))
                }
            }
            Stage::Explain => stages::explain::mark(document, &self.derived.explained),
            Stage::Select | Stage::Result => match self.derived.known_outcome(document) {
                None => Mark::empty("Identification has not ended yet."),
                Some(Err(_)) if p.runs.iter().all(|r| !r.enabled) && !has_records(p) => {
                    Mark::empty("There are no runs to identify from.")
                }
                Some(Err(error)) => Mark::attention(error),
                Some(Ok(outcome)) => {
                    let text = format!(
                        "{}: {}.",
                        words::counted(outcome.accepted_step().count, "source"),
                        stages::select::status(outcome.status)
                    );
                    let good = matches!(outcome.status, Status::WithinNoise | Status::BelowAngle);
                    if good { Mark::done(&text) } else { Mark::attention(&text) }
                }
            },
        }
    }
}
