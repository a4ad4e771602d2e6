//! Measure: the runs with what is wrong with them, the record with its fit, the spectrum.

use super::run_table::{Key, Order, common_folder, file_name};
use super::unsteady::{self, FOLLOWS};
use crate::display::{format, words};
use crate::exchange::Project;
use crate::measurement::{Quantity, Run};
use crate::plots::record::RecordPlot;
use crate::plots::{overview, samples};
use crate::window::app::ask::Ask;
use crate::window::app::commands::Command;
use crate::window::app::opened::Opened;
use crate::window::app::view::View;
use crate::window::appearance::theme::{self, space};
use crate::window::appearance::widgets::{UiExt, width};
use crate::window::background::cache::CANCELLED;
use crate::window::background::derived::Derived;
use crate::window::document::Document;
use crate::window::document::edits::Edit;
use crate::window::document::prepared_records::PreparedRecord;
use crate::window::language::{t, tf, tr};
use crate::window::plots::show::Stack;
use crate::window::plots::{charts, record};
use egui::{Sense, Ui};
use egui_extras::{Column, TableBuilder, TableRow};

/// Channels that have a button each; more stand in a list that opens.
const MOST_BUTTONS: usize = 8;

/// Widths of the columns of the table of runs, points; flags as words or as their number.
const LEAST_FILE: f32 = 72.0;
const FREQUENCY: f32 = 72.0;
const LEVEL: f32 = 42.0;
const NOISE: f32 = 62.0;
const HARMONICS: f32 = 68.0;
/// Widest column of flags.
const FLAGS: f32 = 180.0;
const FLAG_COUNT: f32 = 44.0;
/// Room about the words of a flag.
const PILL: f32 = 28.0;

/// Which columns there is room for: harmonics go first, then the words of the flags, then the noise.
#[derive(Debug, Clone, Copy)]
struct Shown {
    noise: bool,
    harmonics: bool,
    words: bool,
    /// Width of the column of flags.
    flags: f32,
}

impl Shown {
    /// In a table of `width` points whose longest flags take `longest`, and their head `head`.
    fn new(width: f32, levels: bool, [longest, head]: [f32; 2]) -> Self {
        let least = head.max(FLAG_COUNT);
        let always = 30.0 + LEAST_FILE + FREQUENCY + least + if levels { LEVEL } else { 0.0 } + 7.0 * space::XS;
        let room = width - always;
        let more = (longest.min(FLAGS) - least).max(0.0);
        let words = room > NOISE + more;
        let flags = if words { least + more } else { least };
        Self { noise: room > NOISE, words, harmonics: room > NOISE + more + HARMONICS, flags }
    }

    /// Whether a column is shown.
    fn has(self, key: Key) -> bool {
        match key {
            Key::Noise => self.noise,
            Key::Harmonics => self.harmonics,
            _ => true,
        }
    }
}

const EMPTY: [&str; 2] =
    ["No runs yet", "Import files of measurements of any of the formats, or drop them on this window."];

/// The table of runs.
pub(crate) fn runs(ui: &mut Ui, p: &Project, view: &mut View, asks: &mut Vec<Ask>) {
    if p.runs.is_empty() && !p.transient_runs.is_empty() {
        let ticked = unsteady::table(ui, p, &mut view.run);
        asks.extend(ticked.map(|(file, used)| Ask::Edit(Edit::UseRun(file, used))));
        return;
    }
    if p.runs.is_empty() {
        ui.empty(EMPTY[0], EMPTY[1]);
        ui.add_space(space::S);
        ui.vertical_centered(|ui| {
            if ui.primary(Command::Import.entry().label).clicked() {
                asks.push(Ask::Command(Command::Import));
            }
        });
        return;
    }
    let mut order = std::mem::take(&mut view.runs);
    let rows = order.rows(p, distortion);
    order.field(ui, p, rows.len());
    let mut chosen = view.run;
    table(ui, p, &rows, &mut order, &mut chosen, asks);
    (view.run, view.runs) = (chosen, order);
}

/// Amplitude and phase of a channel of all runs over frequency, one curve a level.
pub(crate) fn overview(ui: &mut Ui, p: &Project, view: &mut View) {
    let Some((run, channel)) = looked_at(p, view) else { return ui.empty("No runs yet", FOLLOWS) };
    let (mut chosen, mut every) = (channel, false);
    motions(ui, &p.runs[run], &mut chosen, &mut every);
    view.channel = chosen;
    let Some(name) = samples::selected(p, run, chosen) else {
        ui.empty("No motion", "The selected run measures forces only.");
        return;
    };
    let Some(fit) = p.runs[run].fit.channels.iter().find(|c| c.channel.to_string() == name) else { return };
    let figures = overview::figures(p, &fit.channel, run, ui.palette());
    if figures.is_empty() {
        ui.empty("No force", "No run with this channel has a force to divide by.");
        return;
    }
    let title = format!("{name} over the force, all runs");
    Stack { id: &title, title: &title, figures, keys: true }.show(ui);
}

/// The record of a channel with the fitted curve on top and the residual under it.
pub(crate) fn record(ui: &mut Ui, opened: &mut Opened<'_>) {
    let Some((run, channel)) = looked_at(&opened.document.project, opened.view) else {
        return unsteady::over_time(ui, opened);
    };
    let document = opened.document;
    let r = &document.project.runs[run];
    let mut chosen = channel;
    let mut every = opened.view.every_channel;
    channels(ui, r, &mut chosen, &mut every);
    (opened.view.channel, opened.view.every_channel) = (chosen, every);
    if every {
        lanes(ui, opened.derived, document, run);
        return;
    }
    let Some(fit) = r.fit.channels.get(channel) else { return };
    match opened.derived.trace(ui.ctx(), document, run, channel) {
        PreparedRecord::Absent => amplitudes(ui, r, channel),
        PreparedRecord::Coming => ui.empty("The record is being prepared", ""),
        PreparedRecord::Cancelled => ui.empty("There is no record to show", CANCELLED),
        PreparedRecord::Ready(trace) => {
            let axis = words::axis(fit.channel.quantity, false);
            let id = format!("run {} {}", run + 1, fit.channel);
            RecordPlot { trace: &trace, fit: &trace.fit, omega: r.fit.omega, axis, id: &id }.show(ui);
        }
    }
}

/// All channels of a run under each other on one axis of time.
fn lanes(ui: &mut Ui, derived: &mut Derived, document: &Document, run: usize) {
    let r = &document.project.runs[run];
    let mut shown = Vec::new();
    for (k, fit) in r.fit.channels.iter().enumerate() {
        match derived.trace(ui.ctx(), document, run, k) {
            PreparedRecord::Ready(trace) => shown.push((fit, trace)),
            PreparedRecord::Absent => {}
            PreparedRecord::Coming => return ui.empty("The records are being prepared", ""),
            PreparedRecord::Cancelled => return ui.empty("There are no records to show", CANCELLED),
        }
    }
    if shown.is_empty() {
        ui.empty("No time records", "This run came as fitted harmonics.");
        return;
    }
    record::lanes(ui, run, &shown, r.fit.omega);
}

/// The amplitude spectrum of the same channel.
pub(crate) fn spectrum(ui: &mut Ui, opened: &mut Opened<'_>) {
    let Some((run, channel)) = looked_at(&opened.document.project, opened.view) else {
        return unsteady::over_frequency(ui, opened);
    };
    let document = opened.document;
    let r = &document.project.runs[run];
    let Some(fit) = r.fit.channels.get(channel) else { return };
    let trace = match opened.derived.trace(ui.ctx(), document, run, channel) {
        PreparedRecord::Absent => return ui.empty("No spectrum", "This run came as fitted harmonics."),
        PreparedRecord::Coming => return ui.empty("The spectrum is being prepared", ""),
        PreparedRecord::Cancelled => return ui.empty("There is no spectrum to show", CANCELLED),
        PreparedRecord::Ready(trace) => trace,
    };
    let unit = words::axis(fit.channel.quantity, false).rsplit(", ").next().unwrap_or("");
    match &trace.spectrum {
        Some(s) => {
            charts::spectrum(
                ui,
                &format!("spectrum, run {} {}", run + 1, fit.channel),
                s,
                &trace.fit,
                r.fit.omega,
                unit,
            );
        }
        None => ui.empty("No spectrum", "The record is too short for one."),
    }
}

/// The run and the channel that are looked at, where there is any.
fn looked_at(p: &Project, view: &mut View) -> Option<(usize, usize)> {
    let runs = &p.runs;
    view.run = view.run.min(runs.len().checked_sub(1)?);
    view.channel = view.channel.min(runs[view.run].fit.channels.len().checked_sub(1)?);
    Some((view.run, view.channel))
}

/// The motions of a run; of many, a list.
fn motions(ui: &mut Ui, run: &Run, channel: &mut usize, every: &mut bool) {
    let all = run.fit.channels.iter().enumerate().filter(|(_, c)| c.channel.quantity != Quantity::Force);
    let list: Vec<(usize, String)> = all.map(|(k, c)| (k, c.channel.to_string())).collect();
    if list.iter().all(|(k, _)| k != channel) {
        *channel = list.first().map_or(*channel, |(k, _)| *k);
    }
    if list.len() <= MOST_BUTTONS && in_one_row(ui, list.iter().map(|(_, name)| name.as_str())) {
        ui.horizontal(|ui| {
            for (k, name) in &list {
                if ui.selectable_label(k == channel, name).clicked() {
                    (*channel, *every) = (*k, false);
                }
            }
        });
        return;
    }
    pick(ui, &list, channel, every);
}

/// Whether buttons of these names fit beside each other.
fn in_one_row<'a>(ui: &Ui, names: impl Iterator<Item = &'a str>) -> bool {
    let spacing = ui.spacing();
    let rim = 2.0 * spacing.button_padding.x + spacing.item_spacing.x;
    let total: f32 = names.map(|name| width(ui, name, theme::font(theme::size::BODY)) + rim).sum();
    total <= ui.available_width()
}

/// A list of channels that opens.
fn pick(ui: &mut Ui, list: &[(usize, String)], channel: &mut usize, every: &mut bool) {
    let now = list.iter().find(|(k, _)| k == channel).map_or("", |(_, name)| name.as_str());
    let combo = egui::ComboBox::from_id_salt("channel").selected_text(now).show_ui(ui, |ui| {
        for (k, name) in list {
            if ui.selectable_label(k == channel, name).clicked() {
                (*channel, *every) = (*k, false);
            }
        }
    });
    combo.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, t!("Channel")));
}

fn channels(ui: &mut Ui, run: &Run, channel: &mut usize, every: &mut bool) {
    let names: Vec<String> = run.fit.channels.iter().map(|c| c.channel.to_string()).collect();
    let as_list = names.len() > MOST_BUTTONS || !in_one_row(ui, names.iter().map(String::as_str).chain(["All"]));
    ui.horizontal(|ui| {
        if ui.selectable_label(*every, t!("All")).on_hover_text(t!("All channels on one axis of time.")).clicked() {
            *every = true;
        }
        if as_list {
            let list: Vec<(usize, String)> = names.into_iter().enumerate().collect();
            return pick(ui, &list, channel, every);
        }
        for (k, name) in names.into_iter().enumerate() {
            if ui.selectable_label(!*every && k == *channel, name).clicked() {
                (*channel, *every) = (k, false);
            }
        }
    });
}

fn table(ui: &mut Ui, p: &Project, rows: &[usize], order: &mut Order, chosen: &mut usize, asks: &mut Vec<Ask>) {
    ui.style_mut().interaction.selectable_labels = false;
    let levels = p.runs.iter().any(|r| r.level.is_some());
    ui.spacing_mut().item_spacing.x = space::XS;
    let flags = p.runs.iter().filter_map(flags).map(|text| width(ui, &text, theme::font(theme::size::SMALL)) + PILL);
    let head = width(ui, "Flags", theme::font(theme::size::SMALL)) + 2.0 * space::S;
    let shown = Shown::new(ui.available_width(), levels, [flags.fold(0.0, f32::max), head]);
    let folder = common_folder(p);
    TableBuilder::new(ui)
        .striped(true)
        .sense(Sense::click())
        .cell_layout(egui::Layout::left_to_right(egui::Align::Center))
        .column(Column::exact(30.0))
        .column(Column::remainder().at_least(LEAST_FILE).clip(true))
        .column(Column::exact(FREQUENCY))
        .column(Column::exact(if levels { LEVEL } else { 0.0 }))
        .column(Column::exact(if shown.noise { NOISE } else { 0.0 }))
        .column(Column::exact(if shown.harmonics { HARMONICS } else { 0.0 }))
        .column(Column::exact(shown.flags).clip(true))
        .header(space::ROW, |mut header| {
            header.col(|ui| drop(ui.hint("Use")));
            header.col(|ui| drop(order.head(ui, "File", Key::File, false)));
            for (name, key) in [
                ("Frequency", Key::Frequency),
                ("Level", Key::Level),
                ("Noise", Key::Noise),
                ("Harmonics", Key::Harmonics),
            ] {
                header.col(|ui| {
                    if shown.has(key) && (levels || key != Key::Level) {
                        order.head(ui, name, key, true);
                    }
                });
            }
            header.col(|ui| {
                ui.add_space(space::S);
                order.head(ui, "Flags", Key::Flags, false);
            });
        })
        .body(|body| {
            let selected = *chosen;
            body.rows(space::ROW, rows.len(), |mut row| {
                let index = rows[row.index()];
                row.set_selected(index == selected);
                cells(&mut row, &p.runs[index], index, shown, folder, asks);
                if row.response().clicked() {
                    *chosen = index;
                }
            });
        });
}

fn cells(row: &mut TableRow<'_, '_>, run: &Run, index: usize, shown: Shown, folder: usize, asks: &mut Vec<Ask>) {
    row.col(|ui| {
        let mut used = run.enabled;
        let response = ui.checkbox(&mut used, "");
        response
            .widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, true, used, tf!("Use run {}", index + 1)));
        if response.changed() {
            asks.push(Ask::Edit(Edit::UseRun(run.file.clone(), used)));
        }
    });
    row.col(|ui| file_name(ui, &run.file, folder));
    row.col(|ui| drop(ui.number(format::with_unit(run.fit.omega / std::f64::consts::TAU, "Hz"))));
    row.col(|ui| drop(ui.number(run.level.map_or_else(String::new, |level| level.to_string()))));
    row.col(|ui| {
        if shown.noise {
            ui.number(words::noise(run));
        }
    });
    row.col(|ui| {
        if shown.harmonics {
            ui.number(distortion(run).map_or_else(|| "–".to_owned(), format::percent));
        }
    });
    row.col(|ui| {
        ui.add_space(space::S);
        if let Some(text) = flags(run) {
            // Where there is no room the words stand in the inspector and under the pointer.
            let text = if shown.words { text } else { run.findings.len().to_string() };
            let reasons: Vec<&str> = run.findings.iter().map(|f| f.reason.as_str()).collect();
            ui.pill(&text, ui.palette().warning).on_hover_text(tr(reasons.join("\n")));
        }
    });
}

/// The first flag of a run and how many more it has, in words.
fn flags(run: &Run) -> Option<String> {
    let (first, more) = (run.findings.first()?, run.findings.len() - 1);
    let text = words::flag(first.flag);
    Some(if more == 0 { text.to_owned() } else { format!("{text} +{more}") })
}

/// The largest higher harmonic over the fundamental, over all motions of a run.
fn distortion(run: &Run) -> Option<f64> {
    let motions = run.fit.channels.iter().filter(|c| c.channel.quantity != Quantity::Force);
    let share = |c: &crate::measurement::ChannelFit| {
        let size = |y: &faer::c64| y.re.hypot(y.im);
        let higher = c.amplitudes.iter().skip(1).map(size).fold(0.0, f64::max);
        Some(higher / c.amplitudes.first().map(size).filter(|first| *first > 0.0)?)
    };
    motions.filter_map(share).reduce(f64::max)
}

/// Amplitudes and phases of a run that came without a time record.
fn amplitudes(ui: &mut Ui, run: &Run, channel: usize) {
    ui.hint("This run came as fitted harmonics: there is no time record to show.");
    let Some(fit) = run.fit.channels.get(channel) else { return };
    let unit = words::axis(fit.channel.quantity, false).rsplit(", ").next().unwrap_or("");
    egui::Grid::new("amplitudes").num_columns(4).spacing([space::XL, space::XS]).show(ui, |ui| {
        for name in ["Harmonic", "Frequency", "Amplitude (peak)", "Phase"] {
            ui.hint(name);
        }
        ui.end_row();
        for (k, y) in fit.amplitudes.iter().enumerate() {
            let h = (k + 1) as f64;
            ui.label(format!("{}", k + 1));
            ui.label(tr(format::with_unit(h * run.fit.omega / std::f64::consts::TAU, "Hz")));
            ui.label(tr(format::with_deviation(y.re.hypot(y.im), fit.deviation(k + 1), unit)));
            ui.label(tr(format!("{}°", format::significant(y.im.atan2(y.re).to_degrees(), 4))));
            ui.end_row();
        }
    });
}
