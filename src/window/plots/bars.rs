//! Horizontal bars with a name at the left and a figure at the right: shares of energy.

use crate::window::format;
use crate::window::theme::{self, size, space};
use crate::window::widgets::UiExt;
use egui::{Align2, Color32, Rect, Sense, Ui, WidgetInfo, pos2, vec2};

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

/// Shows bars under each other, all to the scale of the largest.
pub fn show(ui: &mut Ui, bars: &[Bar], name_width: f32) {
    let palette = ui.palette();
    let largest = bars.iter().map(|b| b.share.abs()).fold(f64::MIN_POSITIVE, f64::max);
    for bar in bars {
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), space::ROW - 3.0), Sense::hover());
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
    }
}
