//! A decay or transient against the model: over time with what is left below, as spectra, what is left over time and frequency,
//! damping ratio and frequency over amplitude of the modes that stand out, one at a time.

use super::look::{Look, RecordTab};
use super::scene::Scene;
use super::switches::record_tabs;
use crate::diagnosis::records::compare::OneRecord;
use crate::display::format;
use crate::plots::amplitude_curve::{figures, told};
use crate::plots::figure::Figure;
use crate::plots::record_residual::RecordResidual;
use crate::window::appearance::theme::{self, size, space};
use crate::window::appearance::widgets::{UiExt, width};
use crate::window::language::tr;
use crate::window::plots::show::Stack;
use egui::{Align, Layout, Ui};

/// Share of the height that measured and modelled take above what is left.
const UPPER: f32 = 0.6;

/// Shows the plot that is chosen of record number `index` of the project, with the effect on trial where there is one.
pub(super) fn show(ui: &mut Ui, scene: &Scene<'_>, look: &mut Look, index: usize) {
    let found = match scene.explained.decays(scene.document, look.trial.as_ref()) {
        None => return ui.empty("The records are being compared", "Their progress is in the bar below."),
        Some(Err(error)) => return ui.empty("The records cannot be compared", error),
        Some(Ok(found)) => found,
    };
    let Some(record) = found.iter().find(|r| r.index == index).or_else(|| found.first()) else {
        return ui.empty("No record is used", "Tick one in the stage Measure.");
    };
    if look.record_tab == RecordTab::Amplitude {
        let file = scene.document.project.transient_runs.get(record.index).map_or("", |r| r.file.as_str());
        return curves(ui, file, record, look);
    }
    let shown = (record.index, look.record.clone());
    match scene.explained.record(scene.document, look.trial.as_ref(), shown) {
        None => ui.empty("The record is being prepared", "Its progress is in the bar below."),
        Some(Err(error)) => ui.empty("There is no record to show", error),
        Some(Ok(residual)) => one(ui, residual, look),
    }
}

/// A channel of a record.
fn one(ui: &mut Ui, residual: &RecordResidual, look: &mut Look) {
    head(ui, &residual.channel, &residual.file, look);
    let short = |ui: &mut Ui| ui.empty("The record is too short", "A spectrum needs more samples.");
    let title = residual.title();
    let stack = |ui: &mut Ui, figures: Vec<(Figure, f32)>| {
        let id = format!("{title} {}", look.record_tab.label());
        Stack { id: &id, title: &title, figures, keys: true }.show(ui);
    };
    match look.record_tab {
        RecordTab::Spectrum => match residual.spectra(ui.palette()) {
            Some(figure) => stack(ui, vec![(figure, 1.0)]),
            None => short(ui),
        },
        RecordTab::Spectrogram => match residual.spectrogram() {
            Some(found) => found.show(ui, &format!("Residual of {title}")),
            None => short(ui),
        },
        _ => {
            let figures = residual.over_time(ui.palette());
            stack(ui, figures.into_iter().zip([UPPER, 1.0 - UPPER]).collect());
        }
    }
}

fn curves(ui: &mut Ui, file: &str, record: &OneRecord, look: &mut Look) {
    let curves = told(&record.curves);
    let Some(curve) = curves.get(look.mode).or_else(|| curves.first()).copied() else {
        head(ui, file, "", look);
        return ui.empty("No amplitude curve", "No mode stands out of this record long enough.");
    };
    let near = format::with_unit(curve.frequency_hz, "Hz");
    head(ui, &curve.channel, &format!("{file}, near {near}"), look);
    if curves.len() > 1 {
        ui.horizontal_wrapped(|ui| {
            for (k, other) in curves.iter().enumerate() {
                let name = format!("Mode near {}", format::with_unit(other.frequency_hz, "Hz"));
                if ui.selectable_label(std::ptr::eq(*other, curve), tr(name)).clicked() {
                    look.mode = k;
                }
            }
        });
    }
    let drawn = figures(&[curve], ui.palette()).into_iter().map(|figure| (figure, 0.5)).collect();
    let title = format!("{file}: damping ratio and frequency over amplitude, {} near {near}", curve.channel);
    Stack { id: &title, title: &title, figures: drawn, keys: true }.show(ui);
}

/// Channel and file; beside the switches where the bar of the pane has no room for them, no more than there is room for.
fn head(ui: &mut Ui, channel: &str, remark: &str, look: &mut Look) {
    if look.in_bar[1] {
        return ui.title(channel, remark);
    }
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            record_tabs(ui, look);
            ui.add_space(space::M);
            let room = ui.available_width() - width(ui, channel, theme::font(size::HEADING)) - space::M;
            let remark = if width(ui, remark, theme::font(size::SMALL)) <= room { remark } else { "" };
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| ui.title(channel, remark));
        });
    });
}
