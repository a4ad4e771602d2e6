//! The status bar: what runs and how to stop it, the last message, the error now and the noise under it.

use crate::display::{format, words};
use crate::identify::Outcome;
use crate::window::app::commands::Command;
use crate::window::app::view::Stage;
use crate::window::app::{App, Ask};
use crate::window::appearance::theme::{Palette, size};
use crate::window::appearance::widgets::UiExt;
use crate::window::document::Document;
use crate::window::language::{t, tr};
use egui::{Align, Button, Frame, Layout, Margin, Panel, ProgressBar, RichText, Ui};

/// Shows the bar.
pub(crate) fn show(ui: &mut Ui, app: &App, asks: &mut Vec<Ask>) {
    let palette = Palette::of(ui.visuals());
    let bar = Frame::new().fill(palette.pane).inner_margin(Margin::symmetric(12, 4));
    Panel::bottom("status").frame(bar).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.set_min_height(22.0);
            running(ui, app, asks);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                summary(ui, app);
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| message(ui, app, asks));
            });
        });
    });
}

fn running(ui: &mut Ui, app: &App, asks: &mut Vec<Ask>) {
    let Some((name, progress)) = app.running() else { return };
    let palette = ui.palette();
    ui.add(ProgressBar::new(progress as f32).desired_width(110.0).desired_height(6.0).fill(palette.accent));
    ui.label(tr(name));
    if ui.button(t!("Cancel")).on_hover_text(tr(Command::Cancel.entry().tooltip)).clicked() {
        asks.push(Ask::Command(Command::Cancel));
    }
    ui.separator();
}

/// The last message; a click lists all.
fn message(ui: &mut Ui, app: &App, asks: &mut Vec<Ask>) {
    let palette = ui.palette();
    let Some(message) = app.messages.last() else {
        if app.running().is_none() {
            ui.hint("Ready");
        }
        return;
    };
    let colour = if message.failed { palette.error } else { palette.weak };
    if ui.button(t!("Copy")).on_hover_text(t!("Copies the last message.")).clicked() {
        ui.ctx().copy_text(message.text.clone());
    }
    let text = RichText::new(tr(&message.text)).size(size::SMALL).color(colour);
    let line = Button::new(text).frame(false).truncate();
    if ui.add(line).on_hover_text(t!("Click to list all messages.")).clicked() {
        asks.push(Ask::Command(Command::Messages));
    }
}

/// Error of the accepted set and what the noise alone would leave, both relative to the measured energy.
pub(crate) fn error_and_floor(outcome: &Outcome) -> (f64, f64) {
    let square =
        |f: &dyn Fn(&crate::identify::RunOutcome) -> f64| outcome.runs.iter().map(|r| f(r).powi(2)).sum::<f64>();
    let measured = square(&|r| r.input_energy).max(f64::MIN_POSITIVE);
    (outcome.accepted_step().relative_error, (square(&|r| r.energy_deviation) / measured).sqrt())
}

/// What the stage is about, each error with the noise floor that belongs to it: the error of the motion and its floor at the stage
/// Explain, as in all its panes; those of the energy balance elsewhere, which are other figures of the same records.
fn errors(app: &App, document: &Document) -> Vec<String> {
    let said = |error: String, floor: f64| {
        let floor = (floor > 0.0).then(|| format!("noise floor {}", format::percent(floor)));
        std::iter::once(error).chain(floor).collect()
    };
    if app.view.stage == Stage::Explain {
        let Some(Ok(c)) = app.derived.explained.comparison(document) else { return Vec::new() };
        return said(format!("error {}", format::in_words(c.error)), c.noise_floor);
    }
    let Some(Ok(outcome)) = app.derived.known_outcome(document) else { return Vec::new() };
    let (error, floor) = error_and_floor(&outcome);
    said(format!("energy error {}", format::percent(error)), floor)
}

fn summary(ui: &mut Ui, app: &App) {
    let Some(document) = &app.document else { return };
    let p = &document.project;
    let used = p.runs.iter().filter(|r| r.enabled).count();
    let mut parts = errors(app, document);
    if !p.runs.is_empty() || p.transient_runs.is_empty() {
        parts.push(format!("{used} of {} runs", p.runs.len()));
    }
    if !p.transient_runs.is_empty() {
        let used = p.transient_runs.iter().filter(|r| r.enabled).count();
        parts.push(format!("{used} of {} records over time", p.transient_runs.len()));
    }
    let kind = words::kind(p.structure.kind());
    parts.push(match p.structure.len() {
        1 => format!("{kind}, 1 DOF"),
        count => format!("{kind}, {count} DOFs"),
    });
    ui.hint(parts.join("   ·   "));
}
