//! A symmetric matrix as a heat map with its numbers.

use crate::window::format;
use crate::window::theme::{self, size};
use crate::window::widgets::UiExt;
use egui::{Align2, Rect, Sense, StrokeKind, Ui, WidgetInfo, pos2, vec2};
use faer::Mat;

/// A matrix with the labels of its rows.
#[derive(Debug, Clone, Copy)]
pub struct HeatMap<'a> {
    /// Values.
    pub matrix: &'a Mat<f64>,
    /// Rows shown.
    pub rows: &'a [usize],
    /// Label of every row of the matrix.
    pub labels: &'a [String],
    /// Unit of the values.
    pub unit: &'a str,
}

/// Rows with an entry that is not zero.
pub fn occupied(matrix: &Mat<f64>) -> Vec<usize> {
    (0..matrix.nrows()).filter(|&i| (0..matrix.ncols()).any(|j| matrix[(i, j)] != 0.0)).collect()
}

const LABEL: f32 = 30.0;

impl HeatMap<'_> {
    /// Shows it as large as the room allows.
    pub fn show(&self, ui: &mut Ui) {
        let palette = ui.palette();
        let n = self.rows.len().max(1) as f32;
        let room = ui.available_size() - vec2(LABEL, LABEL + 4.0);
        let cell = (room.x / n).min(room.y / n).clamp(4.0, 92.0);
        let (area, response) = ui.allocate_exact_size(vec2(LABEL + n * cell, LABEL + n * cell), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, self.words()));
        let origin = area.min + vec2(LABEL, LABEL);
        let largest = self.rows.iter().flat_map(|&i| self.rows.iter().map(move |&j| self.matrix[(i, j)].abs()));
        let largest = largest.fold(f64::MIN_POSITIVE, f64::max);
        let painter = ui.painter();
        let font = theme::font(size::SMALL.min(0.30 * cell + 2.0));
        let label_font = theme::font(size::SMALL.min(0.8 * cell).max(6.0));
        for (r, &i) in self.rows.iter().enumerate() {
            let (x, y) = (origin.x + (r as f32 + 0.5) * cell, origin.y + (r as f32 + 0.5) * cell);
            let label = &self.labels[i];
            painter.text(pos2(x, origin.y - 8.0), Align2::CENTER_BOTTOM, label, label_font.clone(), palette.weak);
            painter.text(pos2(origin.x - 8.0, y), Align2::RIGHT_CENTER, label, label_font.clone(), palette.weak);
            for (c, &j) in self.rows.iter().enumerate() {
                let value = self.matrix[(i, j)];
                let at = origin + vec2(c as f32 * cell, r as f32 * cell);
                let rect = Rect::from_min_size(at, vec2(cell, cell)).shrink(0.5);
                let fill = if value == 0.0 { palette.raised } else { palette.diverging((value / largest) as f32) };
                painter.rect_filled(rect, 1.5, fill);
                if cell >= 30.0 && value != 0.0 {
                    let text = format::significant(value, 3);
                    painter.text(rect.center(), Align2::CENTER_CENTER, text, font.clone(), palette.text_on(fill));
                }
            }
        }
        painter.rect_stroke(
            Rect::from_min_size(origin, vec2(n * cell, n * cell)),
            2.0,
            theme::hair(palette.line),
            StrokeKind::Outside,
        );
        if let Some(pointer) = response.hover_pos() {
            let at = ((pointer - origin) / cell).floor();
            let row = |v: f32| (v >= 0.0).then_some(v as usize).and_then(|k| self.rows.get(k).copied());
            if let (Some(j), Some(i)) = (row(at.x), row(at.y)) {
                let value = format::with_unit(self.matrix[(i, j)], self.unit);
                response.on_hover_text_at_pointer(format!("({}, {})  {value}", self.labels[i], self.labels[j]));
            }
        }
    }

    /// All values that are not zero, row by row, for screen readers and tests.
    fn words(&self) -> String {
        let mut text = String::from("Matrix");
        for &i in self.rows {
            for &j in self.rows {
                if self.matrix[(i, j)] != 0.0 && text.len() < 4000 {
                    text.push_str(&format!(
                        "; {} {} {}",
                        self.labels[i],
                        self.labels[j],
                        format::significant(self.matrix[(i, j)], 3)
                    ));
                }
            }
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::occupied;
    use faer::Mat;

    #[test]
    fn rows_without_entries_are_left_out() {
        let mut m = Mat::<f64>::zeros(4, 4);
        m[(1, 3)] = 2.0;
        m[(3, 1)] = 2.0;
        assert_eq!(occupied(&m), [1, 3]);
    }
}
