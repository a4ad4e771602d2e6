//! A decay or transient against the model: damping ratio and frequency over amplitude of the mode that stands out.

use crate::diagnosis::records::compare::OneRecord;
use crate::display::format;
use crate::effects::Source;
use crate::plots::amplitude_curve::{LEAST_POINTS, figure};
use crate::window::document::Document;
use crate::window::explained::Explained;
use crate::window::plots::show::Stack;
use crate::window::widgets::UiExt;
use egui::Ui;

/// Shows the curves of record number `index` of the project, with the effect on trial where there is one.
pub fn show(ui: &mut Ui, document: &Document, explained: &Explained, (trial, index): (Option<&Source>, usize)) {
    let found = match explained.decays(document, trial) {
        None => return ui.empty("The records are being compared", "Their progress is in the bar below."),
        Some(Err(error)) => return ui.empty("There are no amplitude curves", error),
        Some(Ok(found)) => found,
    };
    let Some(record) = found.iter().find(|r| r.index == index).or_else(|| found.first()) else {
        return ui.empty("No record is used", "Tick one in the stage Measure.");
    };
    let file = document.project.transient_runs.get(record.index).map_or("", |r| r.file.as_str());
    curves(ui, file, record);
}

fn curves(ui: &mut Ui, file: &str, record: &OneRecord) {
    let Some(curve) = record.curves.iter().find(|c| c.measured.len() >= LEAST_POINTS) else {
        ui.title(file, "");
        return ui.empty("No amplitude curve", "No mode stands out of this record long enough.");
    };
    let near = format::with_unit(curve.frequency_hz, "Hz");
    ui.title(&curve.channel, &format!("{file}, near {near}"));
    let figures = [true, false].map(|ratio| (figure(curve, ratio, ui.palette()), 0.5)).to_vec();
    let title = format!("{file}: damping ratio and frequency over amplitude, {} near {near}", curve.channel);
    Stack { id: &title, title: &title, figures, keys: true }.show(ui);
}
