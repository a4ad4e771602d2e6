//! Loops side by side in their pane.

use super::export;
use super::show::{Place, RULER, key_row};
use crate::display::words;
use crate::plots::figure::Figure;
use crate::plots::hysteresis::HysteresisPlot;
use crate::plots::sheet::{Panel, Sheet};
use crate::window::appearance::widgets::UiExt;
use crate::window::language::tr;
use egui::{Ui, vec2};

/// Least width of a loop, points.
const LEAST: f32 = 200.0;

/// Shows loops side by side, as many as there is room for.
pub(crate) fn show(ui: &mut Ui, title: &str, loops: &[HysteresisPlot]) {
    let palette = ui.palette();
    let figures: Vec<Figure> = loops.iter().map(|l| l.figure(palette)).collect();
    key_row(ui, figures.iter());
    let columns = ((ui.available_width() / LEAST) as usize).clamp(1, loops.len().max(1));
    let rows = loops.len().div_ceil(columns).clamp(1, 2);
    let room = ui.available_size();
    let size = vec2(room.x / columns as f32 - 8.0, (room.y / rows as f32 - 10.0).max(150.0));
    let (mut panels, mut responses) = (Vec::new(), Vec::new());
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for (k, (row, shown)) in loops.chunks(columns).zip(figures.chunks(columns)).enumerate() {
            ui.horizontal_top(|ui| {
                for (j, (one, figure)) in row.iter().zip(shown).enumerate() {
                    ui.allocate_ui(size, |ui| {
                        ui.vertical(|ui| {
                            ui.set_width(size.x);
                            ui.label(tr(words::capital(&one.name)));
                            ui.hint(format!("area {}", one.energies()));
                            let id = format!("loop {k} {j}");
                            let place = Place { id: &id, height: size.y - 48.0, group: None, ruler: RULER };
                            let figure = figure.clone().displayed();
                            let out = place.show(ui, &figure);
                            let (low, high) = (out.transform.bounds().min(), out.transform.bounds().max());
                            let bounds = [[low[0], high[0]], [low[1], high[1]]];
                            panels.push(Panel { figure, bounds });
                            responses.push(out.response);
                        });
                    });
                }
            });
        }
    });
    export::offer_sheet(ui, &responses, Sheet { title: title.to_owned(), columns, panels });
}
