//! The page of an import, in place of the panes.

use super::draft::{Decided, Draft};
use super::preview::Preview;
use super::state::Importing;
use super::{destination, mapping, places, tree};
use crate::window::app::ask::Ask;
use crate::window::appearance::theme::{Palette, space};
use crate::window::appearance::widgets::UiExt;
use crate::window::language::{numbers, t, tf, tr};
use crate::window::plots::show::Stack;
use egui::{CentralPanel, DragValue, Frame, Margin, Panel, ScrollArea, Ui, vec2};
use std::sync::Arc;

/// Share of the width that the tree takes, and its bounds, points.
const TREE: (f32, f32, f32) = (0.34, 300.0, 460.0);
/// Share of the height that the plot takes.
const PLOT: f32 = 0.36;

/// Shows the page.
pub fn show(ui: &mut Ui, importing: &mut Importing, asks: &mut Vec<Ask>) {
    let palette = Palette::of(ui.visuals());
    let (draft, busy) = match importing {
        Importing::Looking(_) => {
            let pane = Frame::new().fill(palette.pane).inner_margin(Margin::same(14));
            CentralPanel::default().frame(pane).show(ui, |ui| ui.empty("The files are being read", ""));
            return;
        }
        Importing::Ready(draft) => (draft, false),
        Importing::Making(draft, _) => (draft, true),
    };
    let pane = |margin| Frame::new().fill(palette.pane).inner_margin(margin);
    Panel::bottom("import foot").frame(pane(Margin::symmetric(14, 8))).show(ui, |ui| {
        ui.add_enabled_ui(!busy, |ui| {
            if let Some(action) = destination::show(ui, draft) {
                asks.push(Ask::Importing(action));
            }
        });
    });
    let width = (TREE.0 * ui.available_width()).clamp(TREE.1, TREE.2);
    let left = pane(Margin { left: 14, right: 6, top: 10, bottom: 4 });
    Panel::left("import tree").frame(left).resizable(false).exact_size(width).show(ui, |ui| {
        let count = draft.files.len();
        ui.title("Import measurements", if count == 1 { "1 file" } else { "" });
        if count > 1 {
            ui.hint(format!("{count} files"));
        }
        ui.add_space(space::XS);
        tree::show(ui, draft);
    });
    CentralPanel::default().frame(pane(Margin { left: 10, right: 14, top: 10, bottom: 4 })).show(ui, |ui| {
        let height = PLOT * ui.available_height();
        ui.allocate_ui(vec2(ui.available_width(), height), |ui| {
            ui.set_min_height(height);
            plot(ui, draft);
        });
        ui.add_space(space::S);
        ui.add_enabled_ui(!busy, |ui| decisions(ui, draft));
    });
}

/// The channel that was clicked last.
fn plot(ui: &mut Ui, draft: &mut Draft) {
    let Some(at) = draft.looked_at else { return ui.empty("Nothing to draw", "The files hold no values.") };
    let Ok(file) = &draft.files[at.0].file else { return };
    let set = &file.contents().sets[at.1];
    let channel = &set.channels[at.2];
    let name = if channel.name.trim().is_empty() { set.name.clone() } else { channel.name.clone() };
    let set_name = if set.name.is_empty() { String::new() } else { format!("{}, ", set.name) };
    ui.title(&name, &format!("{set_name}{}", set.kind.word()));
    let work = || {
        let file = Arc::clone(file);
        move |_: &crate::control::Control| Preview::of(&file, at.1, at.2)
    };
    match draft.preview.obtain(ui.ctx(), &at, work) {
        None => ui.empty("The channel is being read", ""),
        Some(Err(error)) => ui.empty("No picture", &error),
        Some(Ok(preview)) => {
            let id = format!("import {at:?}");
            Stack { id: &id, title: &name, figures: vec![(preview.figure(ui.palette()), 1.0)], keys: false }.show(ui);
        }
    }
}

/// What is decided of the measurements.
fn decisions(ui: &mut Ui, draft: &mut Draft) {
    let Draft { files, decided, request, needs_sampling, .. } = draft;
    match decided {
        Decided::Channels(rows) => {
            let used = rows.iter().filter(|row| row.used).count();
            ui.title("What the channels are", &format!("{used} of {} are imported", rows.len()));
            if *needs_sampling {
                sampling(ui, &mut request.sampling_hz);
            }
            let unit_of = |name: &str| {
                let all =
                    files.iter().filter_map(|file| file.file.as_ref().ok()).flat_map(|file| &file.contents().sets);
                let channel = all.flat_map(|set| &set.channels).find(|channel| channel.name == name);
                channel.map_or_else(String::new, |channel| channel.unit.clone())
            };
            mapping::show(ui, rows, unit_of);
        }
        Decided::Responses(responses) => {
            ui.title("Points of the frequency responses", &format!("{} functions", responses.count));
            places::show(ui, responses);
        }
        Decided::Stepped(words, assumed) => {
            ui.title("A stepped-sine test", "");
            ui.label(tr(words.as_str()));
            for what in assumed {
                ui.hint(format!("Assumed: {what}."));
            }
        }
        Decided::Nothing(why) => {
            ui.title("Nothing can be imported", "");
            ScrollArea::vertical().show(ui, |ui| ui.label(tr(why.as_str())));
        }
    }
}

/// The sampling rate of files that do not say it.
fn sampling(ui: &mut Ui, rate: &mut Option<f64>) {
    ui.horizontal(|ui| {
        let label = ui.hint("The files do not say the time between samples. Sampling rate");
        let mut hertz = rate.unwrap_or(0.0);
        let drag = DragValue::new(&mut hertz)
            .range(0.0..=1e9)
            .speed(1.0)
            .custom_formatter(|value, _| if value > 0.0 { tf!("{value} Hz") } else { t!("give it").to_owned() })
            .custom_parser(numbers::typed);
        ui.add(drag).labelled_by(label.id);
        *rate = (hertz > 0.0).then_some(hertz);
    });
}
