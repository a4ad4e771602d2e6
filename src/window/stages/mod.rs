//! The stages of the work, one file each; what several share.

pub(crate) mod change;
pub mod explain;
pub(crate) mod identified;
pub(crate) mod incompleteness;
pub(crate) mod measure;
pub(crate) mod methods;
pub(crate) mod parameters;
pub(crate) mod pattern;
pub(crate) mod result;
pub mod run_table;
pub(crate) mod select;
pub(crate) mod status;
pub(crate) mod structure;
pub(crate) mod unsteady;

use super::frame;
use super::frame::panes::Pane;
use super::plots::table as tabled;
use crate::plots::{tables, tables_of_model};
use crate::session::validation::problem;
use crate::window::app::ask::Ask;
use crate::window::app::opened::Opened;
use egui::Ui;

/// Shows a pane.
pub fn show(ui: &mut Ui, pane: Pane, opened: &mut Opened<'_>, asks: &mut Vec<Ask>) {
    let p = &opened.document.project;
    match pane {
        Pane::Schematic => frame::schematic::show(ui, opened, asks),
        Pane::Inspector => frame::inspector::show(ui, opened.document, opened.view, asks),
        Pane::Runs => measure::runs(ui, p, opened.view, asks),
        Pane::Overview => measure::overview(ui, p, opened.view),
        Pane::Record => measure::record(ui, opened),
        Pane::Spectrum => measure::spectrum(ui, opened),
        Pane::Parameters => parameters::show(ui, opened.document, opened.view.dof, asks),
        Pane::Modes => structure::modes(ui, opened),
        Pane::Frequencies => structure::frequencies(ui, opened),
        Pane::ModeShape => structure::shape(ui, opened),
        Pane::Expansion => structure::expansion(ui, opened.document, opened.derived),
        Pane::Laws => pattern::laws(ui, &mut opened.view.law, asks),
        Pane::Sources => pattern::sources(ui, p, opened.view, asks),
        Pane::Steps => select::steps(ui, opened, asks),
        Pane::Set => select::set(ui, opened, asks),
        Pane::Angle => select::angle(ui, opened),
        Pane::RunEnergy => select::energy(ui, opened),
        Pane::Matrix => result::matrix(ui, opened),
        Pane::Energy => result::energy(ui, opened),
        Pane::Damping => result::damping(ui, opened),
        Pane::Bode => result::bode(ui, opened),
        Pane::Nyquist => result::nyquist(ui, opened),
        Pane::Hysteresis => result::hysteresis(ui, opened),
        Pane::Values => result::values(ui, opened),
        Pane::Change => change::show(ui, opened, asks),
        Pane::Methods => methods::show(ui, opened),
        Pane::Incompleteness => {
            incompleteness::show(ui, opened.document, opened.derived, &mut opened.view.incompleteness);
        }
        Pane::ErrorMap => explain::panes::error_map(ui, opened, asks),
        Pane::Cell => explain::panes::cell(ui, opened, asks),
        Pane::Missing => explain::panes::missing(ui, opened, asks),
        Pane::Corrections => explain::corrections::show(ui, opened, asks),
        Pane::Ledger => explain::panes::way(ui, opened, asks),
    }
    if TABLES.contains(&pane)
        && let Some(action) = tabled::offer(ui, ui.max_rect(), pane.title())
    {
        match table(ui, pane, opened) {
            Some(text) => tabled::give(ui.ctx(), pane.title(), action, text),
            None => asks.push(Ask::Refuse(format!("{}: there is no table yet.", pane.title()))),
        }
    }
}

/// Panes that hold a table.
const TABLES: [Pane; 15] = [
    Pane::Parameters,
    Pane::Missing,
    Pane::Corrections,
    Pane::Runs,
    Pane::Modes,
    Pane::Expansion,
    Pane::Sources,
    Pane::Steps,
    Pane::Values,
    Pane::Energy,
    Pane::Damping,
    Pane::Methods,
    Pane::Change,
    Pane::ErrorMap,
    Pane::Ledger,
];

/// What stands in the table of a pane, as text with tabs.
fn table(ui: &Ui, pane: Pane, opened: &mut Opened<'_>) -> Option<String> {
    let document = opened.document;
    match pane {
        Pane::Modes => Some(tables::modes(opened.derived.modes(ui.ctx(), document)?.ok()?.as_ref())),
        Pane::Methods => Some(tables::methods(opened.derived.methods(ui.ctx(), document)?.ok()?.as_ref())),
        Pane::Change => {
            let against = opened.view.against.clone()?;
            Some(tables::change(opened.derived.change(ui.ctx(), document, &against)?.ok()?.as_ref()))
        }
        Pane::ErrorMap => {
            let comparison = opened.derived.explained.comparison(document)?.as_ref().ok()?;
            Some(tables::errors(&document.project, comparison))
        }
        Pane::Parameters => Some(tables_of_model::parameters(document.session().document().file())),
        Pane::Missing => {
            let diagnosis = opened.derived.explained.diagnosis(document)?.as_ref().ok()?;
            Some(tables_of_model::suggestions(&document.project.structure, &diagnosis.suggestions))
        }
        Pane::Corrections => {
            let explained = &opened.derived.explained;
            let diagnosis = explained.diagnosis(document)?.as_ref().ok()?;
            let scatter = explained.scatter(document).and_then(|found| found.as_ref().ok());
            let scatter = scatter.and_then(|found| found.as_ref().as_ref());
            let known = problem(&document.project).known();
            Some(tables_of_model::corrections(&document.project.structure, &known, diagnosis, scatter))
        }
        Pane::Ledger => {
            let ledger = &opened.derived.explained.ledger;
            (!ledger.steps().is_empty()).then(|| ledger.table())
        }
        _ => identified(pane, opened),
    }
}

/// The tables of the project and of what was identified.
fn identified(pane: Pane, opened: &Opened<'_>) -> Option<String> {
    let document = opened.document;
    let p = &document.project;
    let outcome = opened.derived.known_outcome(document).and_then(Result::ok);
    let outcome = outcome.as_deref();
    match pane {
        Pane::Runs => Some(tables::runs(p)),
        Pane::Sources => Some(tables::sources(p)),
        Pane::Steps => Some(tables::steps(p, outcome?)),
        Pane::Values | Pane::Energy => Some(tables::coefficients(p, outcome?)),
        Pane::Damping => Some(tables::damping(outcome?)),
        Pane::Expansion => Some(tables::expansion(p, outcome?)),
        _ => None,
    }
}
