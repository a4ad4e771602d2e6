//! What panes of an identification have in common: its outcome or what is shown in its place, heads of columns.

use crate::exchange::Project;
use crate::identify::Outcome;
use crate::session::validation::has_records;
use crate::window::appearance::theme::space;
use crate::window::appearance::widgets::UiExt;
use crate::window::background::derived::Derived;
use crate::window::document::Document;
use egui::{Align, Layout, Response, Ui};
use std::sync::Arc;

/// Why nothing is identified where no source is open, and what to do.
pub(crate) const NO_CANDIDATES: &str =
    "No source is a candidate: draw some in the stage Pattern, or let the stage Explain say what is missing.";

/// Whether any source is to be identified.
pub(crate) fn has_candidates(p: &Project) -> bool {
    p.sources.iter().any(|s| s.state.is_sought())
}

/// The answer of the identification, or what is shown in its place.
pub(super) fn outcome(ui: &mut Ui, derived: &mut Derived, document: &Document) -> Option<Arc<Outcome>> {
    match derived.outcome(ui.ctx(), document) {
        Some(Ok(outcome)) => return Some(outcome),
        Some(Err(_)) if document.project.runs.iter().all(|r| !r.enabled) && !has_records(&document.project) => {
            ui.empty("No runs to identify from", "Import measurements, or tick the runs that are to be used.");
        }
        Some(Err(_)) if !has_candidates(&document.project) => ui.empty("Nothing is to be identified", NO_CANDIDATES),
        Some(Err(error)) => ui.empty("Nothing was identified", &error),
        None => ui.empty("Identification is running", "Its progress is in the bar below."),
    }
    None
}

/// The same for panes beside the one that says why.
pub(super) fn outcome_quietly(ui: &mut Ui, derived: &mut Derived, document: &Document) -> Option<Arc<Outcome>> {
    let found = derived.outcome(ui.ctx(), document).and_then(Result::ok);
    if found.is_none() {
        ui.empty("Nothing yet", "Shown once sources are identified.");
    }
    found
}

/// The name of a column of numbers.
pub(super) fn head_right(ui: &mut Ui, name: &str) -> Response {
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        ui.add_space(space::XS);
        ui.hint(name)
    })
    .inner
}
