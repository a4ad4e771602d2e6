//! A spectrogram in its pane.

use super::cell_map::{CellMap, Field};
use super::export;
use crate::display::format;
use crate::plots::drawing::Drawing;
use crate::plots::figure::{Axis, Figure};
use crate::plots::spectrogram::Spectrogram;
use crate::window::appearance::widgets::UiExt;
use crate::window::language::tf;
use egui::{Pos2, Rect, Sense, Ui, Vec2, WidgetInfo, vec2};

/// Size on paper, points.
const PAPER: Vec2 = vec2(900.0, 480.0);

impl Spectrogram {
    /// Shows it as large as the room allows; `title` is that of the exported picture.
    pub fn show(&self, ui: &mut Ui, title: &str) {
        let figure = Figure::new(title, Axis::new("Time", "s"), Axis::new("Frequency", "Hz")).displayed();
        let range = self.range_hz.map(|hz| figure.y.factor * hz);
        let field = Field { whole: [self.time_s, range], count: self.count(), down: false };
        let map = CellMap::begin(ui.ctx(), title, &figure, field);
        let shown = self.part(map.in_sight());
        let (area, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, tf!("Spectrogram: {title}")));
        let mut drawing = Drawing::new(area.size(), ui.palette().canvas, title);
        let cells = shown.draw_within(&mut drawing, Rect::from_min_size(Pos2::ZERO, area.size()), ui.palette());
        drawing.paint(&ui.painter_at(area), area.min);
        let pointer = response.hover_pos().map(|p| p - area.min.to_vec2());
        if let Some([time, frequency, level]) = pointer.and_then(|p| shown.at(cells, p)) {
            let [time, frequency] = [(time, "s"), (frequency, "Hz")].map(|(x, unit)| format::with_unit(x, unit));
            response.clone().on_hover_text_at_pointer(tf!("{time}, {frequency}: {level:.0} dB"));
        }
        let level = |[column, row]: [usize; 2]| self.decibels.get(column)?.get(row).copied();
        map.end(ui, &response, cells.translate(area.min.to_vec2()), Axis::new("Level", "dB"), &level);
        export::offer(ui, &[response], title, &|palette| shown.draw(PAPER, title, palette), &|| self.table());
    }
}
