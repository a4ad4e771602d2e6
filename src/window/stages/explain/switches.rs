//! What is chosen of the map and of the cell: in the bars of their panes, where there is room beside the titles, so that
//! maps and plots have the height; else in the panes.

use super::look::{Look, RecordTab, Tab};
use crate::window::appearance::theme::{self, size, space};
use crate::window::appearance::widgets::width;
use crate::window::language::tr;
use egui::Ui;

/// Room of a title beside its words, points.
const BESIDE_TITLE: f32 = 30.0;

/// Shows the switches of the map (0) or of the cell (1) in the bar of their pane, from right to left, where they have room
/// beside its `title`; the pane is told. `records` tells that the cell shows a record that is not steady.
pub(crate) fn in_bar(ui: &mut Ui, place: usize, title: &str, look: &mut Look, records: bool) {
    let names: Vec<&str> = match (place, records) {
        (0, _) => ORDERS.map(|(_, label, _)| label).into(),
        (_, false) => Tab::ALL.map(Tab::label).into(),
        (_, true) => RecordTab::ALL.map(RecordTab::label).into(),
    };
    let title = width(ui, title, theme::font(size::BODY)) + BESIDE_TITLE;
    look.in_bar[place] = needed(ui, &names) + title <= ui.available_width();
    if look.in_bar[place] {
        ui.add_space(space::S);
        match (place, records) {
            (0, _) => order(ui, look),
            (_, false) => tabs(ui, look),
            (_, true) => record_tabs(ui, look),
        }
    }
}

/// Room that switches of those names take, points.
fn needed(ui: &Ui, names: &[&str]) -> f32 {
    let rim = 2.0 * ui.spacing().button_padding.x + 2.0;
    names.iter().map(|name| width(ui, name, theme::font(size::BODY)) + rim).sum::<f32>() + space::S
}

/// A value with the name of its switch and what it shows.
type Choice<T> = (T, &'static str, &'static str);

/// Orders of the map.
const ORDERS: [Choice<bool>; 2] = [
    (true, "Worst first", "Runs and channels in order of their error."),
    (false, "In order", "Runs and channels in the order of the project."),
];

/// The order of the map, from right to left.
pub(crate) fn order(ui: &mut Ui, look: &mut Look) {
    choose(ui, &mut look.worst_first, ORDERS);
}

/// The plots of the cell, from right to left.
pub(crate) fn tabs(ui: &mut Ui, look: &mut Look) {
    choose(ui, &mut look.tab, Tab::ALL.map(|tab| (tab, tab.label(), tab.tooltip())));
}

/// The plots of a record that is not steady, from right to left.
pub(crate) fn record_tabs(ui: &mut Ui, look: &mut Look) {
    choose(ui, &mut look.record_tab, RecordTab::ALL.map(|tab| (tab, tab.label(), tab.tooltip())));
}

/// Switches of which one is set, the last at the right.
fn choose<T: Copy + PartialEq, const N: usize>(ui: &mut Ui, chosen: &mut T, choices: [Choice<T>; N]) {
    ui.spacing_mut().item_spacing.x = 2.0;
    for (value, label, tooltip) in choices.into_iter().rev() {
        if ui.selectable_label(*chosen == value, tr(label)).on_hover_text(tr(tooltip)).clicked() {
            *chosen = value;
        }
    }
}
