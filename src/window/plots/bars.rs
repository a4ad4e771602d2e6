//! Horizontal bars with a name at the left and a figure at the right: shares of energy.

use super::drawing::Drawing;
use super::export;
use crate::window::format;
use crate::window::theme::{self, Palette, size, space};
use crate::window::widgets::UiExt;
use egui::{Align2, Color32, Rect, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

/// One bar.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// At the left.
    pub name: String,
    /// Share from 0 to 1.
    pub share: f64,
    /// Colour.
    pub colour: Color32,
}

/// Shows bars under each other, all to the scale of the largest; `title` is that of the exported picture.
pub fn show(ui: &mut Ui, title: &str, bars: &[Bar], name_width: f32) {
    let mut responses = Vec::new();
    let palette = ui.palette();
    let largest = bars.iter().map(|b| b.share.abs()).fold(f64::MIN_POSITIVE, f64::max);
    for bar in bars {
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), space::ROW - 3.0), Sense::click());
        let figure = format::percent(bar.share);
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, format!("{}: {figure}", bar.name)));
        let painter = ui.painter();
        let middle = rect.center().y;
        painter.text(pos2(rect.left(), middle), Align2::LEFT_CENTER, &bar.name, theme::font(size::BODY), palette.ink);
        painter.text(pos2(rect.right(), middle), Align2::RIGHT_CENTER, figure, theme::font(size::BODY), palette.ink);
        let track =
            Rect::from_min_max(pos2(rect.left() + name_width, middle - 6.0), pos2(rect.right() - 64.0, middle + 6.0));
        painter.rect_filled(track, 2.0, palette.raised);
        let width = track.width() * (bar.share.abs() / largest) as f32;
        painter.rect_filled(Rect::from_min_size(track.min, vec2(width.max(1.0), track.height())), 2.0, bar.colour);
        responses.push(response);
    }
    export::offer(ui, &responses, title, &|palette| draw(bars, title, name_width, palette), &|| table(bars));
}

/// The same on paper.
fn draw(bars: &[Bar], title: &str, name_width: f32, palette: &Palette) -> Drawing {
    let size = vec2(720.0, 56.0 + space::ROW * bars.len() as f32);
    let mut drawing = Drawing::new(size, palette.canvas, title);
    drawing.words(pos2(16.0, 20.0), Align2::LEFT_CENTER, title, size::HEADING, palette.ink);
    let largest = bars.iter().map(|b| b.share.abs()).fold(f64::MIN_POSITIVE, f64::max);
    for (k, bar) in bars.iter().enumerate() {
        let y = 52.0 + space::ROW * k as f32;
        let (left, right) = (16.0 + name_width, size.x - 90.0);
        drawing.words(pos2(16.0, y), Align2::LEFT_CENTER, bar.name.clone(), size::BODY, palette.ink);
        let figure = format::percent(bar.share);
        drawing.words(pos2(size.x - 16.0, y), Align2::RIGHT_CENTER, figure, size::BODY, palette.ink);
        let end = left + (right - left) * (bar.share.abs() / largest) as f32;
        let rect = Rect::from_min_max(pos2(left, y - 6.0), pos2(end.max(left + 1.0), y + 6.0));
        drawing.rect(rect, bar.colour, Stroke::NONE);
    }
    drawing
}

fn table(bars: &[Bar]) -> String {
    bars.iter().fold("name\tshare, %\n".to_owned(), |text, b| text + &format!("{}\t{:e}\n", b.name, 100.0 * b.share))
}
