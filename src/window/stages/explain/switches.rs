//! What is chosen of the map and of the cell: in the bars of their panes, where there is room beside the titles, so that
//! maps and plots have the height; else in the panes.

use super::look::{Look, Tab};
use crate::window::theme::{self, size, space};
use crate::window::widgets::width;
use egui::Ui;

/// Room of a title beside its words, points.
const BESIDE_TITLE: f32 = 30.0;

/// Shows the switches of the map (0) or of the cell (1) in the bar of their pane, from right to left, where they have room
/// beside its `title`; the pane is told.
pub fn in_bar(ui: &mut Ui, place: usize, title: &str, look: &mut Look) {
    let title = width(ui, title, theme::font(size::BODY)) + BESIDE_TITLE;
    look.in_bar[place] = needed(ui, place) + title <= ui.available_width();
    if look.in_bar[place] {
        ui.add_space(space::S);
        if place == 0 { order(ui, look) } else { tabs(ui, look) }
    }
}

/// Room that the switches take, points.
fn needed(ui: &Ui, place: usize) -> f32 {
    let names: &[&str] = if place == 0 { &ORDERS.map(|o| o.1) } else { &Tab::ALL.map(Tab::label) };
    let rim = 2.0 * ui.spacing().button_padding.x + 2.0;
    names.iter().map(|name| width(ui, name, theme::font(size::BODY)) + rim).sum::<f32>() + space::S
}

/// Orders of the map, the last first.
const ORDERS: [(bool, &str); 2] = [(false, "In order"), (true, "Worst first")];

/// The order of the map, from right to left.
pub fn order(ui: &mut Ui, look: &mut Look) {
    ui.spacing_mut().item_spacing.x = 2.0;
    for (worst, label) in ORDERS {
        if ui.selectable_label(look.worst_first == worst, label).clicked() {
            look.worst_first = worst;
        }
    }
}

/// The plots of the cell, from right to left.
pub fn tabs(ui: &mut Ui, look: &mut Look) {
    ui.spacing_mut().item_spacing.x = 2.0;
    for tab in Tab::ALL.into_iter().rev() {
        if ui.selectable_label(look.tab == tab, tab.label()).on_hover_text(tab.tooltip()).clicked() {
            look.tab = tab;
        }
    }
}
