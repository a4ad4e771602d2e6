//! Structure: natural frequencies beside the frequencies of the runs, mode shapes, which DOFs are measured.

use super::identified;
use super::run_table::{common_folder, file_name};
use crate::display::{format, words};
use crate::exchange::Project;
use crate::measurement::Quantity;
use crate::plots::figure::{Axis, Figure, Look, Ticks};
use crate::structure::modes::Modes;
use crate::window::app::opened::Opened;
use crate::window::appearance::theme::space;
use crate::window::appearance::widgets::UiExt;
use crate::window::background::derived::Derived;
use crate::window::document::Document;
use crate::window::plots::show::Stack;
use egui::{Sense, Ui};
use egui_extras::{Column, TableBuilder};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Least width of the names of files in the table of the expansion, points.
const LEAST_FILE: f32 = 72.0;

/// The modes, once they are there; else what is shown in their place.
fn ready(ui: &mut Ui, opened: &mut Opened<'_>) -> Option<Arc<Modes>> {
    let document = opened.document;
    if document.project.structure.matrices().is_none() {
        ui.empty("Points without a model", "No mass or stiffness is given: the energy balance needs none.");
        return None;
    }
    match opened.derived.modes(ui.ctx(), document) {
        None => ui.empty("Modes are being computed", "This takes a moment for large matrices."),
        Some(Err(error)) => ui.empty("There are no modes", &error),
        Some(Ok(modes)) => {
            opened.view.mode = opened.view.mode.min(modes.len().saturating_sub(1));
            return Some(modes);
        }
    }
    None
}

/// The table of natural frequencies.
pub(crate) fn modes(ui: &mut Ui, opened: &mut Opened<'_>) {
    let Some(modes) = ready(ui, opened) else { return };
    let document = opened.document;
    let mut mode = opened.view.mode;
    table(ui, &document.project, &modes, &mut mode);
    opened.view.mode = mode;
}

/// The used run whose frequency is nearest to a mode, with its distance in per cent of the mode's frequency.
fn nearest(p: &Project, frequency: f64) -> Option<(usize, f64)> {
    let distance = |omega: f64| (omega / TAU / frequency - 1.0) * 100.0;
    p.runs
        .iter()
        .enumerate()
        .map(|(k, r)| (k, distance(r.fit.omega)))
        .min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
        .filter(|(_, d)| d.abs() < 15.0)
}

fn table(ui: &mut Ui, p: &Project, modes: &Modes, chosen: &mut usize) {
    ui.style_mut().interaction.selectable_labels = false;
    let folder = common_folder(p);
    TableBuilder::new(ui)
        .striped(true)
        .sense(Sense::click())
        .cell_layout(egui::Layout::left_to_right(egui::Align::Center))
        .column(Column::exact(44.0))
        .column(Column::exact(86.0))
        .column(Column::remainder().clip(true))
        .column(Column::exact(66.0))
        .header(space::ROW, |mut header| {
            header.col(|ui| drop(ui.hint("Mode")));
            header.col(|ui| drop(identified::head_right(ui, "Frequency")));
            header.col(|ui| {
                ui.add_space(space::M);
                ui.hint("Nearest run");
            });
            header.col(|ui| drop(identified::head_right(ui, "Run − mode")));
        })
        .body(|body| {
            body.rows(space::ROW, modes.len(), |mut row| {
                let r = row.index();
                row.set_selected(r == *chosen);
                let frequency = modes.frequency_hz(r);
                row.col(|ui| drop(ui.label(format!("{}", r + 1))));
                row.col(|ui| drop(ui.number(format::with_unit(frequency, "Hz"))));
                let near = nearest(p, frequency);
                row.col(|ui| {
                    if let Some((k, _)) = near {
                        ui.add_space(space::M);
                        file_name(ui, &p.runs[k].file, folder);
                    }
                });
                row.col(|ui| {
                    if let Some((_, d)) = near {
                        ui.number(
                            format!("{d:+.2} %").replace("-0.00", "0.00").replace("+0.00", "0.00").replace('-', "−"),
                        );
                    }
                });
                if row.response().clicked() {
                    *chosen = r;
                }
            });
        });
}

/// Natural frequencies as lines, runs as points.
pub(crate) fn frequencies(ui: &mut Ui, opened: &mut Opened<'_>) {
    let Some(modes) = ready(ui, opened) else { return };
    let document = opened.document;
    let (p, mode, palette) = (&document.project, opened.view.mode, ui.palette());
    let runs: Vec<f64> = p.runs.iter().map(|r| r.fit.omega / TAU).collect();
    let highest = runs.iter().copied().fold(0.0, f64::max).max(modes.frequency_hz(2.min(modes.len() - 1)));
    let shown: Vec<usize> = (0..modes.len()).filter(|&r| modes.frequency_hz(r) <= 1.6 * highest).collect();
    let last = shown.last().map_or(highest, |&r| modes.frequency_hz(r));
    let x = Axis::new("Frequency", "Hz").include(&[0.0, 1.05 * last]);
    let y = Axis::new("Run", "").ticks(Ticks::Whole).include(&[0.5, runs.len() as f64 + 0.5]);
    let line = |r: usize| vec![[modes.frequency_hz(r), 1.0]];
    let figure = Figure::new("Natural frequencies and runs", x, y)
        .points(
            "natural frequencies",
            palette.model,
            Look::Uprights(1.2),
            shown.iter().flat_map(|&r| line(r)).collect(),
        )
        .points("selected mode", palette.accent, Look::Uprights(2.4), line(mode))
        .points("runs", palette.measured, Look::Dots(4.0), (1..).zip(runs).map(|(k, f)| [f, f64::from(k)]).collect());
    let title = "Natural frequencies and runs";
    Stack { id: "mode frequencies", title, figures: vec![(figure, 1.0)], keys: true }.show(ui);
}

/// The translations of the selected mode as bars.
pub(crate) fn shape(ui: &mut Ui, opened: &mut Opened<'_>) {
    let Some(modes) = ready(ui, opened) else { return };
    let document = opened.document;
    let (p, mode, palette) = (&document.project, opened.view.mode, ui.palette());
    let frequency = format::with_unit(modes.frequency_hz(mode), "Hz");
    let translations = p.structure.translations();
    let shape = upright(modes.shape(mode), &translations);
    let largest = translations.iter().map(|&d| shape[d].abs()).fold(f64::MIN_POSITIVE, f64::max);
    let bars = |measured: bool| -> Vec<[f64; 2]> {
        let wanted = |(_, d): &(usize, &usize)| is_measured(p, **d) == measured;
        translations.iter().enumerate().filter(wanted).map(|(k, &d)| [k as f64, shape[d] / largest]).collect()
    };
    let labels: Arc<[String]> = translations.iter().map(|&d| p.structure.label(d).to_owned()).collect();
    let title = format!("Shape of mode {}, {frequency}", mode + 1);
    let x = Axis::new("DOF", "").ticks(Ticks::Names(labels)).include(&[-0.5, translations.len() as f64 - 0.5]);
    let figure = Figure::new(&title, x, Axis::new("Relative displacement", ""))
        .points("measured", palette.measured, Look::Bars(0.7), bars(true))
        .points("not measured", palette.weak.gamma_multiply(0.5), Look::Bars(0.7), bars(false));
    ui.hint(&title);
    Stack { id: "mode shape", title: &title, figures: vec![(figure, 1.0)], keys: true }.show(ui);
}

/// Whether a motion of the DOF is measured in any run.
fn is_measured(p: &Project, dof: usize) -> bool {
    let channels = p.runs.iter().flat_map(|r| &r.fit.channels).map(|c| &c.channel);
    channels.into_iter().any(|c| c.dof == dof && c.quantity != Quantity::Force)
}

/// What is measured, how the rest follows from it and how well.
pub(crate) fn expansion(ui: &mut Ui, document: &Document, derived: &mut Derived) {
    let p = &document.project;
    let all: Vec<usize> = (0..p.structure.len()).collect();
    let labels: Vec<&str> = all.iter().filter(|&&d| is_measured(p, d)).map(|&d| p.structure.label(d)).collect();
    ui.pair("Measured DOFs", format!("{} of {}", labels.len(), p.structure.len()));
    ui.hint(labels.join(", "));
    ui.add_space(space::S);
    let Some(outcome) = identified::outcome(ui, derived, document) else { return };
    ui.pair("Expansion to the others", words::expansion(outcome.expansion));
    ui.pair("Model error it allows for", format::percent(outcome.model_error));
    ui.add_space(space::S);
    ui.spacing_mut().item_spacing.x = space::XS;
    let figures = ((ui.available_width() - LEAST_FILE - 3.0 * space::XS) / 3.0).min(104.0);
    TableBuilder::new(ui)
        .id_salt("expansion")
        .striped(true)
        .cell_layout(egui::Layout::left_to_right(egui::Align::Center))
        .column(Column::remainder().at_least(LEAST_FILE).clip(true))
        .columns(Column::exact(figures), 3)
        .header(space::ROW, |mut row| {
            row.col(|ui| drop(ui.hint("Run")));
            for name in ["At sensors", "In deviations", "At other DOFs"] {
                row.col(|ui| drop(identified::head_right(ui, name)));
            }
        })
        .body(|body| {
            body.rows(space::ROW, outcome.runs.len(), |mut row| {
                let r = &outcome.runs[row.index()];
                row.col(|ui| drop(ui.label(p.runs.get(r.run).map_or("", |run| run.file.as_str()))));
                row.col(|ui| drop(ui.number(format::percent(r.relative_misfit))));
                row.col(|ui| drop(ui.number(format::significant(r.misfit, 3))));
                row.col(|ui| drop(ui.number(format::percent(r.expansion_error))));
            });
        });
}

/// A shape with the sign that makes its largest translation positive.
pub(crate) fn upright(mut shape: Vec<f64>, translations: &[usize]) -> Vec<f64> {
    let largest = translations.iter().map(|&d| shape[d]).max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0);
    if largest < 0.0 {
        shape.iter_mut().for_each(|v| *v = -*v);
    }
    shape
}
