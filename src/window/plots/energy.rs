//! Measured and identified energy of every run, on a logarithmic axis.

use super::{axis, frame, keys, log};
use crate::exchange::Project;
use crate::identify::Outcome;
use crate::window::format;
use crate::window::widgets::UiExt;
use egui::Ui;
use egui_plot::{AxisHints, GridMark, HPlacement, Line, MarkerShape, PlotPoints, Points};

/// Shows the chart for one step of the selection.
pub fn show(ui: &mut Ui, p: &Project, outcome: &Outcome, current: usize) {
    let palette = ui.palette();
    keys(ui, &[(palette.measured, "measured input"), (palette.model, "identified")]);
    let Some(step) = outcome.steps.get(current) else { return };
    let height = |energy: f64| (energy > 0.0).then(|| energy.log10());
    let number = |run: usize| run as f64 + 1.0;
    let pairs = || outcome.runs.iter().zip(&step.identified_energy);
    let measured: Vec<[f64; 2]> = pairs().filter_map(|(r, _)| Some([number(r.run), height(r.input_energy)?])).collect();
    let identified: Vec<[f64; 2]> = pairs().filter_map(|(r, &e)| Some([number(r.run), height(e)?])).collect();
    let joined: Vec<[[f64; 2]; 2]> = pairs()
        .filter_map(|(r, &e)| Some([[number(r.run), height(r.input_energy)?], [number(r.run), height(e)?]]))
        .collect();
    let y_axis = axis(AxisHints::new_y(), palette, "Energy, J")
        .placement(HPlacement::Left)
        .min_thickness(52.0)
        .formatter(|mark, _| log::label(mark.value));
    let whole = |input: egui_plot::GridInput| {
        let (low, high) = input.bounds;
        (low.ceil() as i64..=high.floor() as i64).map(|k| GridMark { value: k as f64, step_size: 1.0 }).collect()
    };
    frame(ui, "energy per run", "Run", "")
        .custom_y_axes(vec![y_axis])
        .x_grid_spacer(whole)
        .y_grid_spacer(|input| log::decades(&input))
        .include_x(0.5)
        .include_x(p.runs.len() as f64 + 0.5)
        .height(ui.available_height() - 4.0)
        .coordinates_formatter(
            egui_plot::Corner::RightTop,
            egui_plot::CoordinatesFormatter::new(|p, _| format::prefixed(10f64.powf(p.y), "J")),
        )
        .show(ui, |plot| {
            for ends in joined {
                plot.line(Line::new("difference", ends.to_vec()).color(palette.missing).width(2.0).allow_hover(false));
            }
            let points = |name: &str, points: Vec<[f64; 2]>| {
                Points::new(name, PlotPoints::from(points)).shape(MarkerShape::Circle)
            };
            plot.points(points("measured", measured).radius(4.0).color(palette.measured));
            plot.points(points("identified", identified).radius(6.5).filled(false).color(palette.model));
        });
}
