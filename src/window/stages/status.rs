//! Where each stage stands, and why in one line.

use crate::display::words;
use crate::identify::SelectionStatus;
use crate::session::validation::has_records;
use crate::window::app::App;
use crate::window::app::view::Stage;
use crate::window::frame::top::StageStatus;
use crate::window::stages;
use crate::window::stages::identified::{NO_CANDIDATES, has_candidates};

impl App {
    /// Where the stage stands, for its tab: whether it needs attention and why, in one line.
    pub fn status(&self, stage: Stage) -> StageStatus {
        let Some(document) = &self.document else { return StageStatus::empty("No project is open.") };
        let p = &document.project;
        match stage {
            Stage::Measure if p.runs.is_empty() && !p.transient_runs.is_empty() => {
                let used = p.transient_runs.iter().filter(|r| r.enabled).count();
                StageStatus::done(&format!("{} over time.", words::counted(used, "record")))
            }
            Stage::Measure if p.runs.is_empty() => StageStatus::empty("No runs: import measurements."),
            Stage::Measure => {
                let flagged = p.runs.iter().filter(|r| r.enabled && !r.findings.is_empty()).count();
                let used = p.runs.iter().filter(|r| r.enabled).count();
                if flagged > 0 {
                    StageStatus::attention(&format!("Flagged: {flagged} of {used} used runs."))
                } else {
                    StageStatus::done(&format!("{used} runs are used, none is flagged."))
                }
            }
            Stage::Structure if p.structure.matrices().is_none() => {
                StageStatus::done("Points: energy balance only, no model.")
            }
            Stage::Structure if p.structure.len() == 1 => StageStatus::done("1 degree of freedom."),
            Stage::Structure => StageStatus::done(&format!("{} degrees of freedom.", p.structure.len())),
            Stage::Pattern => {
                let open = p.sources.iter().filter(|s| s.state.is_sought()).count();
                if open == 0 {
                    StageStatus::empty("No candidates: click on the schematic or add a family.")
                } else {
                    StageStatus::done(&format!("{open} candidates."))
                }
            }
            Stage::Explain => stages::explain::status(document, &self.derived.explained),
            Stage::Select | Stage::Result => match self.derived.known_outcome(document) {
                None => StageStatus::empty("Identification has not ended yet."),
                Some(Err(_)) if p.runs.iter().all(|r| !r.enabled) && !has_records(p) => {
                    StageStatus::empty("There are no runs to identify from.")
                }
                // Nothing is wrong with a model all of whose sources are known.
                Some(Err(_)) if !has_candidates(p) => StageStatus::empty(NO_CANDIDATES),
                Some(Err(error)) => StageStatus::attention(&error),
                Some(Ok(outcome)) => {
                    let text = format!(
                        "{}: {}.",
                        words::counted(outcome.accepted_step().count, "source"),
                        stages::select::status(outcome.status)
                    );
                    let good = matches!(outcome.status, SelectionStatus::WithinNoise | SelectionStatus::BelowAngle);
                    if good { StageStatus::done(&text) } else { StageStatus::attention(&text) }
                }
            },
        }
    }
}
