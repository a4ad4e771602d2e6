//! The stages of the work, one file each; what several share.

pub mod change;
pub mod explain;
mod identified;
pub mod incompleteness;
pub mod measure;
pub mod methods;
pub mod parameters;
pub mod pattern;
pub mod result;
pub mod run_table;
pub mod select;
pub mod structure;
pub mod unsteady;

use super::app::{App, Ask};
use super::frame;
use super::frame::panes::Pane;
use super::plots::table as tabled;
use crate::plots::tables;
use egui::Ui;

/// Shows a pane.
pub fn show(ui: &mut Ui, pane: Pane, app: &mut App, asks: &mut Vec<Ask>) {
    match pane {
        Pane::Schematic => frame::schematic::show(ui, app, asks),
        Pane::Inspector => frame::inspector::show(ui, app, asks),
        Pane::Runs => measure::runs(ui, app, asks),
        Pane::Overview => measure::overview(ui, app),
        Pane::Record => measure::record(ui, app),
        Pane::Spectrum => measure::spectrum(ui, app),
        Pane::Parameters => parameters::show(ui, app, asks),
        Pane::Modes => structure::modes(ui, app),
        Pane::Frequencies => structure::frequencies(ui, app),
        Pane::ModeShape => structure::shape(ui, app),
        Pane::Expansion => structure::expansion(ui, app),
        Pane::Laws => pattern::laws(ui, app, asks),
        Pane::Sources => pattern::sources(ui, app, asks),
        Pane::Steps => select::steps(ui, app, asks),
        Pane::Set => select::set(ui, app, asks),
        Pane::Angle => select::angle(ui, app),
        Pane::RunEnergy => select::energy(ui, app),
        Pane::Matrix => result::matrix(ui, app),
        Pane::Energy => result::energy(ui, app),
        Pane::Damping => result::damping(ui, app),
        Pane::Bode => result::bode(ui, app),
        Pane::Nyquist => result::nyquist(ui, app),
        Pane::Hysteresis => result::hysteresis(ui, app),
        Pane::Values => result::values(ui, app),
        Pane::Change => change::show(ui, app, asks),
        Pane::Methods => methods::show(ui, app),
        Pane::Incompleteness => incompleteness::show(ui, app),
        Pane::ErrorMap => explain::panes::error_map(ui, app, asks),
        Pane::Cell => explain::panes::cell(ui, app, asks),
        Pane::Missing => explain::panes::missing(ui, app, asks),
        Pane::Corrections => explain::corrections::show(ui, app, asks),
        Pane::Ledger => explain::panes::way(ui, app, asks),
    }
    if TABLES.contains(&pane)
        && app.document.is_some()
        && let Some(wish) = tabled::offer(ui, ui.max_rect(), pane.title())
    {
        match table(ui, pane, app) {
            Some(text) => tabled::give(ui.ctx(), pane.title(), wish, text),
            None => app.fail(format!("{}: there is no table yet.", pane.title())),
        }
    }
}

/// Panes that hold a table.
const TABLES: [Pane; 12] = [
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
fn table(ui: &Ui, pane: Pane, app: &mut App) -> Option<String> {
    let document = app.document.as_ref()?;
    match pane {
        Pane::Modes => Some(tables::modes(app.derived.modes(ui.ctx(), document)?.ok()?.as_ref())),
        Pane::Methods => Some(tables::methods(app.derived.methods(ui.ctx(), document)?.ok()?.as_ref())),
        Pane::Change => {
            let against = app.view.against.clone()?;
            Some(tables::change(app.derived.change(ui.ctx(), document, &against)?.ok()?.as_ref()))
        }
        Pane::ErrorMap => {
            let comparison = app.derived.explained.comparison(document)?.as_ref().ok()?;
            Some(tables::errors(&document.project, comparison))
        }
        Pane::Ledger => {
            let ledger = &app.derived.explained.ledger;
            (!ledger.steps().is_empty()).then(|| ledger.table())
        }
        _ => identified(pane, app),
    }
}

/// The tables of the project and of what was identified.
fn identified(pane: Pane, app: &App) -> Option<String> {
    let document = app.document.as_ref()?;
    let p = &document.project;
    let outcome = app.derived.known_outcome(document).and_then(|o| o.as_ref().ok());
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
