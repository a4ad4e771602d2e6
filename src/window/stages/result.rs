//! Result: the damping matrix, energy shares, damping ratios, frequency responses, hysteresis.

use super::split;
use crate::exchange::Project;
use crate::identify::Outcome;
use crate::response::frequency_response::Quantity;
use crate::window::app::{App, Ask};
use crate::window::derived::Derived;
use crate::window::document::Document;
use crate::window::plots::{bars, bode::Diagram, heatmap, hysteresis};
use crate::window::theme::space;
use crate::window::view::{Pane, View};
use crate::window::widgets::UiExt;
use crate::window::{format, solid, words};
use egui::{Align, Layout, ScrollArea, Ui};
use egui_extras::{Column, TableBuilder};

/// Shows the stage.
pub fn show(ui: &mut Ui, app: &mut App, _asks: &mut [Ask]) {
    let Some(document) = &app.document else { return };
    let Some(outcome) = super::outcome(ui, &mut app.derived, document) else { return };
    let p = &document.project;
    let (derived, view) = (&mut app.derived, &mut app.view);
    let (mut whole, mut in_space) = (view.whole_matrix, view.matrix_in_space);
    split(
        ui,
        0.40,
        |ui| matrix(ui, p, &outcome, &mut whole, &mut in_space),
        |ui| panes(ui, document, &outcome, derived, view),
    );
    (app.view.whole_matrix, app.view.matrix_in_space) = (whole, in_space);
}

fn matrix(ui: &mut Ui, p: &Project, outcome: &Outcome, whole: &mut bool, in_space: &mut bool) {
    let results = &outcome.results;
    let linear = results.others.is_empty();
    let (matrix, name) = if linear {
        (&results.viscous, "identified, viscous")
    } else {
        (&results.equivalent_viscous, "energy-equivalent viscous")
    };
    ui.horizontal(|ui| {
        ui.title("Damping matrix", &format!("N·s/m, {name}"));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.checkbox(whole, "All DOFs");
            for (shown, name) in [(true, "3-D"), (false, "Map")] {
                if ui.selectable_label(*in_space == shown, name).clicked() {
                    *in_space = shown;
                }
            }
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
    let map = heatmap::HeatMap { matrix, rows: &rows, labels: &labels, unit: "N s/m" };
    if *in_space {
        solid::bars::Bars::new(&map).show(ui, "matrix in space", map.unit);
    } else {
        map.show(ui);
    }
}

fn panes(ui: &mut Ui, document: &Document, outcome: &Outcome, derived: &mut Derived, view: &mut View) {
    let p = &document.project;
    ui.horizontal(|ui| {
        for pane in Pane::ALL {
            if ui.selectable_label(view.pane == pane, pane.label()).clicked() {
                view.pane = pane;
            }
        }
        if matches!(view.pane, Pane::Bode | Pane::Nyquist) {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                for (quantity, name) in [
                    (Quantity::Accelerance, "Accelerance"),
                    (Quantity::Mobility, "Mobility"),
                    (Quantity::Receptance, "Receptance"),
                ] {
                    if ui.selectable_label(view.quantity == quantity, name).clicked() {
                        view.quantity = quantity;
                    }
                }
            });
        }
    });
    ui.separator();
    match view.pane {
        Pane::Energy => shares(ui, p, outcome),
        Pane::Damping => damping(ui, outcome),
        Pane::Bode | Pane::Nyquist => response(ui, document, derived, view),
        Pane::Hysteresis => loops(ui, document, derived, view),
    }
}

fn shares(ui: &mut Ui, p: &Project, outcome: &Outcome) {
    let palette = ui.palette();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.title("By source", "share of the energy over all used runs");
        let bar = |estimate: &crate::identify::Estimate| {
            let source = p.sources.get(estimate.source)?;
            let known = source.state == crate::effects::State::Known;
            Some(bars::Bar {
                name: format!("{} {}", words::effect(source.effect), words::short_place(&p.structure, &source.place)),
                share: 0.01 * estimate.energy_percent,
                colour: if known { palette.weak } else { palette.model },
            })
        };
        bars::show(ui, &outcome.sources.iter().filter_map(bar).collect::<Vec<_>>(), 190.0);
        ui.add_space(space::M);
        ui.title("By degree of freedom", "where it is lost; adds up to 100 %");
        let by_dof: Vec<bars::Bar> = outcome
            .results
            .energy_percent
            .iter()
            .enumerate()
            .filter(|(_, percent)| percent.abs() > 1e-9)
            .map(|(d, percent)| bars::Bar {
                name: format!("DOF {}", p.structure.label(d)),
                share: 0.01 * percent,
                colour: palette.model,
            })
            .collect();
        bars::show(ui, &by_dof, 190.0);
        ui.add_space(space::M);
        ui.title("Coefficients", "with one standard deviation");
        for estimate in &outcome.sources {
            let Some(source) = p.sources.get(estimate.source) else { continue };
            let place = words::place(&p.structure, &source.place);
            ui.pair(&format!("{} {place}", words::effect(source.effect)), super::coefficient(source, estimate));
        }
        for warning in &outcome.warnings {
            ui.add_space(space::XS);
            ui.colored_label(palette.warning, warning);
        }
    });
}

fn damping(ui: &mut Ui, outcome: &Outcome) {
    if outcome.results.modes.is_empty() {
        ui.empty("No modes", "Damping ratios need mass and stiffness.");
        return;
    }
    ui.style_mut().interaction.selectable_labels = false;
    TableBuilder::new(ui)
        .id_salt("damping")
        .striped(true)
        .cell_layout(Layout::left_to_right(Align::Center))
        .column(Column::exact(60.0))
        .column(Column::exact(120.0))
        .column(Column::exact(200.0))
        .column(Column::remainder())
        .header(space::ROW, |mut row| {
            row.col(|ui| drop(ui.hint("Mode")));
            for name in ["Frequency", "Damping ratio", "From half-power points"] {
                row.col(|ui| super::head_right(ui, name));
            }
        })
        .body(|body| {
            body.rows(space::ROW, outcome.results.modes.len(), |mut row| {
                let r = row.index();
                let mode = &outcome.results.modes[r];
                row.col(|ui| drop(ui.label(format!("{}", r + 1))));
                row.col(|ui| drop(ui.number(format::with_unit(mode.frequency_hz, "Hz"))));
                row.col(|ui| {
                    let (ratio, deviation) = (100.0 * mode.damping_ratio, 100.0 * mode.damping_ratio_deviation);
                    ui.number(format::with_deviation(ratio, deviation, "%"));
                });
                row.col(|ui| {
                    let text = mode.half_power_ratio.map_or_else(|| "–".to_owned(), format::percent);
                    ui.number(text);
                });
            });
        });
}

fn response(ui: &mut Ui, document: &Document, derived: &mut Derived, view: &View) {
    let p = &document.project;
    match derived.response(ui.ctx(), document, view) {
        None => ui.empty("The response is being computed", ""),
        Some(Err(error)) => ui.empty("There is no frequency response", &error),
        Some(Ok(response)) => {
            let labels = (p.structure.label(response.response), p.structure.label(response.excitation));
            ui.hint(format!("DOF {} for a force at DOF {}; select another DOF on the schematic", labels.0, labels.1));
            let diagram = Diagram { project: p, response: &response, quantity: view.quantity };
            if view.pane == Pane::Bode {
                diagram.bode(ui);
            } else {
                let run = p.runs.get(view.run).map_or(1.0, |r| r.fit.omega);
                diagram.nyquist(ui, run);
            }
        }
    }
}

fn loops(ui: &mut Ui, document: &Document, derived: &mut Derived, view: &View) {
    match derived.loops(document, view.run) {
        Err(error) => ui.empty("There are no loops", &error),
        Ok(loops) => {
            let frequency = document.project.runs.get(view.run).map_or(0.0, |r| r.fit.omega / std::f64::consts::TAU);
            ui.hint(format!("Run {}, {}; arrow keys choose another", view.run + 1, format::with_unit(frequency, "Hz")));
            hysteresis::show(ui, loops);
        }
    }
}
