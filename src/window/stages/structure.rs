//! Structure: natural frequencies beside the frequencies of the runs, mode shapes, which DOFs are measured.

use super::split;
use crate::exchange::Project;
use crate::structure::modes::Modes;
use crate::window::app::App;
use crate::window::theme::space;
use crate::window::widgets::UiExt;
use crate::window::{format, plots};
use egui::{Sense, Ui};
use egui_extras::{Column, TableBuilder};
use egui_plot::{Bar, BarChart, MarkerShape, PlotPoints, Points, VLine};
use std::f64::consts::TAU;

/// Shows the stage.
pub fn show(ui: &mut Ui, app: &mut App) {
    let Some(document) = &app.document else { return };
    let p = &document.project;
    if p.structure.matrices().is_none() {
        ui.pane(|ui| {
            ui.empty("Points without a model", "No mass or stiffness is given: the energy balance needs none.");
        });
        return;
    }
    match app.derived.modes(ui.ctx(), document) {
        None => ui.pane(|ui| ui.empty("Modes are being computed", "This takes a moment for large matrices.")),
        Some(Err(error)) => ui.pane(|ui| ui.empty("There are no modes", &error)),
        Some(Ok(modes)) => {
            let mut mode = app.view.mode.min(modes.len().saturating_sub(1));
            split(ui, 0.40, |ui| table(ui, p, &modes, &mut mode), |ui| charts(ui, p, &modes, app.view.mode));
            app.view.mode = mode;
        }
    }
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
    ui.title("Modes", "natural frequencies beside the runs that are near them");
    ui.add_space(space::XS);
    ui.style_mut().interaction.selectable_labels = false;
    TableBuilder::new(ui)
        .striped(true)
        .sense(Sense::click())
        .cell_layout(egui::Layout::left_to_right(egui::Align::Center))
        .column(Column::exact(54.0))
        .column(Column::exact(120.0))
        .column(Column::remainder().clip(true))
        .column(Column::exact(80.0))
        .header(space::ROW, |mut header| {
            for (name, right) in [("Mode", false), ("Frequency", true), ("   Nearest run", false), ("Distance", true)] {
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
            body.rows(space::ROW, modes.len(), |mut row| {
                let r = row.index();
                row.set_selected(r == *chosen);
                let frequency = modes.frequency_hz(r);
                row.col(|ui| drop(ui.label(format!("{}", r + 1))));
                row.col(|ui| drop(ui.number(format::with_unit(frequency, "Hz"))));
                let near = nearest(p, frequency);
                row.col(|ui| {
                    if let Some((k, _)) = near {
                        ui.label(format!("   {}", p.runs[k].file));
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

fn charts(ui: &mut Ui, p: &Project, modes: &Modes, mode: usize) {
    let palette = ui.palette();
    let height = ui.available_height();
    ui.title("Natural frequencies and runs", "");
    plots::keys(ui, &[(palette.model, "modes"), (palette.measured, "runs")]);
    let runs: Vec<f64> = p.runs.iter().map(|r| r.fit.omega / TAU).collect();
    let highest = runs.iter().copied().fold(0.0, f64::max).max(modes.frequency_hz(2.min(modes.len() - 1)));
    let shown: Vec<usize> = (0..modes.len()).filter(|&r| modes.frequency_hz(r) <= 1.6 * highest).collect();
    plots::frame(ui, "mode frequencies", "Frequency, Hz", "Run")
        .height(0.42 * height)
        .include_x(0.0)
        .include_x(1.05 * shown.last().map_or(highest, |&r| modes.frequency_hz(r)))
        .include_y(0.0)
        .include_y(runs.len() as f64 + 1.0)
        .show(ui, |plot| {
            for &r in &shown {
                let width = if r == mode { 2.4 } else { 1.2 };
                plot.vline(
                    VLine::new(format!("mode {}", r + 1), modes.frequency_hz(r)).color(palette.model).width(width),
                );
            }
            let points: PlotPoints<'_> = runs.iter().enumerate().map(|(k, f)| [*f, k as f64 + 1.0]).collect();
            plot.points(Points::new("runs", points).shape(MarkerShape::Circle).radius(4.0).color(palette.measured));
        });
    ui.title(&format!("Shape of mode {}", mode + 1), "translations; measured DOFs are filled");
    let measured = |dof: usize| {
        p.runs
            .iter()
            .flat_map(|r| &r.fit.channels)
            .any(|c| c.channel.dof == dof && c.channel.quantity != crate::measurement::Quantity::Force)
    };
    let shape = upright(modes.shape(mode), &p.structure.translations());
    let translations = p.structure.translations();
    let largest = translations.iter().map(|&d| shape[d].abs()).fold(f64::MIN_POSITIVE, f64::max);
    let bar = |(k, &d): (usize, &usize)| {
        let colour = if measured(d) { palette.measured } else { palette.line };
        Bar::new(k as f64, shape[d] / largest).width(0.7).fill(colour).name(format!("DOF {}", p.structure.label(d)))
    };
    let bars: Vec<Bar> = translations.iter().enumerate().map(bar).collect();
    let labels: Vec<String> = translations.iter().map(|&d| p.structure.label(d).to_owned()).collect();
    let x = plots::axis(egui_plot::AxisHints::new_x(), palette, "DOF").formatter(move |mark, _| {
        let k = mark.value.round();
        let whole = (mark.value - k).abs() < 1e-6 && k >= 0.0;
        if whole { labels.get(k as usize).cloned().unwrap_or_default() } else { String::new() }
    });
    plots::frame(ui, "mode shape", "DOF", "Relative displacement")
        .custom_x_axes(vec![x])
        .height(ui.available_height() - 4.0)
        .show(ui, |plot| plot.bar_chart(BarChart::new("shape", bars)));
}

/// A shape with the sign that makes its largest translation positive.
pub fn upright(mut shape: Vec<f64>, translations: &[usize]) -> Vec<f64> {
    let largest = translations.iter().map(|&d| shape[d]).max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0);
    if largest < 0.0 {
        shape.iter_mut().for_each(|v| *v = -*v);
    }
    shape
}
