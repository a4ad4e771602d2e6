//! Horizontal bars in their pane.

use super::export;
use crate::display::format;
use crate::plots::bars::{Bar, draw, table};
use crate::window::appearance::theme::{self, size, space};
use crate::window::appearance::widgets::{UiExt, elided, width};
use crate::window::language::{tf, tr};
use egui::{Align2, Rect, Sense, Ui, WidgetInfo, pos2, vec2};

/// Shows bars under each other, each filled by its share of the whole; names have `name_width` points or more;
/// `title` is that of the exported picture.
pub(crate) fn show(ui: &mut Ui, title: &str, bars: &[Bar], name_width: f32) {
    let mut responses = Vec::new();
    let palette = ui.palette();
    // The longest name decides, where there is room for it.
    let longest =
        bars.iter().map(|b| width(ui, &b.name, theme::font(size::BODY)) + space::S).fold(name_width, f32::max);
    for bar in bars {
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), space::ROW - 3.0), Sense::click());
        let figure = format::percent(bar.share);
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, tf!("{}: {figure}", bar.name)));
        let painter = ui.painter();
        let middle = rect.center().y;
        let name_width = longest.min(0.45 * rect.width());
        elided(ui, &bar.name, theme::font(size::BODY), palette.ink, rect.left_center(), name_width - space::S);
        painter.text(
            pos2(rect.right(), middle),
            Align2::RIGHT_CENTER,
            tr(figure),
            theme::font(size::BODY),
            palette.ink,
        );
        let track =
            Rect::from_min_max(pos2(rect.left() + name_width, middle - 6.0), pos2(rect.right() - 64.0, middle + 6.0));
        painter.rect_filled(track, 2.0, palette.raised);
        let filled = track.width() * bar.filled();
        painter.rect_filled(Rect::from_min_size(track.min, vec2(filled.max(1.0), track.height())), 2.0, bar.colour);
        responses.push(response);
    }
    export::offer(ui, &responses, title, &|palette| draw(bars, title, longest, palette), &|| table(bars));
}
