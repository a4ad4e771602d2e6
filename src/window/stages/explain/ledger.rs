//! The ledger: error against steps on a logarithmic axis with the noise floor, and the steps by name, each a way back.

use super::cards;
use super::request::Request;
use super::scene::Scene;
use crate::diagnosis::result::Verdict;
use crate::display::findings::is_stuck;
use crate::display::format::in_words;
use crate::plots::figure::{Axis, Figure, Look, Ticks};
use crate::window::app::Ask;
use crate::window::appearance::theme::{self, size, space};
use crate::window::appearance::widgets::{UiExt, folded, width};
use crate::window::explained::ledger::Ledger;
use crate::window::language::tr;
use crate::window::plots::show::Stack;
use egui::{Align2, Role, ScrollArea, Sense, Ui, WidgetInfo, pos2, vec2};

/// Shows chart and steps.
pub(super) fn show(ui: &mut Ui, scene: &Scene<'_>, asks: &mut Vec<Ask>) {
    let ledger = &scene.explained.ledger;
    if ledger.steps().is_empty() {
        ui.hint("The first comparison is running.");
        return;
    }
    let ahead = ahead(scene);
    let height = (0.42 * ui.available_height()).clamp(140.0, 230.0);
    ui.allocate_ui(vec2(ui.available_width(), height), |ui| chart(ui, ledger, &ahead));
    ui.add_space(space::XS);
    ScrollArea::vertical().id_salt("ledger").auto_shrink(false).show(ui, |ui| {
        for k in 0..ledger.steps().len() {
            if row(ui, ledger, k) && k != ledger.current() {
                asks.push(Ask::Explain(Request::Return(k)));
            }
        }
        ui.add_space(space::XS);
        ui.hint("Click a step to go back to it, or forward again: none is lost.");
        if let Some(Ok(diagnosis)) = scene.explained.diagnosis(scene.document)
            && !matches!(diagnosis.verdict, Verdict::Undecided | Verdict::Unexplained)
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
    if is_stuck(diagnosis) {
        return Vec::new();
    }
    let Some(now) = ledger.steps().get(ledger.current()) else { return Vec::new() };
    let start = std::iter::once(now.error).chain(diagnosis.steps.iter().skip(1).map(|s| s.error));
    start.enumerate().map(|(k, error)| [(ledger.current() + k) as f64, percent(error)]).collect()
}

/// Per cent, within what an axis can show.
fn percent(share: f64) -> f64 {
    (100.0 * share).clamp(1e-6, 1e4)
}

fn chart(ui: &mut Ui, ledger: &Ledger, ahead: &[[f64; 2]]) {
    let palette = ui.palette();
    let steps = ledger.steps();
    let point = |k: usize| [k as f64, percent(steps[k].error)];
    let floor = percent(steps[ledger.current()].noise_floor);
    let last = ahead.last().map_or(0.0, |p| p[0]).max(steps.len() as f64 - 1.0).max(1.0);
    let x = Axis::new("Step", "").ticks(Ticks::Whole).include(&[-0.4, last + 0.4]);
    let y = Axis::log("Error", "%").ticks(Ticks::OneTwoFive).include(&[0.6 * floor]);
    let mut figure = Figure::new("Error against steps", x, y).points(
        "noise floor",
        palette.ink,
        Look::Levels(1.2),
        vec![[0.0, floor]],
    );
    if ahead.len() > 1 {
        figure = figure.points("as suggested", palette.missing, Look::Dashed(1.4), ahead.to_vec()).points(
            "as suggested",
            palette.missing,
            Look::Rings(4.5),
            ahead[1..].to_vec(),
        );
    }
    let path = ledger.path();
    for (k, step) in steps.iter().enumerate() {
        let Some(parent) = step.parent else { continue };
        let on = path.contains(&k);
        let colour = if on { palette.model } else { palette.weak.gamma_multiply(0.6) };
        figure = figure.points("", colour, Look::Line(if on { 2.0 } else { 1.2 }), vec![point(parent), point(k)]);
    }
    let figure = figure.points("error", palette.model, Look::Dots(4.0), (0..steps.len()).map(point).collect()).points(
        "now",
        palette.accent,
        Look::Dots(6.5),
        vec![point(ledger.current())],
    );
    Stack { id: "ledger chart", title: "Error against steps", figures: vec![(figure, 1.0)], keys: true }.show(ui);
}

/// One step as a row; true when it was clicked.
fn row(ui: &mut Ui, ledger: &Ledger, k: usize) -> bool {
    let palette = ui.palette();
    let step = &ledger.steps()[k];
    let current = k == ledger.current();
    let error = tr(in_words(step.error));
    let ink = if ledger.path().contains(&k) { palette.ink } else { palette.weak };
    let font = theme::font(size::BODY - 0.5);
    let room = ui.available_width() - width(ui, &error, font.clone()) - 38.0;
    let name = folded(ui, &step.label, font.clone(), ink, room, 3);
    let height = space::ROW.max(name.size().y + 6.0);
    let (area, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click());
    let label = format!("Step {k}: {}, error {error}", step.label);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, current, tr(&label)));
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
    painter.text(pos2(area.left() + 6.0, middle), Align2::LEFT_CENTER, k, theme::font(size::SMALL), palette.weak);
    painter.text(pos2(area.right() - 6.0, middle), Align2::RIGHT_CENTER, error, font, ink);
    painter.galley(pos2(area.left() + 24.0, middle - 0.5 * name.size().y), name, ink);
    response.on_hover_text(tr(label)).clicked()
}
