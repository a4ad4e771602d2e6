//! What all panes are made of, as one extension of `egui::Ui`. All take English words and show them in the language of the window.

use crate::display::{format, glossary, units};
use crate::window::appearance::theme::{self, Palette, size, space};
use crate::window::language::{numbers, tr};
use egui::text::{Galley, LayoutJob, TextWrapping};
use egui::{
    Align, Color32, ComboBox, CornerRadius, DragValue, FontId, Frame, Label, Layout, Margin, Pos2, Response, RichText,
    Ui, WidgetText, vec2,
};
use std::sync::Arc;

/// Width of a value that can be edited, points.
const VALUE: f32 = 92.0;
/// Width of its unit, points.
const UNIT: f32 = 36.0;
/// Width below which a name stands above its value, points.
const NARROW: f32 = 264.0;

/// A name at the left that leaves `rest` points of the row.
fn name_left(ui: &mut Ui, name: &str, rest: f32) -> Response {
    if ui.layout().is_vertical() {
        return ui.hint(name);
    }
    let weak = ui.palette().weak;
    let room = vec2((ui.available_width() - rest - space::S).max(20.0), space::ROW);
    let label = Label::new(RichText::new(tr(name)).color(weak)).selectable(false).wrap();
    ui.allocate_ui_with_layout(room, Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_width(room.x);
        explained(ui.add(label), glossary::meaning(name))
    })
    .inner
}

/// With its meaning under the pointer, where it is a term.
pub(crate) fn explained(response: Response, meaning: Option<&str>) -> Response {
    match meaning {
        Some(meaning) => response.on_hover_text(tr(meaning)),
        None => response,
    }
}

/// Paints a line of words that starts at `left` (its middle) and ends with dots where it is wider than `room`; gives back
/// its width.
pub(crate) fn elided(ui: &Ui, text: &str, font: FontId, colour: Color32, left: Pos2, room: f32) -> f32 {
    let mut job = LayoutJob::simple_singleline(tr(text), font, colour);
    job.wrap = TextWrapping::truncate_at_width(room.max(8.0));
    let galley = ui.painter().layout_job(job);
    let width = galley.size().x;
    ui.painter().galley(left - vec2(0.0, 0.5 * galley.size().y), galley, colour);
    width
}

/// A name in `room` points: where it is wider, dots stand for what is in its middle, for names of one series differ at their ends.
pub(crate) fn shortened(ui: &Ui, name: &str, font: FontId, room: f32) -> String {
    let letters: Vec<char> = name.chars().collect();
    let kept = |n: usize| {
        let head: String = letters[..n / 3].iter().collect();
        let tail: String = letters[letters.len() - (n - n / 3)..].iter().collect();
        format!("{head}…{tail}")
    };
    let fits =
        |text: &str| ui.painter().layout_no_wrap(text.to_owned(), font.clone(), Color32::PLACEHOLDER).size().x <= room;
    if fits(name) {
        return name.to_owned();
    }
    let [mut least, mut most] = [0, letters.len()];
    while most - least > 1 {
        let n = usize::midpoint(least, most);
        if fits(&kept(n)) { least = n } else { most = n }
    }
    kept(least)
}

/// Words of one colour in at most `rows` lines of `room` points; dots where they are longer still.
pub(crate) fn folded(ui: &Ui, text: &str, font: FontId, colour: Color32, room: f32, rows: usize) -> Arc<Galley> {
    let mut job = LayoutJob::simple(tr(text), font, colour, room.max(8.0));
    job.wrap.max_rows = rows;
    ui.painter().layout_job(job)
}

/// Width of words on one line, points.
pub(crate) fn width(ui: &Ui, text: &str, font: FontId) -> f32 {
    ui.painter().layout_no_wrap(tr(text), font, Color32::PLACEHOLDER).size().x
}

/// The program's own widgets.
pub(crate) trait UiExt {
    /// Colours of the theme in force.
    fn palette(&self) -> &'static Palette;
    /// Title of a pane with a second-rank remark beside it, or under it where there is no room.
    fn title(&mut self, title: &str, remark: &str);
    /// Second-rank text of small size.
    fn hint(&mut self, text: impl Into<String>) -> Response;
    /// A name at the left and a value at the right of a row.
    fn pair(&mut self, name: &str, value: impl Into<String>);
    /// A number at the right end of its cell.
    fn number(&mut self, text: impl Into<String>) -> Response;
    /// A word on a tinted ground.
    fn pill(&mut self, text: &str, colour: Color32) -> Response;
    /// A title, a sentence on what to do next, in the middle of an empty pane.
    fn empty(&mut self, title: &str, what_next: &str);
    /// The button that a pane is about.
    fn primary(&mut self, text: &str) -> Response;
    /// A name at the left and a value with its unit that can be edited at the right; the new value once it is meant:
    /// after a drag or when the text is left, so that one gesture is one change.
    fn quantity(&mut self, name: &str, value: f64, unit: &str) -> Option<f64>;
    /// A choice among few words; the new one when another is chosen.
    fn choice<T: Copy + PartialEq>(&mut self, name: &str, now: T, all: &[T], word: fn(T) -> &'static str) -> Option<T>;
    /// A name and its value beside each other, or where there is little room above each other.
    fn beside<R>(&mut self, content: impl FnOnce(&mut Ui) -> R) -> R;
}

impl UiExt for Ui {
    fn palette(&self) -> &'static Palette {
        Palette::of(self.visuals())
    }

    fn title(&mut self, title: &str, remark: &str) {
        let [own, beside] =
            [(title, size::HEADING), (remark, size::SMALL)].map(|(t, s)| width(self, t, theme::font(s)));
        // A remark that is longer than the room beside the title stands under it; in a row there is no such place.
        let below = self.layout().is_vertical() && own + beside + space::S > self.available_width();
        self.horizontal(|ui| {
            let label = ui.label(RichText::new(tr(title)).size(size::HEADING).color(ui.palette().ink));
            explained(label, glossary::meaning(title));
            if !remark.is_empty() && !below {
                ui.add(Label::new(RichText::new(tr(remark)).size(size::SMALL).color(ui.palette().weak)).truncate());
            }
        });
        if below && !remark.is_empty() {
            self.hint(remark);
        }
    }

    fn hint(&mut self, text: impl Into<String>) -> Response {
        let colour = self.palette().weak;
        let text: String = text.into();
        let meaning = glossary::meaning(&text);
        let response = self.label(RichText::new(tr(text)).size(size::SMALL).color(colour));
        explained(response, meaning)
    }

    fn pair(&mut self, name: &str, value: impl Into<String>) {
        let (value, weak) = (tr(value.into()), self.palette().weak);
        let (room, gap) = (self.available_width(), space::S);
        let [name_width, value_width] = [name, value.as_str()].map(|text| width(self, text, theme::font(size::BODY)));
        let meaning = glossary::meaning(name);
        let name = Label::new(RichText::new(tr(name)).color(weak)).wrap();
        if name_width + gap + value_width <= room || value_width < 0.4 * room {
            self.horizontal(|ui| {
                let left = vec2(room - value_width - gap, space::ROW);
                ui.allocate_ui_with_layout(left, Layout::left_to_right(Align::Center), |ui| {
                    explained(ui.add(name), meaning)
                });
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.add(Label::new(value).extend()));
            });
            return;
        }
        // A long value stands under its name.
        explained(self.add(name), meaning);
        self.with_layout(Layout::top_down(Align::Max), |ui| ui.add(Label::new(value).wrap()));
    }

    fn number(&mut self, text: impl Into<String>) -> Response {
        self.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(space::XS);
            ui.add(Label::new(WidgetText::from(tr(text.into()))).selectable(false))
        })
        .inner
    }

    fn pill(&mut self, text: &str, colour: Color32) -> Response {
        Frame::new()
            .fill(colour.gamma_multiply(0.16))
            .corner_radius(CornerRadius::same(4))
            .inner_margin(Margin::symmetric(6, 1))
            .show(self, |ui| {
                ui.add(Label::new(RichText::new(tr(text)).size(size::SMALL).color(colour)).selectable(false))
            })
            .inner
    }

    fn empty(&mut self, title: &str, what_next: &str) {
        let height = self.available_height();
        self.vertical_centered(|ui| {
            ui.add_space((0.38 * height - 20.0).max(0.0));
            ui.label(RichText::new(tr(title)).size(size::HEADING).color(ui.palette().ink));
            ui.hint(what_next);
        });
    }

    fn primary(&mut self, text: &str) -> Response {
        let p = self.palette();
        let text = RichText::new(tr(text)).color(p.text_on(p.accent));
        self.add(egui::Button::new(text).fill(p.accent).stroke(theme::hair(p.accent)))
    }

    fn quantity(&mut self, name: &str, value: f64, unit: &str) -> Option<f64> {
        let (factor, unit) = units::shown(unit);
        // Without the last digits of the conversion, which nobody has typed.
        let value = if factor == 1.0 { value } else { format::rounded(factor * value) };
        let unit = format::pretty_unit(&unit);
        let key = self.make_persistent_id(("quantity", name));
        let mut shown = self.data(|d| d.get_temp::<f64>(key)).unwrap_or(value);
        let response = self.beside(|ui| {
            let label = name_left(ui, name, VALUE + UNIT + 2.0 * space::S);
            let drag = DragValue::new(&mut shown)
                .speed((0.005 * value.abs()).max(1e-6))
                .custom_formatter(|v, _| numbers::editable(v))
                .custom_parser(numbers::typed);
            ui.horizontal(|ui| {
                let response = ui.add_sized(vec2(VALUE, 22.0), drag).labelled_by(label.id);
                ui.hint(&unit);
                response
            })
            .inner
        });
        if response.dragged() || response.has_focus() {
            self.data_mut(|d| d.insert_temp(key, shown));
            return None;
        }
        self.data_mut(|d| d.remove_temp::<f64>(key));
        // What was looked at with fewer digits than it has was not changed.
        let changed = format::editable(shown) != format::editable(value);
        (changed && shown.is_finite()).then_some(shown / factor)
    }

    fn choice<T: Copy + PartialEq>(&mut self, name: &str, now: T, all: &[T], word: fn(T) -> &'static str) -> Option<T> {
        let mut chosen = now;
        self.beside(|ui| {
            let width = VALUE + UNIT + space::S;
            let label = name_left(ui, name, width + space::S);
            ComboBox::from_id_salt(("choice", name))
                .selected_text(tr(word(now)))
                .width(width)
                .show_ui(ui, |ui| {
                    for &one in all {
                        ui.selectable_value(&mut chosen, one, tr(word(one)));
                    }
                })
                .response
                .labelled_by(label.id);
        });
        (chosen != now).then_some(chosen)
    }

    fn beside<R>(&mut self, content: impl FnOnce(&mut Ui) -> R) -> R {
        if self.available_width() < NARROW { self.vertical(content).inner } else { self.horizontal(content).inner }
    }
}
