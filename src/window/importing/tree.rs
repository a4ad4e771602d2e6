//! Files, sets and channels as a list that folds.

use super::draft::Draft;
use crate::display::format::{pretty_unit, significant};
use crate::window::appearance::theme::{self, size, space};
use crate::window::appearance::widgets::{UiExt, elided};
use crate::window::language::{tf, tr};
use dashpot_datafiles::{Channel, DataFile, Set, is_coherence};
use egui::{Role, ScrollArea, Sense, Ui, WidgetInfo, pos2, vec2};
use std::sync::Arc;

/// Height of a line, points.
const LINE: f32 = 20.0;
/// Indentation of a level, points.
const INDENT: f32 = 14.0;

/// A line of the list.
enum Line {
    File(usize),
    Set(usize, usize),
    Channel(usize, usize, usize),
    Note(String),
}

/// Shows the tree; a click on a channel draws it.
pub(super) fn show(ui: &mut Ui, draft: &mut Draft) {
    let lines = lines(draft);
    ui.spacing_mut().item_spacing.y = 0.0;
    ScrollArea::vertical().id_salt("import tree").auto_shrink(false).show_rows(ui, LINE, lines.len(), |ui, range| {
        for line in &lines[range] {
            one(ui, draft, line);
        }
    });
}

/// What is in sight, as far as it is unfolded.
fn lines(draft: &Draft) -> Vec<Line> {
    let mut lines = Vec::new();
    for (f, opened) in draft.files.iter().enumerate() {
        lines.push(Line::File(f));
        let file = match &opened.file {
            Ok(file) => file,
            Err(error) => {
                lines.push(Line::Note(error.clone()));
                continue;
            }
        };
        lines.extend(file.contents().notes.iter().map(|note| Line::Note(note.text.clone())));
        for (s, set) in file.contents().sets.iter().enumerate() {
            if set.channels.len() == 1 {
                lines.push(Line::Channel(f, s, 0));
                continue;
            }
            lines.push(Line::Set(f, s));
            if draft.unfolded.contains(&(f, s)) {
                lines.extend((0..set.channels.len()).map(|c| Line::Channel(f, s, c)));
                lines.extend(set.notes.iter().map(|note| Line::Note(note.text.clone())));
            }
        }
    }
    lines
}

fn one(ui: &mut Ui, draft: &mut Draft, line: &Line) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), LINE), Sense::click());
    let palette = ui.palette();
    let (font, small) = (theme::font(size::BODY), theme::font(size::SMALL));
    let indented = |level: f32| pos2(rect.left() + space::XS + INDENT * level, rect.center().y);
    let right = rect.right() - space::S;
    match line {
        Line::File(f) => {
            let opened = &draft.files[*f];
            let format = opened.file.as_ref().map_or("not read", |file| file.contents().format.word());
            response.widget_info(|| WidgetInfo::labeled(Role::Label, true, tf!("File {}", opened.name)));
            let width = aside(ui, format, right, rect.center().y);
            elided(ui, &opened.name, font, palette.ink, indented(0.0), right - width - indented(0.0).x - space::S);
        }
        Line::Set(f, s) => {
            let Some(file) = file_of(draft, *f) else { return };
            let set = &file.contents().sets[*s];
            let open = draft.unfolded.contains(&(*f, *s));
            let name = if set.name.is_empty() { format!("Set {}", s + 1) } else { set.name.clone() };
            let what = format!("{}, {} channels", set.kind.word(), set.channels.len());
            response.widget_info(|| WidgetInfo::selected(Role::Button, true, open, tf!("Set {name}")));
            let width = aside(ui, &what, right, rect.center().y);
            let text = format!("{} {name}", if open { "−" } else { "+" });
            elided(ui, &text, font, palette.ink, indented(0.5), right - width - indented(0.5).x - space::S);
            if response.clicked() && !draft.unfolded.remove(&(*f, *s)) {
                draft.unfolded.insert((*f, *s));
            }
        }
        Line::Channel(f, s, c) => {
            let Some(file) = file_of(draft, *f) else { return };
            let set = &file.contents().sets[*s];
            let (channel, here) = (&set.channels[*c], (*f, *s, *c));
            let name = if channel.name.trim().is_empty() { set.name.as_str() } else { channel.name.as_str() };
            let selected = draft.looked_at == Some(here);
            response.widget_info(|| WidgetInfo::selected(Role::Button, true, selected, tf!("Channel {name}")));
            if selected || response.hovered() {
                let fill = if selected { palette.accent_faint } else { palette.raised };
                ui.painter().rect_filled(rect, 3.0, fill);
            }
            let level = if set.channels.len() == 1 { 0.5 } else { 1.5 };
            let width = aside(ui, &details(channel, set), right, rect.center().y);
            elided(ui, name, font, palette.ink, indented(level), right - width - indented(level).x - space::S);
            if response.clicked() {
                draft.looked_at = Some(here);
            }
            response.on_hover_ui(|ui| tooltip(ui, set, channel));
        }
        Line::Note(note) => {
            let room = rect.right() - indented(1.0).x - space::S;
            elided(ui, note, small, palette.weak, indented(1.0), room);
            response.on_hover_text(tr(note));
        }
    }
}

fn file_of(draft: &Draft, file: usize) -> Option<Arc<DataFile>> {
    draft.files[file].file.as_ref().ok().cloned()
}

/// Small words at the right end of a line; gives back their width.
fn aside(ui: &Ui, text: &str, right: f32, middle: f32) -> f32 {
    let galley = ui.painter().layout_no_wrap(tr(text), theme::font(size::SMALL), ui.palette().weak);
    let wide = galley.size();
    ui.painter().galley(pos2(right - wide.x, middle - 0.5 * wide.y), galley, ui.palette().weak);
    wide.x
}

/// Unit, number of values and sampling of a channel.
fn details(channel: &Channel, set: &Set) -> String {
    let unit = match channel.unit.as_str() {
        "" if is_coherence(&set.name) || is_coherence(&channel.name) => "coherence".to_owned(),
        "" => "no unit".to_owned(),
        unit => pretty_unit(unit),
    };
    let sampling = match channel.axis.step() {
        Some(step) if set.axis_unit == "s" && step > 0.0 => format!("{} Hz", significant(1.0 / step, 5)),
        Some(step) => format!("step {} {}", significant(step, 4), set.axis_unit),
        None => return format!("{unit} · {}", channel.count),
    };
    format!("{unit} · {} · {sampling}", channel.count)
}

/// What else the file says.
fn tooltip(ui: &mut Ui, set: &Set, channel: &Channel) {
    ui.set_max_width(340.0);
    ui.hint(format!("{}: {}", set.name, set.kind.word()));
    for (word, value) in channel.attributes.iter().take(12) {
        ui.hint(format!("{word}: {value}"));
    }
    for note in set.notes.iter().take(4) {
        ui.hint(note.text.as_str());
    }
}
