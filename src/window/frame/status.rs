//! The status bar: what runs, the last message, what the project holds.

use crate::window::app::{App, Ask};
use crate::window::theme::Palette;
use crate::window::widgets::UiExt;
use crate::window::words;
use egui::{Align, Frame, Label, Layout, Margin, Panel, ProgressBar, RichText, Ui};

/// Shows the bar.
pub fn show(ui: &mut Ui, app: &App, asks: &mut Vec<Ask>) {
    let palette = Palette::of(ui.visuals());
    let bar = Frame::new().fill(palette.pane).inner_margin(Margin::symmetric(12, 4));
    Panel::bottom("status").frame(bar).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.set_min_height(22.0);
            left(ui, app, asks);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| summary(ui, app));
        });
    });
}

fn left(ui: &mut Ui, app: &App, asks: &mut Vec<Ask>) {
    let palette = ui.palette();
    if let Some((name, progress)) = app.running() {
        ui.add(ProgressBar::new(progress as f32).desired_width(120.0).desired_height(6.0).fill(palette.accent));
        ui.label(name);
        ui.separator();
    }
    if let Some(message) = &app.message {
        let colour = if message.failed { palette.error } else { palette.ink };
        let room = ui.available_width() - 420.0;
        let text = Label::new(RichText::new(&message.text).color(colour)).truncate();
        ui.scope(|ui| {
            ui.set_max_width(room.max(200.0));
            ui.add(text).on_hover_text(&message.text);
        });
        if ui.small_button("Copy").clicked() {
            ui.ctx().copy_text(message.text.clone());
        }
        if ui.small_button("Dismiss").clicked() {
            asks.push(Ask::Dismiss);
        }
    } else if app.running().is_none() {
        ui.hint("Ready");
    }
}

fn summary(ui: &mut Ui, app: &App) {
    let Some(document) = &app.document else { return };
    let p = &document.project;
    let used = p.runs.iter().filter(|r| r.enabled).count();
    let noise = p.runs.iter().filter(|r| r.enabled).map(|r| r.noise_ratio).fold(0.0, f64::max);
    let mut parts = vec![words::kind(p.structure.kind()).to_owned(), format!("{} DOFs", p.structure.len())];
    parts.push(format!("{used} of {} runs used", p.runs.len()));
    if noise > 0.0 {
        parts.push(format!("noise up to {}", crate::window::format::percent(noise)));
    }
    ui.hint(parts.join("   ·   "));
}
