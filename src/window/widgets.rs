//! What all panes are made of, as one extension of `egui::Ui`.

use super::theme::{self, Palette, size, space};
use egui::{
    Align, Color32, CornerRadius, Frame, Label, Layout, Margin, Response, RichText, Sense, Ui, WidgetText, vec2,
};

/// The program's own widgets.
pub trait UiExt {
    /// Colours of the theme in force.
    fn palette(&self) -> &'static Palette;
    /// Title of a pane with a second-rank remark beside it.
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
    /// A pane with padding on the colour of panes.
    fn pane<R>(&mut self, content: impl FnOnce(&mut Ui) -> R) -> R;
    /// The button that a pane is about.
    fn primary(&mut self, text: &str) -> Response;
    /// A short line and a name: the key to a curve.
    fn key(&mut self, colour: Color32, name: &str);
}

impl UiExt for Ui {
    fn palette(&self) -> &'static Palette {
        Palette::of(self.visuals())
    }

    fn title(&mut self, title: &str, remark: &str) {
        self.horizontal(|ui| {
            ui.label(RichText::new(title).size(size::HEADING).color(ui.palette().ink));
            if !remark.is_empty() {
                ui.add(Label::new(RichText::new(remark).size(size::SMALL).color(ui.palette().weak)).truncate());
            }
        });
    }

    fn hint(&mut self, text: impl Into<String>) -> Response {
        let colour = self.palette().weak;
        self.label(RichText::new(text).size(size::SMALL).color(colour))
    }

    fn pair(&mut self, name: &str, value: impl Into<String>) {
        self.horizontal(|ui| {
            let weak = ui.palette().weak;
            ui.label(RichText::new(name).color(weak));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.add(Label::new(value.into()).truncate());
            });
        });
    }

    fn number(&mut self, text: impl Into<String>) -> Response {
        self.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(space::XS);
            ui.add(Label::new(WidgetText::from(text.into())).selectable(false))
        })
        .inner
    }

    fn pill(&mut self, text: &str, colour: Color32) -> Response {
        Frame::new()
            .fill(colour.gamma_multiply(0.16))
            .corner_radius(CornerRadius::same(4))
            .inner_margin(Margin::symmetric(6, 1))
            .show(self, |ui| ui.add(Label::new(RichText::new(text).size(size::SMALL).color(colour)).selectable(false)))
            .inner
    }

    fn empty(&mut self, title: &str, what_next: &str) {
        let height = self.available_height();
        self.vertical_centered(|ui| {
            ui.add_space((0.38 * height - 20.0).max(0.0));
            ui.label(RichText::new(title).size(size::HEADING).color(ui.palette().ink));
            ui.hint(what_next);
        });
    }

    fn pane<R>(&mut self, content: impl FnOnce(&mut Ui) -> R) -> R {
        let fill = self.palette().pane;
        Frame::new()
            .fill(fill)
            .corner_radius(CornerRadius::same(6))
            .inner_margin(Margin::symmetric(12, 10))
            .show(self, content)
            .inner
    }

    fn primary(&mut self, text: &str) -> Response {
        let p = self.palette();
        let text = RichText::new(text).color(p.text_on(p.accent));
        self.add(egui::Button::new(text).fill(p.accent).stroke(theme::hair(p.accent)))
    }

    fn key(&mut self, colour: Color32, name: &str) {
        let (rect, _) = self.allocate_exact_size(vec2(16.0, 12.0), Sense::hover());
        self.painter().line_segment([rect.left_center(), rect.right_center()], theme::bold(colour));
        self.hint(name);
    }
}
