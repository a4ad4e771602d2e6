//! Records that are not steady, decays and transients, in the stage Measure: their table and their samples over time.

use crate::display::{format, words};
use crate::exchange::Project;
use crate::measurement::{Channel, TransientRun};
use crate::plots::figure::{Axis, Data, Figure, Look};
use crate::plots::pyramid::Pyramid;
use crate::window::plots::show::Stack;
use crate::window::theme::space;
use crate::window::widgets::UiExt;
use egui::{Align, Layout, Role, Sense, Ui, WidgetInfo};
use egui_extras::{Column, TableBuilder, TableRow};
use std::sync::Arc;

/// A record by its file, and whether it is to be used from now on.
pub(crate) type Ticked = Option<(String, bool)>;

/// The table, one row a record; gives back what was ticked.
pub(crate) fn table(ui: &mut Ui, p: &Project, chosen: &mut usize) -> Ticked {
    let mut ticked = None;
    ui.style_mut().interaction.selectable_labels = false;
    ui.spacing_mut().item_spacing.x = space::XS;
    TableBuilder::new(ui)
        .id_salt("unsteady")
        .striped(true)
        .sense(Sense::click())
        .cell_layout(Layout::left_to_right(Align::Center))
        .column(Column::exact(30.0))
        .column(Column::remainder().at_least(80.0).clip(true))
        .columns(Column::exact(72.0), 2)
        .column(Column::exact(110.0).clip(true))
        .header(space::ROW, |mut header| {
            for name in ["Use", "File", "Kind", "Duration", "Flags"] {
                header.col(|ui| drop(ui.hint(name)));
            }
        })
        .body(|body| {
            body.rows(space::ROW, p.transient_runs.len(), |mut row| {
                let index = row.index();
                row.set_selected(index == *chosen);
                cells(&mut row, &p.transient_runs[index], index, &mut ticked);
                *chosen = if row.response().clicked() { index } else { *chosen };
            });
        });
    ticked
}

fn cells(row: &mut TableRow<'_, '_>, run: &TransientRun, index: usize, ticked: &mut Ticked) {
    row.col(|ui| {
        let mut used = run.enabled;
        let response = ui.checkbox(&mut used, "");
        response.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, used, format!("Use record {}", index + 1)));
        if response.changed() {
            *ticked = Some((run.file.clone(), used));
        }
    });
    row.col(|ui| drop(ui.label(&run.file).on_hover_text(&run.file)));
    row.col(|ui| drop(ui.label(run.kind.name())));
    row.col(|ui| drop(ui.label(format::prefixed(lasts(run), "s"))));
    row.col(|ui| {
        if let Some(first) = run.findings.first() {
            let reasons: Vec<&str> = run.findings.iter().map(|f| f.reason.as_str()).collect();
            ui.pill(words::flag(first.flag), ui.palette().warning).on_hover_text(reasons.join("\n"));
        }
    });
}

/// How long the part that is used lasts, s.
fn lasts(run: &TransientRun) -> f64 {
    run.time().last().zip(run.time().first()).map_or(0.0, |(b, a)| b - a)
}

/// A button a channel; gives back the one that is looked at.
pub(crate) fn channels(ui: &mut Ui, run: &TransientRun, mut chosen: usize) -> usize {
    ui.horizontal_wrapped(|ui| {
        for (k, channel) in run.channels().iter().enumerate() {
            if ui.selectable_label(k == chosen, channel.to_string()).clicked() {
                chosen = k;
            }
        }
    });
    chosen
}

/// The samples of a channel over time, once they are prepared.
pub(crate) fn samples(ui: &mut Ui, file: &str, of: &Channel, prepared: Option<Result<Arc<Pyramid>, String>>) {
    let samples = match prepared {
        None => return ui.empty("The record is being prepared", ""),
        Some(Err(error)) => return ui.empty("There is no record to show", &error),
        Some(Ok(samples)) => samples,
    };
    let title = format!("{file}, {of}");
    let y = Axis::of(words::axis(of.quantity, false));
    let figure = Figure::new(&title, Axis::new("Time", "s"), y);
    let figure = figure.with("measured", ui.palette().measured, Look::Line(1.2), Data::Record(samples));
    Stack { id: &title, title: &title, figures: vec![(figure, 1.0)], keys: true }.show(ui);
}
