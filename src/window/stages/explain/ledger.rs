//! The ledger: error against steps on a logarithmic axis with the noise floor, and the steps by name, each a way back.

use super::grid::in_words;
use super::{Deed, Scene, cards};
use crate::explain::diagnose::Verdict;
use crate::window::app::Ask;
use crate::window::explained::ledger::Ledger;
use crate::window::format;
use crate::window::plots::{curve, frame, keys, log, upright};
use crate::window::theme::{self, size, space};
use crate::window::widgets::UiExt;
use egui::{Align2, Role, ScrollArea, Sense, Ui, WidgetInfo, pos2, vec2};
use egui_plot::{GridMark, LineStyle, MarkerShape, PlotPoints, Points};

/// Shows chart and steps.
pub fn show(ui: &mut Ui, scene: &Scene<'_>, asks: &mut Vec<Ask>) {
    let ledger = &scene.explained.ledger;
    if ledger.steps().is_empty() {
        ui.hint("The first comparison is running.");
        return;
    }
    let ahead = ahead(scene);
    let palette = ui.palette();
    let mut entries = vec![(palette.model, "error"), (palette.ink, "noise floor")];
    if ahead.len() > 1 {
        entries.push((palette.missing, "as suggested"));
    }
    keys(ui, &entries);
    let height = (0.42 * ui.available_height()).clamp(120.0, 210.0);
    chart(ui, ledger, &ahead, height);
    ui.add_space(space::XS);
    ScrollArea::vertical().id_salt("ledger").auto_shrink(false).show(ui, |ui| {
        for k in 0..ledger.steps().len() {
            if row(ui, ledger, k) && k != ledger.current() {
                asks.push(Ask::Explain(Deed::Return(k)));
            }
        }
        ui.add_space(space::XS);
        ui.hint("Click a step to go back to it, or forward again: none is lost.");
        if let Some(Ok(diagnosis)) = scene.explained.diagnosis(scene.document)
            && diagnosis.verdict != Verdict::Undecided
        {
            ui.add_space(space::M);
            cards::next_tests(ui, scene, diagnosis);
        }
    });
}

/// Errors that the suggestions would lead to, from the present one on.
fn ahead(scene: &Scene<'_>) -> Vec<[f64; 2]> {
    let ledger = &scene.explained.ledger;
    let Some(Ok(diagnosis)) = scene.explained.diagnosis(scene.document) else { return Vec::new() };
    let Some(now) = ledger.steps().get(ledger.current()) else { return Vec::new() };
    let start = std::iter::once(now.error).chain(diagnosis.steps.iter().skip(1).map(|s| s.error));
    start.enumerate().map(|(k, error)| [(ledger.current() + k) as f64, percent(error)]).collect()
}

/// Per cent on a logarithmic axis, which ends where an error says nothing more.
fn percent(share: f64) -> f64 {
    (100.0 * share).clamp(1e-6, 1e4).log10()
}

fn chart(ui: &mut Ui, ledger: &Ledger, ahead: &[[f64; 2]], height: f32) {
    let palette = ui.palette();
    let steps = ledger.steps();
    let at = |k: usize| [k as f64, percent(steps[k].error)];
    let y_axis = upright(palette, "Error, %")
        .min_thickness(46.0)
        .formatter(|mark, _| if mark.step_size >= 1.0 { log::label(mark.value) } else { log::frequency(mark.value) });
    let whole = |input: egui_plot::GridInput| {
        let (low, high) = input.bounds;
        (low.ceil() as i64..=high.floor() as i64).map(|k| GridMark { value: k as f64, step_size: 1.0 }).collect()
    };
    let floor = steps[ledger.current()].noise_floor;
    let last = ahead.last().map_or(0.0, |p| p[0]).max(steps.len() as f64 - 1.0).max(1.0);
    frame(ui, "ledger chart", "Step", "")
        .custom_y_axes(vec![y_axis])
        .x_grid_spacer(whole)
        .y_grid_spacer(|input| log::decades(&input))
        .include_x(-0.4)
        .include_x(last + 0.4)
        .include_y(percent(0.6 * floor))
        .height(height)
        .coordinates_formatter(
            egui_plot::Corner::RightTop,
            egui_plot::CoordinatesFormatter::new(|p, _| format!("{} %", format::significant(10f64.powf(p.y), 3))),
        )
        .show(ui, |plot| {
            let line = vec![[-0.4, percent(floor)], [last + 0.4, percent(floor)]];
            plot.line(curve("noise floor", line, palette.ink, 1.2).style(LineStyle::dashed_loose()));
            if ahead.len() > 1 {
                let dashed = curve("as suggested", ahead.to_vec(), palette.missing, 1.4);
                plot.line(dashed.style(LineStyle::dashed_dense()));
                let rings = Points::new("as suggested", PlotPoints::from(ahead[1..].to_vec()));
                let rings = rings.shape(MarkerShape::Circle).radius(4.5).filled(false).color(palette.missing);
                plot.points(rings.allow_hover(false));
            }
            let path = ledger.path();
            for (k, step) in steps.iter().enumerate() {
                let Some(parent) = step.parent else { continue };
                let on = path.contains(&k);
                let colour = if on { palette.model } else { palette.weak.gamma_multiply(0.6) };
                plot.line(curve("way", vec![at(parent), at(k)], colour, if on { 2.0 } else { 1.2 }));
            }
            let all: Vec<[f64; 2]> = (0..steps.len()).map(at).collect();
            let dots = |points: Vec<[f64; 2]>, radius: f32, colour| {
                let points = Points::new("step", PlotPoints::from(points)).shape(MarkerShape::Circle);
                points.radius(radius).color(colour).allow_hover(false)
            };
            plot.points(dots(all, 4.0, palette.model));
            plot.points(dots(vec![at(ledger.current())], 6.5, palette.accent));
        });
}

/// One step as a row; true when it was clicked.
fn row(ui: &mut Ui, ledger: &Ledger, k: usize) -> bool {
    let palette = ui.palette();
    let step = &ledger.steps()[k];
    let current = k == ledger.current();
    let (area, response) = ui.allocate_exact_size(vec2(ui.available_width(), space::ROW), Sense::click());
    let error = in_words(step.error);
    let label = format!("Step {k}: {}, error {error}", step.label);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, current, &label));
    let fill = if current {
        palette.accent_faint
    } else if response.hovered() || response.has_focus() {
        palette.raised
    } else {
        palette.pane
    };
    let painter = ui.painter();
    painter.rect_filled(area, 4.0, fill);
    let middle = area.center().y;
    let ink = if ledger.path().contains(&k) { palette.ink } else { palette.weak };
    let font = theme::font(size::BODY - 0.5);
    painter.text(pos2(area.left() + 6.0, middle), Align2::LEFT_CENTER, k, theme::font(size::SMALL), palette.weak);
    let figure = painter.text(pos2(area.right() - 6.0, middle), Align2::RIGHT_CENTER, error, font.clone(), ink);
    let clip = egui::Rect::from_min_max(area.min + vec2(24.0, 0.0), pos2(figure.left() - 8.0, area.bottom()));
    ui.painter_at(clip).text(pos2(clip.left(), middle), Align2::LEFT_CENTER, &step.label, font, ink);
    response.on_hover_text(label).clicked()
}
