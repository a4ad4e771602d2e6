//! Corrections and scatter: what the data say of the model, of each channel and of each run, each with its deviation; what
//! the project has a number for is taken over one by one.

use super::cards;
use super::request::Request;
use super::scene::Scene;
use crate::diagnosis::Diagnosis;
use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::scatter::{ChannelScatter, Estimated, RunScatter, Scatter};
use crate::display::{findings, format};
use crate::session::corrections::adopt;
use crate::window::app::ask::Ask;
use crate::window::app::opened::Opened;
use crate::window::appearance::theme::{self, size, space};
use crate::window::appearance::widgets::{UiExt, folded};
use crate::window::language::{t, tf, tr};
use egui::{
    Align, Align2, CollapsingHeader, Color32, Layout, Painter, Rect, Role, ScrollArea, Sense, Shape, Ui, WidgetInfo,
    pos2, vec2,
};

/// Corrections of the model that are seen at once: those that stand out most.
const MOST: usize = 8;
/// Deviations at the ends of a bar.
const ENDS: f64 = 8.0;
/// Deviations from which on a value is no scatter.
const SEEN: f64 = 2.0;
/// Width of a bar with its zero in the middle, points.
const BAR: f32 = 84.0;
/// Width of a value with its deviation, points.
const VALUE: f32 = 128.0;
/// Width of the button that takes a value over, points.
const BUTTON: f32 = 72.0;

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, opened: &mut Opened<'_>, asks: &mut Vec<Ask>) {
    opened.view.explain.scatter_shown = true;
    let document = opened.document;
    let scene = Scene { document, explained: &opened.derived.explained };
    let Some(Ok(diagnosis)) = scene.explained.diagnosis(document) else {
        ui.empty("The search comes first", "What the data say of model, channels and runs follows when it has ended.");
        return;
    };
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        model(ui, &scene, diagnosis, asks);
        match scene.explained.scatter(document) {
            Some(Ok(scatter)) => {
                if let Some(scatter) = scatter.as_ref() {
                    channels(ui, scatter, asks);
                    if let Some(run) = runs(ui, scatter, opened.view.run) {
                        opened.view.run = run;
                    }
                }
            }
            Some(Err(error)) => drop(ui.hint(format!("Channels and runs: {error}"))),
            None => drop(ui.hint("Channels and runs are being looked at.")),
        }
    });
}

/// One line: what, how much, in deviations.
struct Row<'a> {
    name: &'a str,
    value: String,
    deviations: f64,
}

impl Row<'_> {
    /// Shows it; `button` is the name of what takes it over, enabled or not. True when that was clicked.
    fn show(&self, ui: &mut Ui, button: Option<(&str, bool)>) -> bool {
        let palette = ui.palette();
        let mut clicked = false;
        ui.horizontal(|ui| {
            let aside = VALUE + BAR + if button.is_some() { BUTTON } else { 0.0 } + 3.0 * ui.spacing().item_spacing.x;
            let room = (ui.available_width() - aside).max(60.0);
            let name = folded(ui, self.name, theme::font(size::BODY), palette.weak, room, 3);
            let size = vec2(room, space::ROW.max(name.size().y));
            let (area, response) = ui.allocate_exact_size(size, Sense::hover());
            let said = format!("{}: {}, {:.1} deviations", self.name, self.value, self.deviations);
            response.widget_info(|| WidgetInfo::labeled(Role::Label, true, tr(&said)));
            ui.painter().galley(area.left_center() - vec2(0.0, 0.5 * name.size().y), name, palette.weak);
            response.on_hover_text(tr(said));
            let (area, _) = ui.allocate_exact_size(vec2(VALUE, space::ROW), Sense::hover());
            ui.painter().text(
                area.right_center(),
                Align2::RIGHT_CENTER,
                tr(&self.value),
                theme::font(size::BODY),
                palette.ink,
            );
            bar(ui, self.deviations);
            if let Some((name, enabled)) = button {
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    let button = egui::Button::new(t!("Apply")).small();
                    let response = ui.add_enabled(enabled, button);
                    response.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, tf!("Apply: {name}")));
                    let none = "The project has no number for it.";
                    let tip = "Puts it into the project; undo takes it back.";
                    clicked = response.on_hover_text(tr(tip)).on_disabled_hover_text(tr(none)).clicked();
                });
            }
        });
        clicked
    }
}

/// A bar from the middle, in deviations, with marks where scatter ends.
fn bar(ui: &mut Ui, deviations: f64) {
    let palette = ui.palette();
    let (area, response) = ui.allocate_exact_size(vec2(BAR, space::ROW), Sense::hover());
    let track = Rect::from_center_size(area.center(), vec2(BAR, 8.0));
    let x = |d: f64| area.center().x + (0.5 * BAR) * ((d / ENDS).clamp(-1.0, 1.0) as f32);
    let painter = ui.painter();
    painter.rect_filled(track, 2.0, palette.raised);
    let scatter = Rect::from_x_y_ranges(x(-SEEN)..=x(SEEN), track.y_range());
    painter.rect_filled(scatter, 0.0, palette.line);
    let colour = if deviations.abs() > SEEN { palette.missing } else { palette.weak };
    let (low, high) = (x(deviations.min(0.0)), x(deviations.max(0.0)));
    painter.rect_filled(Rect::from_x_y_ranges(low..=high, track.shrink2(vec2(0.0, 1.0)).y_range()), 1.0, colour);
    let middle = area.center().x;
    painter
        .line_segment([pos2(middle, track.top() - 2.0), pos2(middle, track.bottom() + 2.0)], theme::hair(palette.weak));
    if deviations.abs() > ENDS {
        arrow(painter, track, deviations > 0.0, palette.canvas);
    }
    response.on_hover_text(tf!("{deviations:+.1} deviations; grey: ±{SEEN:.0}, ends: ±{ENDS:.0}"));
}

/// An arrow within the end of a bar that would go on: outside it would touch the figures beside it.
fn arrow(painter: &Painter, track: Rect, right: bool, colour: Color32) {
    let (end, back) = if right { (track.right() - 3.0, -3.0) } else { (track.left() + 3.0, 3.0) };
    let points = [-2.5, 0.0, 2.5].map(|y: f32| pos2(if y == 0.0 { end } else { end + back }, track.center().y + y));
    painter.add(Shape::line(points.into(), theme::pen(colour)));
}

fn percent(value: Estimated) -> String {
    format!("{} %", format::with_deviation(100.0 * value.value, 100.0 * value.deviation, ""))
}

/// Parts of the structure and known sources.
fn model(ui: &mut Ui, scene: &Scene<'_>, diagnosis: &Diagnosis, asks: &mut Vec<Ask>) {
    ui.title("The model", "best-fitting change ± one standard deviation; the bar counts deviations");
    if diagnosis.corrections.is_empty() {
        ui.hint("The search did not have to correct anything of it.");
        ui.add_space(space::S);
        return;
    }
    let telling = findings::telling(&diagnosis.corrections, MOST);
    let is_telling = |c: &Correction| telling.iter().any(|t| std::ptr::eq(*t, c));
    let all = || diagnosis.corrections.iter().enumerate();
    all().filter(|(_, c)| is_telling(c)).for_each(|(k, c)| correction(ui, scene, k, c, asks));
    let others = diagnosis.corrections.len() - telling.len();
    if others > 0 {
        let named = format!("{others} more, nearer to what the project states");
        CollapsingHeader::new(tr(named)).id_salt("other corrections").show(ui, |ui| {
            all().filter(|(_, c)| !is_telling(c)).for_each(|(k, c)| correction(ui, scene, k, c, asks));
        });
    }
    ui.add_space(space::S);
}

/// One correction, by its place in the list, with the button that takes it over.
fn correction(ui: &mut Ui, scene: &Scene<'_>, k: usize, correction: &Correction, asks: &mut Vec<Ask>) {
    let name = cards::corrected(scene, &correction.parameter);
    let deviations = (correction.factor - 1.0) / correction.deviation.max(f64::MIN_POSITIVE);
    let row = Row { name: &name, value: findings::change(correction), deviations };
    let adopted = adopt(std::slice::from_ref(correction), &scene.known(), scene.document.session().document());
    if row.show(ui, Some((&name, !adopted.commands.is_empty()))) {
        asks.push(Ask::Explain(Request::CorrectOne(k)));
    }
}

fn channels(ui: &mut Ui, scatter: &Scatter, asks: &mut Vec<Ask>) {
    ui.title("Each channel", "gain: reads too large; delay: recorded late");
    if scatter.channels.is_empty() {
        ui.hint("One response channel alone cannot be told from the force.");
    }
    for ChannelScatter { channel, gain, delay } in &scatter.channels {
        let name = format!("Gain of {channel}");
        let row = Row { name: &name, value: percent(*gain), deviations: gain.deviations() };
        if row.show(ui, Some((&name, true))) {
            asks.push(Ask::Explain(Request::CorrectSensor { channel: channel.clone(), gain: gain.value, delay: 0.0 }));
        }
        let Some(delay) = delay else { continue };
        let name = format!("Delay of {channel}");
        let value = format::with_deviation(1e6 * delay.value, 1e6 * delay.deviation, "µs");
        let row = Row { name: &name, value, deviations: delay.deviations() };
        if row.show(ui, Some((&name, true))) {
            asks.push(Ask::Explain(Request::CorrectSensor { channel: channel.clone(), gain: 0.0, delay: delay.value }));
        }
    }
    ui.add_space(space::S);
}

/// Shifts of the runs; the run that was clicked.
fn runs(ui: &mut Ui, scatter: &Scatter, selected: usize) -> Option<usize> {
    ui.title("Each run", "shift of all natural frequencies; a click selects the run");
    let mut chosen = None;
    for RunScatter { run, frequency, amplitude, phase } in &scatter.runs {
        let name = format!("Run {}", run + 1);
        let palette = ui.palette();
        let row = Row { name: &name, value: percent(*frequency), deviations: frequency.deviations() };
        let top = ui.cursor().min;
        row.show(ui, None);
        let area = Rect::from_min_max(top, pos2(ui.max_rect().right(), ui.cursor().min.y));
        let response = ui.interact(area, ui.scope_id().with(("run", *run)), Sense::click());
        response.widget_info(|| {
            WidgetInfo::selected(Role::Button, true, *run == selected, tf!("Scatter of run {}", run + 1))
        });
        if *run == selected {
            ui.painter().rect_stroke(area, 3.0, theme::hair(palette.accent), egui::StrokeKind::Inside);
        }
        let degrees = Estimated { value: phase.value.to_degrees(), deviation: phase.deviation.to_degrees() };
        let more = format!(
            "amplitude {}, phase {}",
            percent(*amplitude),
            format::with_deviation(degrees.value, degrees.deviation, "°")
        );
        if response.on_hover_text(tr(more)).clicked() {
            chosen = Some(*run);
        }
    }
    chosen
}
