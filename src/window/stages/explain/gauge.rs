//! The error before and after as one bar on a logarithmic scale, with the noise floor.

use crate::display::format::in_words;
use crate::plots::error_map::Scale;
use crate::window::language::tr;
use crate::window::theme::{self, size};
use crate::window::widgets::UiExt;
use egui::{Align2, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

/// Errors to show, as shares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Gauge {
    /// Of the model as it is.
    pub before: f64,
    /// With the effect.
    pub after: f64,
    /// On runs that were left out of the fit; none where the fit is not finished.
    pub held_out: Option<f64>,
    /// What noise alone leaves.
    pub floor: f64,
}

impl Gauge {
    /// What stands under the bar: `error 14.4 % to 0.31 %` and `left-out runs 0.33 %   noise 0.31 %`.
    fn figures(&self) -> [String; 2] {
        let [before, after, floor] = [self.before, self.after, self.floor].map(in_words);
        match self.held_out.map(in_words) {
            Some(held) => [format!("error {before} to {after}"), format!("left-out runs {held}   noise {floor}")],
            None => [format!("error {before} to about {after}"), format!("noise {floor}")],
        }
    }

    /// The same in one line.
    pub(super) fn words(&self) -> String {
        self.figures().join(", ").replace("   ", ", ")
    }

    /// Shows the bar and its figures under it.
    pub(super) fn show(&self, ui: &mut Ui) {
        let palette = ui.palette();
        let font = theme::font(size::SMALL);
        let [left, right] = self.figures().map(tr);
        let width = |text: &str| ui.painter().layout_no_wrap(text.to_owned(), font.clone(), palette.ink).size().x;
        // The figures stand in one line where there is room for both.
        let beside = width(&left) + width(&right) + 12.0 <= ui.available_width();
        let height = if beside { 30.0 } else { 46.0 };
        let (area, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, tr(self.words())));
        let painter = ui.painter();
        let most = self.before.max(self.after);
        let scale = Scale::new(0.6 * self.floor.min(self.after).max(1e-3 * most), 1.3 * most);
        let bar = Rect::from_min_size(area.min + vec2(0.0, 3.0), vec2(area.width(), 8.0));
        let x = |value: f64| bar.left() + bar.width() * scale.share(value);
        painter.rect_filled(bar, 3.0, palette.raised);
        let (a, b) = (x(self.after.min(self.before)), x(most));
        let gain = Rect::from_min_max(pos2(a, bar.top()), pos2(b, bar.bottom()));
        let better = self.after <= self.before;
        let colour = if better { palette.missing } else { palette.warning };
        painter.rect_filled(gain, 2.0, colour.gamma_multiply(0.35));
        painter.rect_filled(
            Rect::from_min_max(pos2(bar.left(), bar.top()), pos2(x(self.after), bar.bottom())),
            3.0,
            colour,
        );
        let tick = |x: f64, colour, width| {
            let x = x as f32;
            painter.line_segment([pos2(x, bar.top() - 3.0), pos2(x, bar.bottom() + 3.0)], Stroke::new(width, colour));
        };
        tick(f64::from(x(self.floor)), palette.ink, 1.6);
        tick(f64::from(b), palette.weak, 1.2);
        let below = bar.bottom() + 4.0;
        painter.text(pos2(bar.left(), below), Align2::LEFT_TOP, left, font.clone(), palette.ink);
        if beside {
            painter.text(pos2(bar.right(), below), Align2::RIGHT_TOP, right, font, palette.weak);
        } else {
            painter.text(pos2(bar.left(), below + 16.0), Align2::LEFT_TOP, right, font, palette.weak);
        }
    }
}
