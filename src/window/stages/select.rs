//! Select: one row a step, its coefficients and alternatives, the angle against the number of sources, energy per run.

use super::split;
use crate::exchange::Project;
use crate::identify::{Outcome, Status, Step};
use crate::window::app::{App, Ask};
use crate::window::commands::Command;
use crate::window::plots::{angle, energy};
use crate::window::theme::space;
use crate::window::view::View;
use crate::window::widgets::UiExt;
use crate::window::{format, words};
use egui::{Align, Layout, ScrollArea, Sense, Ui};
use egui_extras::{Column, TableBuilder};

/// Shows the stage.
pub fn show(ui: &mut Ui, app: &mut App, asks: &mut Vec<Ask>) {
    let Some(document) = &app.document else { return };
    let Some(outcome) = super::outcome(ui, &mut app.derived, document) else { return };
    let p = &document.project;
    let current = app.view.step.unwrap_or(outcome.accepted).min(outcome.steps.len() - 1);
    let mut chosen = app.view.step;
    split(
        ui,
        0.54,
        |ui| {
            header(ui, &outcome, current, asks);
            let height = (0.48 * ui.available_height()).min(space::ROW * (outcome.steps.len() as f32 + 1.5) + 12.0);
            steps(ui, p, &outcome, current, height, &mut chosen);
            ui.separator();
            details(ui, p, &outcome.steps[current]);
        },
        |ui| {
            let height = 0.5 * ui.available_height();
            ui.allocate_ui(egui::vec2(ui.available_width(), height), |ui| {
                ui.set_height(height);
                angle::show(ui, &outcome, current, p.settings.stop_angle_deg);
            });
            energy::show(ui, p, &outcome, current);
        },
    );
    app.view.step = chosen;
}

fn header(ui: &mut Ui, outcome: &Outcome, current: usize, asks: &mut Vec<Ask>) {
    ui.horizontal(|ui| {
        let good = matches!(outcome.status, Status::WithinNoise | Status::BelowAngle);
        ui.title("Steps", "");
        let colour = if good { ui.palette().good } else { ui.palette().warning };
        ui.pill(status(outcome.status), colour).on_hover_text(&outcome.reason);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            for (command, label, on) in [
                (Command::StepOn, "Step", current + 1 < outcome.steps.len()),
                (Command::StepBack, "Step back", current > 0),
            ] {
                if ui.add_enabled(on, egui::Button::new(label)).on_hover_text(command.entry().tooltip).clicked() {
                    asks.push(Ask::Command(command));
                }
            }
        });
    });
    ui.hint(&outcome.reason);
}

/// How the search ended, in words.
pub fn status(status: Status) -> &'static str {
    match status {
        Status::WithinNoise => "explains the data to the noise",
        Status::AboveNoise => "does not reach the noise",
        Status::BelowAngle => "below the angle limit",
        Status::AboveAngle => "above the angle limit",
    }
}

/// The sources of a set as one line: `viscous dashpot 3, 5, 13`.
pub fn set(p: &Project, sources: impl Iterator<Item = usize>) -> String {
    let mut laws: Vec<(&'static str, Vec<String>)> = Vec::new();
    for source in sources.filter_map(|s| p.sources.get(s)) {
        let (law, place) = (words::effect(source.effect), words::short_place(&p.structure, &source.place));
        match laws.iter_mut().find(|(l, _)| *l == law) {
            Some((_, places)) => places.push(place),
            None => laws.push((law, vec![place])),
        }
    }
    laws.iter().map(|(law, places)| format!("{law} {}", places.join(", "))).collect::<Vec<_>>().join("; ")
}

fn steps(ui: &mut Ui, p: &Project, outcome: &Outcome, current: usize, height: f32, chosen: &mut Option<usize>) {
    ui.style_mut().interaction.selectable_labels = false;
    TableBuilder::new(ui)
        .id_salt("steps")
        .striped(true)
        .sense(Sense::click())
        .cell_layout(Layout::left_to_right(Align::Center))
        .auto_shrink([false, true])
        .max_scroll_height(height)
        .column(Column::exact(62.0))
        .column(Column::remainder().at_least(120.0).clip(true))
        .column(Column::exact(76.0))
        .column(Column::exact(84.0))
        .column(Column::exact(86.0))
        .header(space::ROW, |mut row| {
            row.col(|ui| drop(ui.hint("Sources")));
            row.col(|ui| drop(ui.hint("Which")));
            for name in ["Angle", "Energy error", "χ² per row"] {
                row.col(|ui| super::head_right(ui, name));
            }
        })
        .body(|body| {
            body.rows(space::ROW, outcome.steps.len(), |mut row| {
                let k = row.index();
                let step = &outcome.steps[k];
                row.set_selected(k == current);
                row.col(|ui| {
                    ui.label(step.count.to_string());
                    if k == outcome.accepted {
                        ui.pill("best", ui.palette().model).on_hover_text(&outcome.reason);
                    }
                });
                row.col(|ui| drop(ui.label(set(p, step.sources.iter().map(|s| s.source)))));
                row.col(|ui| drop(ui.number(format!("{}°", format::significant(step.angle_deg, 4)))));
                row.col(|ui| drop(ui.number(format::percent(step.relative_error))));
                let per_row = step.chi_square / step.freedom.max(1) as f64;
                row.col(|ui| drop(ui.number(format::significant(per_row, 3))));
                if row.response().clicked() {
                    *chosen = Some(k);
                }
            });
        });
}

fn details(ui: &mut Ui, p: &Project, step: &Step) {
    let plural = if step.count == 1 { "source" } else { "sources" };
    let proved = if step.proved { "proved to be the best set of this size" } else { "the best set found" };
    ui.title(&format!("{} {plural}", step.count), proved);
    ScrollArea::vertical().id_salt("details").auto_shrink(false).show(ui, |ui| {
        egui::Grid::new("estimates").num_columns(4).min_col_width(90.0).spacing([space::L, space::XS]).show(ui, |ui| {
            for name in ["Law", "Place", "Coefficient", "Energy"] {
                ui.hint(name);
            }
            ui.end_row();
            for estimate in &step.sources {
                let Some(source) = p.sources.get(estimate.source) else { continue };
                ui.label(words::effect(source.effect));
                ui.label(words::place(&p.structure, &source.place));
                ui.label(super::coefficient(source, estimate));
                ui.label(format::percent(0.01 * estimate.energy_percent));
                ui.end_row();
            }
        });
        if step.alternatives.is_empty() {
            return;
        }
        ui.add_space(space::S);
        ui.title("Alternatives", "other sets of the same size, next best first");
        egui::Grid::new("alternatives").num_columns(2).min_col_width(90.0).spacing([space::L, space::XS]).show(
            ui,
            |ui| {
                for other in &step.alternatives {
                    ui.label(format!("{}°", format::significant(other.angle_deg, 4)));
                    ui.label(set(p, other.sources.iter().copied()));
                    ui.end_row();
                }
            },
        );
    });
}

/// The step that is looked at.
pub fn current<'a>(view: &View, outcome: &'a Outcome) -> Option<&'a Step> {
    outcome.steps.get(view.step.unwrap_or(outcome.accepted))
}
