//! One suggestion: symbol, law and place, size, probability, error before and after, evidence, fingerprint, buttons.

use super::gauge::Gauge;
use super::request::Request;
use super::scene::Scene;
use super::{fingerprint, force};
use crate::diagnosis::result::Suggestion;
use crate::display::findings;
use crate::display::format::{self, chance};
use crate::effects::{Place, Source};
use crate::window::app::Ask;
use crate::window::appearance::theme::{self, size, space};
use crate::window::appearance::widgets::{UiExt, folded, width};
use crate::window::explained::Standing;
use crate::window::language::{t, tr};
use crate::window::schematic::symbols;
use egui::text::{Galley, LayoutJob, TextFormat};
use egui::{
    Align2, Color32, CornerRadius, Frame, Label, Margin, Pos2, Rect, RichText, Role, Sense, StrokeKind, Ui, Vec2,
    WidgetInfo, pos2, vec2,
};
use std::sync::Arc;

/// Height of the fingerprint plot.
const PLOT: f32 = 150.0;

/// Room between symbol and name, and that of the probability at the right, points.
const BESIDE: f32 = 10.0;
const CHANCE: f32 = 66.0;

/// The words in the head of a card.
struct HeadWords {
    title: Arc<Galley>,
    /// What the law is, under its name.
    under: Option<Arc<Galley>>,
    /// The error after it, at the right.
    error: Option<String>,
}

impl HeadWords {
    /// Height of all lines, points.
    fn total(&self) -> f32 {
        self.title.size().y + self.under.as_ref().map_or(0.0, |u| u.size().y)
    }

    /// Paints the lines about a middle at their left.
    fn paint(&self, ui: &Ui, middle: Pos2, ink: Color32) {
        let top = middle - vec2(0.0, 0.5 * self.total());
        ui.painter().galley_with_override_text_color(top, self.title.clone(), ink);
        if let Some(under) = &self.under {
            ui.painter().galley(top + vec2(0.0, self.title.size().y), under.clone(), ink);
        }
    }
}

/// A suggestion to show.
pub(super) struct Card<'a> {
    /// Document and results.
    pub scene: &'a Scene<'a>,
    /// This one.
    pub suggestion: &'a Suggestion,
    /// Probability among what is not ruled out.
    pub probability: f64,
    /// Place in the ranking, from 1.
    pub rank: usize,
    /// Whether all of it is shown.
    pub unfolded: bool,
    /// How far it may be trusted.
    pub standing: Standing,
}

impl Card<'_> {
    fn is_provisional(&self) -> bool {
        self.standing == Standing::Provisional
    }

    /// Shows it; true when its head was clicked.
    pub(super) fn show(&self, ui: &mut Ui, on_trial: bool, asks: &mut Vec<Ask>) -> bool {
        let palette = ui.palette();
        let line = if on_trial { palette.missing } else { palette.line };
        Frame::new()
            .fill(palette.canvas)
            .stroke(theme::hair(line))
            .corner_radius(CornerRadius::same(6))
            .inner_margin(Margin::symmetric(10, 6))
            .show(ui, |ui| {
                let clicked = self.head(ui);
                if self.unfolded {
                    self.body(ui, on_trial, asks);
                }
                clicked
            })
            .inner
    }

    fn title(&self) -> String {
        name(self.scene, &self.suggestion.added.source)
    }

    /// Symbol, name, probability; for folded cards the error after it too.
    fn head(&self, ui: &mut Ui) -> bool {
        let palette = ui.palette();
        let source = &self.suggestion.added.source;
        let words = self.head_words(ui);
        let height = (words.total() + 6.0).max(if self.unfolded { 40.0 } else { 34.0 });
        let (area, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click());
        let (so_far, chance) = (self.is_provisional(), chance(self.probability));
        let (kind, about) = if so_far { ("Provisional suggestion", "about ") } else { ("Suggestion", "") };
        let label = format!("{kind} {}: {}, probability {about}{chance}", self.rank, self.title());
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, self.unfolded, tr(&label)));
        let painter = ui.painter();
        let symbol = Rect::from_min_size(area.min, vec2(self.symbol_width(), height));
        glyph(ui, source, symbol);
        let ink = if response.hovered() || response.has_focus() { palette.accent } else { palette.ink };
        let left = symbol.right() + BESIDE;
        let middle = area.center().y;
        words.paint(ui, pos2(left, middle), ink);
        let weight = if so_far { palette.weak } else { palette.ink };
        let under = if so_far { "so far" } else { "probability" };
        if self.unfolded {
            painter.text(
                pos2(area.right(), middle - 8.0),
                Align2::RIGHT_CENTER,
                tr(chance),
                theme::font(size::HEADING + 2.0),
                weight,
            );
            painter.text(
                pos2(area.right(), middle + 10.0),
                Align2::RIGHT_CENTER,
                tr(under),
                theme::font(size::SMALL),
                palette.weak,
            );
        } else {
            painter.text(pos2(area.right(), middle), Align2::RIGHT_CENTER, tr(chance), theme::font(size::BODY), weight);
            if let Some(after) = words.error {
                let at = pos2(area.right() - CHANCE, middle);
                painter.text(at, Align2::RIGHT_CENTER, tr(after), theme::font(size::SMALL), palette.weak);
            }
        }
        response.on_hover_text(tr(label)).clicked()
    }

    /// The words of the head in the room beside symbol and probability; long names stand on several lines.
    fn head_words(&self, ui: &Ui) -> HeadWords {
        let palette = ui.palette();
        let room = ui.available_width() - self.symbol_width() - BESIDE - CHANCE;
        if self.unfolded {
            let law = self.suggestion.added.source.effect.sentence();
            let law = law.split(':').next().unwrap_or_default().trim_end_matches('.');
            let title = folded(ui, &self.title(), theme::font(size::HEADING), palette.ink, room, 3);
            let under = folded(ui, law, theme::font(size::SMALL), palette.weak, room, 3);
            return HeadWords { title, under: Some(under), error: None };
        }
        // The error after it goes before the name is broken too often.
        let error = (room > 250.0).then(|| format!("error {}", format::percent(self.suggestion.error_after)));
        let taken = error.as_ref().map_or(0.0, |e| width(ui, e, theme::font(size::SMALL)) + 8.0);
        let title = folded(ui, &self.title(), theme::font(size::BODY), palette.ink, room - taken, 3);
        HeadWords { title, under: None, error }
    }

    fn symbol_width(&self) -> f32 {
        if self.unfolded { 62.0 } else { 46.0 }
    }

    /// What explains the data as well: effects as simple are a warning, those with more parameters only not needed.
    fn alternatives(&self, ui: &mut Ui) {
        let own = self.suggestion.added.source.parameters.len();
        let all = self.suggestion.indistinguishable_from.iter();
        let (needless, equal): (Vec<&Source>, Vec<&Source>) = all.partition(|o| o.parameters.len() > own);
        let [warning, weak] = [ui.palette().warning, ui.palette().weak];
        let mut say = |what: &str, list: &[&Source], colour| {
            if !list.is_empty() {
                let names: Vec<String> = list.iter().map(|o| name(self.scene, o)).collect();
                let text = format!("{what}: {}.", names.join("; "));
                ui.label(RichText::new(tr(text)).size(size::BODY - 1.0).color(colour));
            }
        };
        say("These data cannot tell it from", &equal, warning);
        say("No better, with more parameters", &needless, weak);
    }

    fn body(&self, ui: &mut Ui, on_trial: bool, asks: &mut Vec<Ask>) {
        let s = self.suggestion;
        self.sizes(ui);
        let ([before, floor], after) = (self.errors(), s.error_after);
        let held_out = (!self.is_provisional()).then_some(s.held_out_error_after);
        Gauge { before, after, held_out, floor }.show(ui);
        self.buttons(ui, on_trial, asks);
        if self.is_provisional() {
            ui.hint("Left-out runs, alternatives and fingerprint follow when the search has ended.");
            return;
        }
        self.alternatives(ui);
        force::show(ui, self.scene, Some(&s.added.source));
        self.fingerprint(ui);
        for sentence in &s.evidence {
            ui.label(RichText::new(tr(findings::evidence(sentence, &s.added))).size(size::BODY - 1.0));
        }
    }

    /// Error of the model as it is and noise floor, as shares.
    fn errors(&self) -> [f64; 2] {
        let (document, explained) = (self.scene.document, self.scene.explained);
        let found = || explained.diagnosis(document).and_then(|d| d.as_ref().ok());
        // Those that stand elsewhere on the screen: a search predicts with other numbers of harmonics.
        let compared = explained.comparison(document).and_then(|c| c.as_ref().ok()).map(|c| [c.error, c.noise_floor]);
        let told = || found().map(|d| [d.error_before, d.noise_floor]);
        compared.or_else(told).unwrap_or([self.suggestion.error_after, 0.0])
    }

    fn fingerprint(&self, ui: &mut Ui) {
        let source = &self.suggestion.added.source;
        match self.scene.explained.print(self.scene.document, source) {
            Some(Ok(print)) => {
                if let Some(print) = print.as_ref() {
                    fingerprint::show(ui, print, &self.title(), PLOT);
                }
            }
            Some(Err(error)) => drop(ui.hint(format!("No fingerprint: {error}"))),
            None if matches!(source.place, Place::Whole(_)) || self.scene.document.project.runs.is_empty() => {}
            None if self.standing == Standing::Final => drop(ui.hint("The fingerprint is being computed.")),
            None => drop(ui.hint("The fingerprint follows when the search has ended.")),
        }
    }

    /// Parameters with deviation and unit, side by side.
    fn sizes(&self, ui: &mut Ui) {
        let added = &self.suggestion.added;
        ui.horizontal_wrapped(|ui| {
            for (k, parameter) in added.source.effect.parameters().iter().enumerate() {
                let (Some(value), Some(deviation)) = (added.source.parameters.get(k), added.deviations.get(k)) else {
                    continue;
                };
                // Name and value stay together where the row wraps.
                let mut text = LayoutJob::default();
                let palette = ui.palette();
                let mut say = |words: &str, colour| {
                    text.append(&tr(words), 0.0, TextFormat::simple(theme::font(size::BODY), colour));
                };
                say(&format!("{}  ", parameter.name.replace('_', " ")), palette.weak);
                say(&format::with_deviation(*value, *deviation, parameter.unit), palette.ink);
                ui.add(Label::new(text).extend());
                ui.add_space(space::S);
            }
        });
    }

    fn buttons(&self, ui: &mut Ui, on_trial: bool, asks: &mut Vec<Ask>) {
        let source = &self.suggestion.added.source;
        ui.horizontal_wrapped(|ui| {
            let tip = "Shows the map and the curves as they would be; nothing is saved.";
            if ui.add(egui::Button::new(t!("Try")).selected(on_trial)).on_hover_text(tr(tip)).clicked() {
                asks.push(Ask::Explain(if on_trial { Request::Stop } else { Request::Try(source.clone()) }));
            }
            let tip = "Puts the effect into the model as known; undo takes it back.";
            let wait = "Its size is not final: it can be added when the search has ended. Try shows what it would do.";
            let add = ui.add_enabled_ui(!self.is_provisional(), |ui| ui.primary("Add")).inner;
            if add.on_hover_text(tr(tip)).on_disabled_hover_text(tr(wait)).clicked() {
                asks.push(Ask::Explain(Request::Add(source.clone())));
            }
            let tip = "Rules this effect out at this place and searches for what else it could be; undo takes it back.";
            if ui.button(t!("Not this")).on_hover_text(tr(tip)).clicked() {
                asks.push(Ask::Explain(Request::Exclude(source.clone())));
            }
        });
    }
}

/// `Coulomb friction at DOF 15`.
pub(super) fn name(scene: &Scene<'_>, source: &Source) -> String {
    source.title(&scene.document.project.structure)
}

/// The symbol of an effect between its ends, with the ground where it is held there.
fn glyph(ui: &Ui, source: &Source, area: Rect) {
    let palette = ui.palette();
    let painter = ui.painter();
    painter.rect(area, 4.0, palette.pane, theme::hair(palette.line), StrokeKind::Inside);
    let stroke = theme::pen(palette.missing);
    let ground = matches!(&source.place, Place::Dofs(dofs) if dofs.len() == 1);
    let (left, right) =
        (area.left_center() + vec2(5.0, 0.0), area.right_center() - vec2(if ground { 10.0 } else { 5.0 }, 0.0));
    symbols::draw(painter, source.effect, [left, right], stroke);
    if ground {
        symbols::ground(painter, right, Vec2::RIGHT, 0.55 * area.height(), theme::hair(palette.missing));
    }
}
