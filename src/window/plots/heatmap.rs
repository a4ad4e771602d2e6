//! A heat map in its pane.

use super::cell_map::{CellMap, Field};
use super::export;
use crate::display::format;
use crate::plots::drawing::Drawing;
use crate::plots::figure::{Axis, Figure, Ticks};
use crate::plots::heatmap::HeatMap;
use crate::window::appearance::widgets::UiExt;
use crate::window::language::{tf, tr};
use egui::{Pos2, Rect, Sense, Ui, WidgetInfo};

impl HeatMap<'_> {
    /// Shows it as large as the room allows; `title` is that of the exported picture.
    pub fn show(&self, ui: &mut Ui, title: &str) {
        let figure = self.axes(title);
        let map = CellMap::begin(ui.ctx(), title, &figure, Field::table(self.columns.len(), self.rows.len()));
        let [columns, rows] = map.in_sight();
        // The colours of a part mean what they mean in the whole.
        let shown = HeatMap {
            rows: &self.rows[rows.clone()],
            columns: &self.columns[columns.clone()],
            scale: Some(self.largest()),
            ..*self
        };
        let (area, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, tr(self.words())));
        let mut drawing = Drawing::new(area.size(), ui.palette().canvas, title);
        let cells = shown.draw(&mut drawing, Rect::from_min_size(Pos2::ZERO, area.size()), ui.palette());
        drawing.paint(&ui.painter_at(area), area.min);
        if let Some(pointer) = response.hover_pos()
            && let Some([i, j]) = shown.at(cells, pointer - area.min.to_vec2())
        {
            let value = format::with_unit(self.matrix[(i, j)], self.unit);
            response.clone().on_hover_text_at_pointer(tf!("({}, {})  {value}", self.labels[i], self.labels[j]));
        }
        let value = |[column, row]: [usize; 2]| Some(self.matrix[(*self.rows.get(row)?, *self.columns.get(column)?)]);
        let ground = cells.area(columns.len(), rows.len()).translate(area.min.to_vec2());
        map.end(ui, &response, ground, Axis::new("Value", &format::pretty_unit(self.unit)), &value);
        export::offer(ui, &[response], title, &|palette| shown.paper(title, palette), &|| self.table());
    }

    /// Its columns and rows as axes with names.
    fn axes(&self, title: &str) -> Figure {
        let axis = |name: &str, list: &[usize]| {
            let names: Vec<String> = list.iter().map(|&k| self.labels[k].clone()).collect();
            Axis::new(name, "").ticks(Ticks::Names(names.into()))
        };
        Figure::new(title, axis("Column", self.columns), axis("Row", self.rows))
    }
}
