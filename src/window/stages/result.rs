//! Result: the damping matrix, energy shares, damping ratios, frequency responses, hysteresis.

use super::identified;
use crate::display::{format, units, words};
use crate::exchange::Project;
use crate::identify::Outcome;
use crate::plots::bars::Bar;
use crate::plots::bode::Diagram;
use crate::plots::{heatmap, tables};
use crate::response::frequency_response::ResponseForm;
use crate::window::app::opened::Opened;
use crate::window::appearance::theme::{self, size, space};
use crate::window::appearance::widgets::{UiExt, width};
use crate::window::language::{t, tr};
use crate::window::plots::{bars, hysteresis, table as tabled};
use crate::window::solid;
use egui::{Align, Layout, ScrollArea, Ui};
use egui_extras::{Column, TableBuilder};
use std::sync::Arc;

/// Width of the column of shares in the table of values, points.
const SHARE: f32 = 64.0;
/// Largest width of bars and coefficients, and width of the column of deviations, points.
const WIDEST: f32 = 900.0;
const DEVIATION: f32 = 62.0;

/// The answer, or what is shown in its place.
fn ready(ui: &mut Ui, opened: &mut Opened<'_>) -> Option<Arc<Outcome>> {
    let document = opened.document;
    identified::outcome(ui, opened.derived, document)
}

/// The damping matrix as a heat map or as bars in space.
pub(crate) fn matrix(ui: &mut Ui, opened: &mut Opened<'_>) {
    let document = opened.document;
    let Some(outcome) = identified::outcome_quietly(ui, opened.derived, document) else { return };
    let (mut whole, mut in_space) = (opened.view.whole_matrix, opened.view.matrix_in_space);
    heat(ui, &document.project, &outcome, &mut whole, &mut in_space);
    (opened.view.whole_matrix, opened.view.matrix_in_space) = (whole, in_space);
}

/// Shares of the energy by source and by DOF.
pub(crate) fn energy(ui: &mut Ui, opened: &mut Opened<'_>) {
    let Some(outcome) = ready(ui, opened) else { return };
    let document = opened.document;
    shares(ui, &document.project, &outcome);
}

/// Damping ratios beside half-power values.
pub(crate) fn damping(ui: &mut Ui, opened: &mut Opened<'_>) {
    let Some(outcome) = ready(ui, opened) else { return };
    ratios(ui, &outcome);
}

/// Magnitude and phase over frequency.
pub(crate) fn bode(ui: &mut Ui, opened: &mut Opened<'_>) {
    response(ui, opened, |diagram, ui, _| diagram.bode(ui));
}

/// Imaginary over real part near the selected run.
pub(crate) fn nyquist(ui: &mut Ui, opened: &mut Opened<'_>) {
    response(ui, opened, |diagram, ui, run| {
        diagram.nyquist(ui, run);
    });
}

fn heat(ui: &mut Ui, p: &Project, outcome: &Outcome, whole: &mut bool, in_space: &mut bool) {
    let results = &outcome.results;
    let linear = results.others.is_empty();
    let (matrix, name) = if linear {
        (&results.viscous, "identified, viscous")
    } else {
        (&results.equivalent_viscous, "energy-equivalent viscous")
    };
    let (factor, unit) = units::shown("N s/m");
    let matrix = &(faer::Scale(factor) * matrix);
    let pretty = format::pretty_unit(&unit);
    let remark = format!("{pretty}, {name}");
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.checkbox(whole, t!("All DOFs"));
            for (shown, name) in [(true, "3-D"), (false, "Map")] {
                if ui.selectable_label(*in_space == shown, tr(name)).clicked() {
                    *in_space = shown;
                }
            }
            // Beside the switches where there is room, else the unit alone.
            let fits = width(ui, &remark, theme::font(size::SMALL)) + space::S <= ui.available_width();
            let shown = if fits { remark.as_str() } else { pretty.as_str() };
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.hint(shown).on_hover_text(tr(&remark));
            });
        });
    });
    let occupied = heatmap::occupied(matrix);
    let rows: Vec<usize> = if *whole { (0..matrix.nrows()).collect() } else { occupied };
    if rows.is_empty() {
        ui.empty("No damping was identified", "Add candidates in the pattern.");
        return;
    }
    let labels: Vec<String> = p.structure.dofs().iter().map(|d| d.label.clone()).collect();
    ui.add_space(space::XS);
    let map = heatmap::HeatMap { matrix, rows: &rows, columns: &rows, labels: &labels, unit: &unit, scale: None };
    if *in_space {
        solid::bars::Bars::new(&map).show(ui, "Damping matrix in space", &map);
    } else {
        map.show(ui, "Damping matrix");
    }
}

fn quantities(ui: &mut Ui, chosen: &mut ResponseForm) {
    for (quantity, name) in [
        (ResponseForm::Receptance, "Receptance"),
        (ResponseForm::Mobility, "Mobility"),
        (ResponseForm::Accelerance, "Accelerance"),
    ] {
        if ui.selectable_label(*chosen == quantity, tr(name)).clicked() {
            *chosen = quantity;
        }
    }
}

fn shares(ui: &mut Ui, p: &Project, outcome: &Outcome) {
    let palette = ui.palette();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        // On a wide screen figures stay near their names.
        ui.set_max_width(ui.available_width().min(WIDEST));
        ui.title("By source", "share of the energy over all used runs");
        let bar = |estimate: &crate::identify::Estimate| {
            let source = p.sources.get(estimate.source)?;
            let known = source.state == crate::effects::State::Known;
            Some(Bar {
                name: format!("{} {}", source.effect.noun(), source.place.short_cell(&p.structure)),
                share: 0.01 * estimate.energy_percent,
                colour: if known { palette.weak } else { palette.model },
            })
        };
        let mut largest_first: Vec<&crate::identify::Estimate> = outcome.sources.iter().collect();
        largest_first.sort_by(|a, b| b.energy_percent.total_cmp(&a.energy_percent));
        let by_source: Vec<Bar> = largest_first.iter().filter_map(|e| bar(e)).collect();
        bars::show(ui, "Energy by source", &by_source, 190.0);
        let by_dof: Vec<Bar> = outcome
            .results
            .energy_percent
            .iter()
            .enumerate()
            .filter(|(_, percent)| percent.abs() > 1e-9)
            .map(|(d, percent)| Bar {
                name: format!("DOF {}", p.structure.label(d)),
                share: 0.01 * percent,
                colour: palette.model,
            })
            .collect();
        if !by_dof.is_empty() {
            ui.add_space(space::M);
            ui.title("By degree of freedom", "where it is lost; adds up to 100 %");
            bars::show(ui, "Energy by degree of freedom", &by_dof, 190.0);
        }
        ui.add_space(space::M);
        ui.title("Coefficients", "with one standard deviation");
        for estimate in largest_first {
            let Some(source) = p.sources.get(estimate.source) else { continue };
            let place = source.place.cell(&p.structure);
            ui.pair(&format!("{} {place}", source.effect.noun()), words::coefficient(source, estimate));
        }
        for warning in &outcome.warnings {
            ui.add_space(space::XS);
            ui.colored_label(palette.warning, tr(warning));
        }
    });
}

fn ratios(ui: &mut Ui, outcome: &Outcome) {
    if outcome.results.modes.is_empty() {
        ui.empty("No modes", "Damping ratios need mass and stiffness.");
        return;
    }
    ui.style_mut().interaction.selectable_labels = false;
    let measure = units::now().damping;
    let [name_of_measure, unit] = measure.words();
    let said = |value: f64, digits| format!("{} {unit}", format::significant(value, digits)).trim_end().to_owned();
    TableBuilder::new(ui)
        .id_salt("damping")
        .striped(true)
        .cell_layout(Layout::left_to_right(Align::Center))
        .column(Column::exact(34.0))
        .column(Column::exact(78.0))
        .column(Column::exact(84.0))
        .column(Column::exact(DEVIATION))
        .column(Column::remainder().at_least(60.0).at_most(160.0))
        .header(space::ROW, |mut row| {
            row.col(|ui| drop(ui.hint("Mode")));
            for name in ["Frequency", name_of_measure, "Deviation", "Half-power"] {
                row.col(|ui| drop(identified::head_right(ui, name)));
            }
        })
        .body(|body| {
            body.rows(space::ROW, outcome.results.modes.len(), |mut row| {
                let r = row.index();
                let mode = &outcome.results.modes[r];
                row.col(|ui| drop(ui.label(format!("{}", r + 1))));
                row.col(|ui| drop(ui.number(format::with_unit(mode.frequency_hz, "Hz"))));
                let [value, deviation] = measure.of(mode.damping_ratio, mode.damping_ratio_deviation);
                row.col(|ui| drop(ui.number(said(value, format::supported(value, deviation)))));
                row.col(|ui| drop(ui.number(if deviation > 0.0 { said(deviation, 2) } else { "–".to_owned() })));
                let half_power = mode.half_power_ratio.map(|ratio| said(measure.of(ratio, 0.0)[0], 3));
                row.col(|ui| drop(ui.number(half_power.unwrap_or_else(|| "–".to_owned()))));
            });
        });
}

fn response(ui: &mut Ui, opened: &mut Opened<'_>, draw: impl FnOnce(&Diagram<'_>, &mut Ui, f64)) {
    if ready(ui, opened).is_none() {
        return;
    }
    let document = opened.document;
    let p = &document.project;
    match opened.derived.response(ui.ctx(), document, opened.view) {
        None => ui.empty("The response is being computed", ""),
        Some(Err(error)) => ui.empty("There is no frequency response", &error),
        Some(Ok(response)) => {
            let labels = (p.structure.label(response.response), p.structure.label(response.excitation));
            ui.horizontal_wrapped(|ui| {
                quantities(ui, &mut opened.view.quantity);
                ui.hint(format!("DOF {} for a force at DOF {}", labels.0, labels.1))
                    .on_hover_text(t!("Select another DOF on the schematic."));
            });
            let diagram = Diagram { project: p, response: &response, quantity: opened.view.quantity };
            let run = p.runs.get(opened.view.run).map_or(1.0, |r| r.fit.omega);
            draw(&diagram, ui, run);
        }
    }
}

/// Loops of force over displacement of the selected run.
pub(crate) fn hysteresis(ui: &mut Ui, opened: &mut Opened<'_>) {
    if ready(ui, opened).is_none() {
        return;
    }
    let document = opened.document;
    let run = opened.view.run;
    match opened.derived.loops(ui.ctx(), document, run) {
        None => ui.empty("The loops are being computed", ""),
        Some(Err(error)) => ui.empty("There are no loops", &error),
        Some(Ok(loops)) => {
            let frequency = document.project.runs.get(run).map_or(0.0, |r| r.fit.omega / std::f64::consts::TAU);
            ui.hint(format!("Run {}, {}; arrow keys choose another", run + 1, format::with_unit(frequency, "Hz")));
            hysteresis::show(ui, &format!("Hysteresis of run {}", run + 1), &loops);
        }
    }
}

/// Everything identified as a table that can be copied.
pub(crate) fn values(ui: &mut Ui, opened: &mut Opened<'_>) {
    let Some(outcome) = ready(ui, opened) else { return };
    let document = opened.document;
    let p = &document.project;
    ui.horizontal(|ui| {
        ui.hint("Coefficients with one standard deviation");
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui
                .button(t!("Copy table"))
                .on_hover_text(t!("Columns are separated by tabs, as spreadsheets want them."))
                .clicked()
            {
                tabled::give(ui.ctx(), "Values", tabled::TableAction::Copy, tables::coefficients(p, &outcome));
            }
        });
    });
    ui.add_space(space::XS);
    ui.style_mut().interaction.selectable_labels = false;
    let width = ui.available_width();
    let known = || outcome.sources.iter().filter_map(|e| Some((p.sources.get(e.source)?, e)));
    let laws = widest(ui, known().map(|(s, _)| s.effect.noun().to_owned()));
    let places = widest(ui, known().map(|(s, _)| s.place.cell(&p.structure)));
    let values = widest(ui, known().map(|(s, e)| words::coefficient(s, e))).max(80.0);
    // The share of energy stands in its own pane, the law on the schematic: both go before a value is cut.
    let gap = ui.spacing().item_spacing.x;
    let with_share = width > places + values + SHARE + 3.0 * gap;
    let with_law = width > laws + places + values + SHARE + 4.0 * gap;
    TableBuilder::new(ui)
        .id_salt("values")
        .striped(true)
        .cell_layout(Layout::left_to_right(Align::Center))
        .column(Column::exact(if with_law { laws } else { 0.0 }).clip(true))
        .column(Column::remainder().at_least(60.0).clip(true))
        .column(Column::exact(values))
        .column(Column::exact(if with_share { SHARE } else { 0.0 }))
        .header(space::ROW, |mut row| {
            row.col(|ui| if_there(with_law, || ui.hint("Law")));
            row.col(|ui| drop(ui.hint("Place")));
            row.col(|ui| drop(identified::head_right(ui, "Coefficient")));
            row.col(|ui| if_there(with_share, || identified::head_right(ui, "Energy")));
        })
        .body(|body| {
            body.rows(space::ROW, outcome.sources.len(), |mut row| {
                let estimate = &outcome.sources[row.index()];
                let Some(source) = p.sources.get(estimate.source) else { return };
                row.col(|ui| if_there(with_law, || ui.label(tr(source.effect.noun()))));
                row.col(|ui| drop(ui.label(tr(source.place.cell(&p.structure)))));
                row.col(|ui| drop(ui.number(words::coefficient(source, estimate))));
                row.col(|ui| if_there(with_share, || ui.number(format::percent(0.01 * estimate.energy_percent))));
            });
        });
}

/// Width that the widest of the words takes in a cell, points.
pub(super) fn widest(ui: &Ui, texts: impl Iterator<Item = String>) -> f32 {
    texts.map(|text| width(ui, &text, theme::font(size::BODY)) + 2.0 * space::XS).fold(40.0, f32::max)
}

/// Shows a cell of a column that goes where there is no room for it.
fn if_there(there: bool, cell: impl FnOnce() -> egui::Response) {
    if there {
        cell();
    }
}
