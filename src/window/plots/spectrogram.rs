//! A spectrogram in its pane.

use super::export;
use crate::display::format;
use crate::plots::drawing::Drawing;
use crate::plots::spectrogram::Spectrogram;
use crate::window::language::tf;
use crate::window::widgets::UiExt;
use egui::{Pos2, Rect, Sense, Ui, Vec2, WidgetInfo, vec2};

/// Size on paper, points.
const PAPER: Vec2 = vec2(900.0, 480.0);

impl Spectrogram {
    /// Shows it as large as the room allows; `title` is that of the exported picture.
    pub fn show(&self, ui: &mut Ui, title: &str) {
        let (area, response) = ui.allocate_exact_size(ui.available_size(), Sense::click());
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, tf!("Spectrogram: {title}")));
        let mut drawing = Drawing::new(area.size(), ui.palette().canvas, title);
        let cells = self.draw_within(&mut drawing, Rect::from_min_size(Pos2::ZERO, area.size()), ui.palette());
        drawing.paint(&ui.painter_at(area), area.min);
        let pointer = response.hover_pos().map(|p| p - area.min.to_vec2());
        if let Some([time, frequency, level]) = pointer.and_then(|p| self.at(cells, p)) {
            let [time, frequency] = [(time, "s"), (frequency, "Hz")].map(|(x, unit)| format::with_unit(x, unit));
            response.clone().on_hover_text_at_pointer(tf!("{time}, {frequency}: {level:.0} dB"));
        }
        export::offer(ui, &[response], title, &|palette| self.draw(PAPER, title, palette), &|| self.table());
    }
}
