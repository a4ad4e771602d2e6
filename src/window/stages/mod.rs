//! The stages of the work, one file each; what several share.

pub mod measure;
pub mod pattern;
pub mod result;
pub mod select;
pub mod structure;

use super::app::{App, Ask};
use super::view::Stage;
use egui::Ui;

/// Shows the stage that is open.
pub fn show(ui: &mut Ui, app: &mut App, asks: &mut Vec<Ask>) {
    match app.view.stage {
        Stage::Measure => measure::show(ui, app, asks),
        Stage::Structure => structure::show(ui, app),
        Stage::Pattern => pattern::show(ui, app, asks),
        Stage::Select => select::show(ui, app, asks),
        Stage::Result => result::show(ui, app, asks),
    }
}

/// Splits the room into a left part of the given share and the rest.
pub fn split(ui: &mut Ui, share: f32, left: impl FnOnce(&mut Ui), right: impl FnOnce(&mut Ui)) {
    let room = ui.available_rect_before_wrap();
    let gap = super::theme::space::GAP;
    let width = (share * (room.width() - gap)).round();
    let a = egui::Rect::from_min_size(room.min, egui::vec2(width, room.height()));
    let b = egui::Rect::from_min_max(egui::pos2(a.right() + gap, room.top()), room.max);
    for (rect, content) in [(a, Box::new(left) as Box<dyn FnOnce(&mut Ui) + '_>), (b, Box::new(right))] {
        let mut child = ui.new_child(egui::UiBuilder::new().max_rect(rect));
        super::widgets::UiExt::pane(&mut child, |ui| {
            ui.set_min_size(ui.available_size());
            content(ui);
        });
    }
    ui.advance_cursor_after_rect(room);
}

/// The answer of the identification, or what is shown in its place.
pub fn outcome(
    ui: &mut Ui,
    derived: &mut super::derived::Derived,
    document: &super::document::Document,
) -> Option<std::sync::Arc<crate::identify::Outcome>> {
    use super::widgets::UiExt;
    match derived.outcome(ui.ctx(), document) {
        Some(Ok(outcome)) => return Some(outcome),
        Some(Err(error)) => ui.pane(|ui| {
            ui.set_min_size(ui.available_size());
            ui.empty("Nothing was identified", &error);
        }),
        None => ui.pane(|ui| {
            ui.set_min_size(ui.available_size());
            ui.empty("Identification is running", "Its progress is in the bar below.");
        }),
    }
    None
}

/// A coefficient with its deviation and unit.
pub fn coefficient(source: &crate::effects::Source, estimate: &crate::identify::Estimate) -> String {
    let parameter = source.effect.coefficient().map(|k| source.effect.parameters()[k]);
    super::format::with_deviation(estimate.coefficient, estimate.deviation, parameter.map_or("", |p| p.unit))
}

/// The name of a column of numbers.
pub fn head_right(ui: &mut Ui, name: &str) {
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        ui.add_space(super::theme::space::XS);
        super::widgets::UiExt::hint(ui, name);
    });
}
