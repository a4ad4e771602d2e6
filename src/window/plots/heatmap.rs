//! A heat map in its pane.

use super::export;
use crate::display::format;
use crate::plots::drawing::Drawing;
use crate::plots::heatmap::HeatMap;
use crate::window::language::{tf, tr};
use crate::window::widgets::UiExt;
use egui::{Pos2, Rect, Sense, Ui, WidgetInfo};

impl HeatMap<'_> {
    /// Shows it as large as the room allows; `title` is that of the exported picture.
    pub fn show(&self, ui: &mut Ui, title: &str) {
        let (area, response) = ui.allocate_exact_size(ui.available_size(), Sense::click());
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, tr(self.words())));
        let mut drawing = Drawing::new(area.size(), ui.palette().canvas, title);
        let cells = self.draw(&mut drawing, Rect::from_min_size(Pos2::ZERO, area.size()), ui.palette());
        drawing.paint(&ui.painter_at(area), area.min);
        if let Some(pointer) = response.hover_pos()
            && let Some([i, j]) = self.at(cells, pointer - area.min.to_vec2())
        {
            let value = format::with_unit(self.matrix[(i, j)], self.unit);
            response.clone().on_hover_text_at_pointer(tf!("({}, {})  {value}", self.labels[i], self.labels[j]));
        }
        export::offer(ui, &[response], title, &|palette| self.paper(title, palette), &|| self.table());
    }
}
