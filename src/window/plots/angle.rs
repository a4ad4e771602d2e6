//! The angle between measured and identified energies against the number of sources, on a logarithmic axis.

use super::{axis, curve, frame, keys, log};
use crate::identify::Outcome;
use crate::window::format;
use crate::window::widgets::UiExt;
use egui::Ui;
use egui_plot::{AxisHints, GridMark, HLine, HPlacement, LineStyle, MarkerShape, PlotPoints, Points};

/// Angles below this are drawn as this: exact data reach rounding.
const LEAST: f64 = 1e-8;

/// Shows the chart with the step that is looked at as a filled point.
pub fn show(ui: &mut Ui, outcome: &Outcome, current: usize, limit_deg: f64) {
    let palette = ui.palette();
    keys(ui, &[(palette.model, "best set of each size"), (palette.weak, "alternatives"), (palette.missing, "limit")]);
    let height = |angle: f64| angle.max(LEAST).log10();
    let best: Vec<[f64; 2]> = outcome.steps.iter().map(|s| [s.count as f64, height(s.angle_deg)]).collect();
    let others: Vec<[f64; 2]> = outcome
        .steps
        .iter()
        .flat_map(|s| s.alternatives.iter().map(|a| [s.count as f64, height(a.angle_deg)]))
        .collect();
    let chosen = best.get(current).copied();
    let accepted = best.get(outcome.accepted).copied();
    let most = outcome.steps.last().map_or(1, |s| s.count) as f64;
    let y_axis = axis(AxisHints::new_y(), palette, "Angle, °")
        .placement(HPlacement::Left)
        .min_thickness(52.0)
        .formatter(|mark, _| log::label(mark.value));
    let whole = |input: egui_plot::GridInput| {
        let (low, high) = input.bounds;
        (low.ceil() as i64..=high.floor() as i64).map(|k| GridMark { value: k as f64, step_size: 1.0 }).collect()
    };
    frame(ui, "angle", "Number of sources", "")
        .custom_y_axes(vec![y_axis])
        .x_grid_spacer(whole)
        .y_grid_spacer(|input| log::decades(&input))
        .include_x(0.5)
        .include_x(most + 0.5)
        .include_y(height(limit_deg))
        .height(ui.available_height() - 6.0)
        .coordinates_formatter(
            egui_plot::Corner::RightTop,
            egui_plot::CoordinatesFormatter::new(|p, _| format!("{}°", format::significant(10f64.powf(p.y), 3))),
        )
        .show(ui, |plot| {
            let limit = HLine::new("limit", height(limit_deg)).color(palette.missing).style(LineStyle::dashed_loose());
            plot.hline(limit.allow_hover(false));
            let points = |name: &str, points: Vec<[f64; 2]>| {
                Points::new(name, PlotPoints::from(points)).shape(MarkerShape::Circle)
            };
            plot.points(points("alternatives", others).radius(3.0).color(palette.weak.gamma_multiply(0.6)));
            plot.line(curve("best", best.clone(), palette.model, 1.8));
            plot.points(points("best of each size", best).radius(4.5).color(palette.model));
            plot.points(
                points("accepted", accepted.into_iter().collect()).radius(8.0).filled(false).color(palette.model),
            );
            plot.points(points("looked at", chosen.into_iter().collect()).radius(6.0).color(palette.accent));
        });
}
