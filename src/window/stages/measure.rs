//! Measure: the runs with what is wrong with them, the record with its fit, the spectrum.

use super::split;
use crate::exchange::Project;
use crate::measurement::Run;
use crate::window::app::{App, Ask};
use crate::window::derived::Trace;
use crate::window::document::Edit;
use crate::window::frame::inspector::frequency;
use crate::window::plots::{record::RecordPlot, spectrum};
use crate::window::theme::space;
use crate::window::view::View;
use crate::window::widgets::UiExt;
use crate::window::{format, words};
use egui::{Sense, Ui};
use egui_extras::{Column, TableBuilder, TableRow};
use std::sync::Arc;

/// Shows the stage.
pub fn show(ui: &mut Ui, app: &mut App, asks: &mut Vec<Ask>) {
    let Some(document) = &app.document else { return };
    let (view, derived) = (&mut app.view, &mut app.derived);
    if document.project.runs.is_empty() {
        ui.pane(|ui| ui.empty("No runs yet", "Add [[run]] entries with steady-state records to the project file."));
        return;
    }
    let run = view.run.min(document.project.runs.len() - 1);
    let channels = document.project.runs[run].fit.channels.len();
    view.channel = view.channel.min(channels.saturating_sub(1));
    let trace = derived.trace(document, run, view.channel);
    let p = &document.project;
    // Both halves choose: the table a run, the buttons a channel.
    let mut chosen = (run, view.channel);
    split(
        ui,
        0.40,
        |ui| table(ui, p, view, &mut chosen.0, asks),
        |ui| record(ui, &p.runs[run], run, &mut chosen.1, trace.as_ref()),
    );
    (app.view.run, app.view.channel) = chosen;
}

fn table(ui: &mut Ui, p: &Project, view: &View, chosen: &mut usize, asks: &mut Vec<Ask>) {
    ui.title("Runs", "steady-state tests, one a frequency and level");
    ui.add_space(space::XS);
    ui.style_mut().interaction.selectable_labels = false;
    TableBuilder::new(ui)
        .striped(true)
        .sense(Sense::click())
        .cell_layout(egui::Layout::left_to_right(egui::Align::Center))
        .column(Column::exact(36.0))
        .column(Column::remainder().at_least(70.0).clip(true))
        .column(Column::exact(86.0))
        .column(Column::exact(64.0))
        .column(Column::exact(118.0))
        .header(space::ROW, |mut header| {
            for (name, right) in
                [("Use", false), ("File", false), ("Frequency", true), ("Noise", true), ("Flags", false)]
            {
                header.col(|ui| {
                    if right {
                        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.hint(name));
                    } else {
                        ui.hint(name);
                    }
                });
            }
        })
        .body(|body| {
            body.rows(space::ROW, p.runs.len(), |mut row| {
                let index = row.index();
                row.set_selected(index == view.run);
                cells(&mut row, &p.runs[index], index, asks);
                if row.response().clicked() {
                    *chosen = index;
                }
            });
        });
}

fn cells(row: &mut TableRow<'_, '_>, run: &Run, index: usize, asks: &mut Vec<Ask>) {
    row.col(|ui| {
        let mut used = run.enabled;
        let response = ui.checkbox(&mut used, "");
        response.widget_info(|| {
            egui::WidgetInfo::selected(egui::Role::CheckBox, true, used, format!("Use run {}", index + 1))
        });
        if response.changed() {
            asks.push(Ask::Edit(Edit::UseRun(index, used)));
        }
    });
    row.col(|ui| drop(ui.label(&run.file)));
    row.col(|ui| drop(ui.number(format!("{} Hz", format::significant(run.fit.omega / std::f64::consts::TAU, 4)))));
    row.col(|ui| drop(ui.number(format::percent(run.noise_ratio))));
    row.col(|ui| {
        if let Some(first) = run.findings.first() {
            let more = run.findings.len() - 1;
            let text = words::flag(first.flag);
            let text = if more > 0 { format!("{text} +{more}") } else { text.to_owned() };
            ui.pill(&text, ui.palette().warning).on_hover_text(frequency(run));
        }
    });
}

fn record(ui: &mut Ui, run: &Run, index: usize, channel: &mut usize, trace: Option<&Arc<Trace>>) {
    let names: Vec<String> = run.fit.channels.iter().map(|c| c.channel.to_string()).collect();
    ui.horizontal_wrapped(|ui| {
        ui.title("Record", "");
        for (k, name) in names.iter().enumerate() {
            if ui.selectable_label(k == *channel, name).clicked() {
                *channel = k;
            }
        }
    });
    let Some(fit) = run.fit.channels.get(*channel) else { return };
    let Some(trace) = trace else {
        amplitudes(ui, run, *channel);
        return;
    };
    let axis = words::axis(fit.channel.quantity, false);
    let unit = axis.rsplit(", ").next().unwrap_or("");
    let id = format!("{index} {}", names[*channel]);
    let room = ui.available_size();
    let spectrum_width = 0.40 * room.x - space::S;
    ui.horizontal_top(|ui| {
        ui.vertical(|ui| {
            ui.set_width(room.x - spectrum_width - space::XL);
            RecordPlot { trace, fit, omega: run.fit.omega, axis, id: &id }.show(ui);
        });
        ui.vertical(|ui| {
            ui.set_width(spectrum_width);
            if let Some(s) = &trace.spectrum {
                spectrum::show(ui, &format!("{id} spectrum"), s, fit, run.fit.omega, unit);
            }
        });
    });
}

/// Amplitudes and phases of a run that came without a time record.
fn amplitudes(ui: &mut Ui, run: &Run, channel: usize) {
    ui.hint("This run came as fitted harmonics: there is no time record to show.");
    let Some(fit) = run.fit.channels.get(channel) else { return };
    let unit = words::axis(fit.channel.quantity, false).rsplit(", ").next().unwrap_or("");
    egui::Grid::new("amplitudes").num_columns(4).spacing([space::XL, space::XS]).show(ui, |ui| {
        for name in ["Harmonic", "Frequency", "Amplitude", "Phase"] {
            ui.hint(name);
        }
        ui.end_row();
        for (k, y) in fit.amplitudes.iter().enumerate() {
            let h = (k + 1) as f64;
            ui.label(format!("{}", k + 1));
            ui.label(format::with_unit(h * run.fit.omega / std::f64::consts::TAU, "Hz"));
            ui.label(format::with_deviation(y.re.hypot(y.im), fit.deviation(k + 1), unit));
            ui.label(format!("{}°", format::significant(y.im.atan2(y.re).to_degrees(), 4)));
            ui.end_row();
        }
    });
}
