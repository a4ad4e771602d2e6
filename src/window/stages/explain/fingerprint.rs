//! The fingerprint of a suggestion in its card.

use crate::diagnosis::candidates::fingerprint_plot::Print;
use crate::display::format;
use crate::plots::fingerprint::{figure, words};
use crate::window::appearance::theme::size;
use crate::window::appearance::widgets::UiExt;
use crate::window::language::tr;
use crate::window::plots::show::Stack;
use egui::Ui;

/// Shows the plot `height` points high; `name` is of the suggestion that it belongs to.
pub(super) fn show(ui: &mut Ui, print: &Print, name: &str, height: f32) {
    let palette = ui.palette();
    let (title, slope) = words(print);
    ui.horizontal_wrapped(|ui| {
        let at = print.at_frequency.map_or_else(String::new, |f| format!(" at {}", format::with_unit(f, "Hz")));
        ui.hint(format!("{title}{at}"));
        ui.label(egui::RichText::new(tr(slope)).size(size::SMALL).color(palette.missing).strong());
    });
    let figures = vec![(figure(print, palette), 1.0)];
    let title = format!("{name}: {title}");
    ui.allocate_ui(egui::vec2(ui.available_width(), height), |ui| {
        Stack { id: &title, title: &title, figures, keys: false }.show(ui);
    });
}
