//! The error before and after as one bar on a logarithmic scale, with the noise floor.

use crate::display::format::in_words;
use crate::plots::error_map::Scale;
use crate::window::appearance::theme::{self, Palette, size};
use crate::window::appearance::widgets::{UiExt, width};
use crate::window::language::tr;
use egui::{Align2, Color32, Pos2, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

/// Strength of the colour between the error after it and the error now.
const PALE: f32 = 0.35;

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

/// What stands beside a figure: the part of the bar that it is.
#[derive(Debug, Clone, Copy)]
enum Key {
    Area(Color32),
    Tick(Color32),
    Nothing,
}

/// Room of a key with the gap behind it, between figures, and height of a row of them, points.
const KEY: f32 = 13.0;
const GAP: f32 = 12.0;
const ROW: f32 = 15.0;
/// Height of the bar with the room about it, points.
const BAR: f32 = 15.0;

impl Gauge {
    /// In one line: `error 14.4 % to 0.31 %, left-out runs 0.33 %, noise 0.31 %`.
    pub(super) fn words(&self) -> String {
        let [before, after, floor] = [self.before, self.after, self.floor].map(in_words);
        match self.held_out.map(in_words) {
            Some(held) => format!("error {before} to {after}, left-out runs {held}, noise {floor}"),
            None => format!("error {before} to about {after}, noise {floor}"),
        }
    }

    /// Colour of the error after it: a warning where it is worse.
    fn colour(&self, palette: &Palette) -> Color32 {
        if self.after <= self.before { palette.missing } else { palette.warning }
    }

    /// The figures under the bar, each with its key.
    fn figures(&self, palette: &Palette) -> Vec<(Key, String)> {
        let [before, after, floor] = [self.before, self.after, self.floor].map(in_words);
        let about = if self.held_out.is_some() { format!("with it {after}") } else { format!("with it about {after}") };
        let colour = self.colour(palette);
        let mut list = vec![
            (Key::Area(colour.gamma_multiply(PALE)), format!("error now {before}")),
            (Key::Area(colour), about),
            (Key::Tick(palette.ink), format!("noise {floor}")),
        ];
        list.extend(self.held_out.map(|held| (Key::Nothing, format!("left-out runs {}", in_words(held)))));
        list.into_iter().map(|(key, text)| (key, tr(text))).collect()
    }

    /// Shows the bar and its figures under it, in as many rows as they need.
    pub(super) fn show(&self, ui: &mut Ui) {
        let palette = ui.palette();
        let figures = self.figures(palette);
        let room = ui.available_width();
        let mut places = Vec::new();
        let mut at = vec2(0.0, 0.0);
        for (key, text) in &figures {
            let wide = key.room() + width(ui, text, theme::font(size::SMALL));
            if at.x > 0.0 && at.x + wide > room {
                at = vec2(0.0, at.y + ROW);
            }
            places.push(at);
            at.x += wide + GAP;
        }
        let (area, response) = ui.allocate_exact_size(vec2(room, BAR + at.y + ROW), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, tr(self.words())));
        self.bar(ui, Rect::from_min_size(area.min + vec2(0.0, 3.0), vec2(room, 8.0)));
        for ((key, text), at) in figures.into_iter().zip(places) {
            key.show(ui, area.min + at + vec2(0.0, BAR), text);
        }
    }

    /// From nothing to the error after it, pale from there to the error now, with a tick at the noise.
    fn bar(&self, ui: &Ui, bar: Rect) {
        let (palette, painter) = (ui.palette(), ui.painter());
        let most = self.before.max(self.after);
        let scale = Scale::new(0.6 * self.floor.min(self.after).max(1e-3 * most), 1.3 * most);
        let x = |value: f64| bar.left() + bar.width() * scale.share(value);
        let part = |from: f32, to: f32| Rect::from_x_y_ranges(from..=to, bar.y_range());
        let colour = self.colour(palette);
        painter.rect_filled(bar, 3.0, palette.raised);
        painter.rect_filled(part(x(self.after.min(self.before)), x(most)), 2.0, colour.gamma_multiply(PALE));
        painter.rect_filled(part(bar.left(), x(self.after)), 3.0, colour);
        let floor = x(self.floor);
        let ends = [pos2(floor, bar.top() - 3.0), pos2(floor, bar.bottom() + 3.0)];
        painter.line_segment(ends, Stroke::new(1.6, palette.ink));
    }
}

impl Key {
    fn room(self) -> f32 {
        if matches!(self, Self::Nothing) { 0.0 } else { KEY }
    }

    /// Shows it with its figure, which starts at `at`.
    fn show(self, ui: &Ui, at: Pos2, text: String) {
        let (palette, painter) = (ui.palette(), ui.painter());
        let middle = at + vec2(4.0, 0.5 * ROW);
        match self {
            Self::Area(colour) => {
                painter.rect_filled(Rect::from_center_size(middle, vec2(8.0, 8.0)), 1.5, colour);
            }
            Self::Tick(colour) => {
                let ends = [middle - vec2(0.0, 6.0), middle + vec2(0.0, 6.0)];
                painter.line_segment(ends, Stroke::new(1.6, colour));
            }
            Self::Nothing => {}
        }
        let ink = if matches!(self, Self::Nothing) { palette.weak } else { palette.ink };
        let left = at + vec2(self.room(), 0.5 * ROW);
        painter.text(left, Align2::LEFT_CENTER, text, theme::font(size::SMALL), ink);
    }
}
