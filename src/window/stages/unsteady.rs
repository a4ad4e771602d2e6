//! Records that are not steady, decays and transients, in the stage Measure: their table, their samples over time, their spectra.

use super::run_table::file_name;
use crate::display::{format, words};
use crate::exchange::Project;
use crate::measurement::TransientRun;
use crate::plots::unsteady_record::UnsteadyRecord;
use crate::window::app::opened::Opened;
use crate::window::appearance::theme::space;
use crate::window::appearance::widgets::UiExt;
use crate::window::language::{tf, tr};
use crate::window::plots::show::Stack;
use egui::{Align, Layout, Role, Sense, Ui, WidgetInfo};
use egui_extras::{Column, TableBuilder, TableRow};
use std::sync::Arc;

/// Where a pane is empty because no run is selected.
pub(super) const FOLLOWS: &str = "It follows the run that is selected in the table.";

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
        response.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, used, tf!("Use record {}", index + 1)));
        if response.changed() {
            *ticked = Some((run.file.clone(), used));
        }
    });
    row.col(|ui| file_name(ui, &run.file, 0));
    row.col(|ui| drop(ui.label(tr(run.kind.name()))));
    row.col(|ui| drop(ui.label(tr(format::prefixed(lasts(run), "s")))));
    row.col(|ui| {
        if let Some(first) = run.findings.first() {
            let reasons: Vec<&str> = run.findings.iter().map(|f| f.reason.as_str()).collect();
            ui.pill(words::flag(first.flag), ui.palette().warning).on_hover_text(tr(reasons.join("\n")));
        }
    });
}

/// How long the part that is used lasts, s.
fn lasts(run: &TransientRun) -> f64 {
    run.time().last().zip(run.time().first()).map_or(0.0, |(b, a)| b - a)
}

/// A button a channel; gives back the one that is looked at.
fn channels(ui: &mut Ui, run: &TransientRun, mut chosen: usize) -> usize {
    ui.horizontal_wrapped(|ui| {
        for (k, channel) in run.channels().iter().enumerate() {
            if ui.selectable_label(k == chosen, channel.to_string()).clicked() {
                chosen = k;
            }
        }
    });
    chosen
}

/// The record and the channel that are looked at, and what there is of them; otherwise says why there is nothing.
fn shown(ui: &mut Ui, opened: &mut Opened<'_>) -> Option<(String, Arc<UnsteadyRecord>)> {
    let document = opened.document;
    let records = &document.project.transient_runs;
    let index = opened.view.run.min(records.len().saturating_sub(1));
    let Some(run) = records.get(index) else {
        ui.empty("No record yet", FOLLOWS);
        return None;
    };
    let number = opened.view.channel.min(run.channels().len().saturating_sub(1));
    let title = format!("{}, {}", run.file, run.channels().get(number)?);
    match opened.derived.unsteady(ui.ctx(), document, [index, number]) {
        None => ui.empty("The record is being prepared", ""),
        Some(Err(error)) => ui.empty("There is no record to show", &error),
        Some(Ok(prepared)) => return Some((title, prepared)),
    }
    None
}

/// The record that is selected where none is steady, over time.
pub(crate) fn over_time(ui: &mut Ui, opened: &mut Opened<'_>) {
    let records = &opened.document.project.transient_runs;
    if let Some(run) = records.get(opened.view.run.min(records.len().saturating_sub(1))) {
        opened.view.channel = channels(ui, run, opened.view.channel.min(run.channels().len().saturating_sub(1)));
    }
    if let Some((title, record)) = shown(ui, opened) {
        let figures = vec![(record.over_time(ui.palette(), &title), 1.0)];
        Stack { id: &title, title: &title, figures, keys: true }.show(ui);
    }
}

/// Its amplitude spectrum.
pub(crate) fn over_frequency(ui: &mut Ui, opened: &mut Opened<'_>) {
    let Some((title, record)) = shown(ui, opened) else { return };
    let title = format!("Spectrum of {title}");
    match record.over_frequency(ui.palette(), &title) {
        Some(figure) => Stack { id: &title, title: &title, figures: vec![(figure, 1.0)], keys: true }.show(ui),
        None => ui.empty("No spectrum", "The record is too short for one."),
    }
}
