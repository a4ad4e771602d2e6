//! Menus and the bar of stages.

use crate::exchange::export::Format;
use crate::session::recent::Recent;
use crate::window::app::commands::Command;
use crate::window::app::view::Stage;
use crate::window::app::{App, Ask};
use crate::window::appearance::theme::{self, Palette, size, space};
use crate::window::appearance::widgets::{UiExt, folded, width};
use crate::window::document::templates;
use crate::window::files;
use crate::window::frame::menu_bar;
use crate::window::language::{t, tf, tr};
use crate::window::plots::{export, table};
use egui::{
    Align, Align2, Button, Color32, Frame, Galley, Layout, Margin, Panel, Rect, Role, Sense, Ui, WidgetInfo, vec2,
};
use std::sync::Arc;

/// Where a stage stands, and why in one line.
#[derive(Debug, Clone, PartialEq)]
pub struct StageStatus {
    kind: Kind,
    /// The reason.
    pub reason: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Empty,
    Done,
    Attention,
}

impl StageStatus {
    /// Nothing there yet.
    pub fn empty(reason: &str) -> Self {
        Self { kind: Kind::Empty, reason: reason.to_owned() }
    }

    /// In order.
    pub fn done(reason: &str) -> Self {
        Self { kind: Kind::Done, reason: reason.to_owned() }
    }

    /// Something should be looked at.
    pub fn attention(reason: &str) -> Self {
        Self { kind: Kind::Attention, reason: reason.to_owned() }
    }
}

/// Shows both bars.
pub(crate) fn show(ui: &mut Ui, app: &App, asks: &mut Vec<Ask>) {
    let palette = Palette::of(ui.visuals());
    let bar = Frame::new().fill(palette.pane).inner_margin(Margin::symmetric(10, 4));
    Panel::top("menu").frame(bar).show(ui, |ui| {
        egui::MenuBar::new().ui(ui, |ui| {
            menus(ui, app, asks);
            let title = app.document.as_ref().map_or_else(String::new, |d| {
                let unsaved = if d.session().is_dirty() { "  (unsaved)" } else { "" };
                format!("{}{}", d.project.title, tr(unsaved))
            });
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.hint(title);
            });
        });
    });
    if app.document.is_some() && !app.learn.open && app.importing.is_none() {
        let bar = Frame::new().fill(palette.pane).inner_margin(Margin { left: 10, right: 10, top: 2, bottom: 0 });
        Panel::top("stages").frame(bar).show(ui, |ui| stages(ui, app, asks));
    }
}

fn menus(ui: &mut Ui, app: &App, asks: &mut Vec<Ask>) {
    let open = app.document.is_some();
    let first = ui.menu_button(t!("File"), |ui| file(ui, app, asks));
    let second = ui.menu_button(t!("Edit"), |ui| {
        let undo = app.document.as_ref().and_then(|d| d.session().history().undo_label());
        let redo = app.document.as_ref().and_then(|d| d.session().history().redo_label());
        entry(ui, Command::Undo, undo.is_some(), undo, asks);
        entry(ui, Command::Redo, redo.is_some(), redo, asks);
        ui.separator();
        entry(ui, Command::RemoveSelected, app.view.source.is_some(), None, asks);
        entry(ui, Command::ClearCandidates, open, None, asks);
    });
    let third = ui.menu_button(t!("View"), |ui| view(ui, app, asks));
    let last = ui.menu_button(t!("Help"), |ui| {
        for command in [Command::Tour, Command::Laws, Command::Menus, Command::Keys, Command::About] {
            entry(ui, command, true, None, asks);
        }
    });
    let all = [first.response, second.response, third.response, last.response];
    menu_bar::note(ui.ctx(), all.iter().map(|button| button.id).collect());
}

fn view(ui: &mut Ui, app: &App, asks: &mut Vec<Ask>) {
    let open = app.document.is_some();
    for command in
        [Command::Measure, Command::Structure, Command::Pattern, Command::Select, Command::Result, Command::Explain]
    {
        entry(ui, command, open, None, asks);
    }
    ui.separator();
    entry(ui, Command::Shape, open, None, asks);
    entry(ui, Command::Animate, open, None, asks);
    ui.separator();
    ui.add_enabled_ui(open, |ui| {
        ui.menu_button(t!("Panes"), |ui| {
            for (pane, mut shown) in app.desk.panes(app.view.stage) {
                if ui.checkbox(&mut shown, tr(pane.title())).clicked() {
                    asks.push(Ask::Pane(pane, shown));
                }
            }
        });
    });
    entry(ui, Command::ResetLayout, open, None, asks);
    ui.separator();
    ui.menu_button(t!("Units"), super::units::menu);
    ui.menu_button(t!("Text size"), text_sizes);
    ui.menu_button(t!("Language"), super::language::menu);
    entry(ui, Command::Messages, true, None, asks);
    entry(ui, Command::Theme, true, None, asks);
    entry(ui, Command::LessMotion, true, None, asks);
}

/// Sizes of all words and symbols; the keys of browsers do the same in finer steps.
fn text_sizes(ui: &mut Ui) {
    let now = ui.ctx().zoom_factor();
    for percent in [80, 90, 100, 125, 150, 175, 200] {
        let factor = percent as f32 / 100.0;
        if ui.radio((now - factor).abs() < 0.01, tf!("{percent} %")).clicked() {
            ui.ctx().set_zoom_factor(factor);
            ui.close();
        }
    }
    ui.hint("Ctrl and +, − or 0 do the same.");
}

fn file(ui: &mut Ui, app: &App, asks: &mut Vec<Ask>) {
    let open = app.document.is_some();
    ui.menu_button(t!("New from template"), |ui| {
        for (k, template) in templates::ALL.iter().enumerate() {
            if ui.button(tr(template.name)).clicked() {
                asks.push(Ask::New(k));
                ui.close();
            }
        }
    });
    entry(ui, Command::Open, true, None, asks);
    let recent = app.recent.as_ref().map_or(&[][..], Recent::files);
    ui.add_enabled_ui(!recent.is_empty(), |ui| {
        ui.menu_button(t!("Open recent"), |ui| {
            for path in recent {
                if ui.button(path.display().to_string()).clicked() {
                    asks.push(Ask::Open(path.clone()));
                    ui.close();
                }
            }
        });
    });
    ui.separator();
    entry(ui, Command::Import, true, None, asks);
    ui.separator();
    let dirty = app.document.as_ref().is_some_and(|d| d.session().is_dirty());
    entry(ui, Command::Save, dirty, None, asks);
    entry(ui, Command::SaveAs, open, None, asks);
    let known = app.document.as_ref().and_then(|d| app.derived.known_outcome(d)).is_some_and(|o| o.is_ok());
    ui.add_enabled_ui(known, |ui| {
        ui.menu_button(t!("Export"), |ui| {
            for format in Format::ALL {
                if ui.button(tr(files::words(format))).clicked() {
                    asks.push(Ask::ExportAs(format));
                    ui.close();
                }
            }
        })
        .response
        .on_disabled_hover_text(t!("What is identified can be exported; nothing is yet. The stage Select says why."));
    });
    // A report holds what there is, with or without sources to identify.
    entry(ui, Command::Report, open, None, asks);
    plots(ui);
    tables(ui);
    ui.separator();
    entry(ui, Command::Close, open, None, asks);
    entry(ui, Command::Quit, true, None, asks);
}

/// The plots on the screen, to be written to files.
fn plots(ui: &mut Ui) {
    let shown = export::shown(ui.ctx());
    ui.add_enabled_ui(!shown.is_empty(), |ui| {
        ui.menu_button(t!("Export plot"), |ui| {
            for title in shown {
                ui.menu_button(tr(&title), |ui| {
                    for (kind, label) in
                        [(export::Kind::Svg, "SVG…"), (export::Kind::Png, "PNG…"), (export::Kind::Csv, "CSV values…")]
                    {
                        if ui.button(tr(label)).clicked() {
                            export::want(ui.ctx(), &title, kind);
                            ui.close();
                        }
                    }
                });
            }
        });
    });
}

/// The tables on the screen, to be written to files.
fn tables(ui: &mut Ui) {
    let shown = table::shown(ui.ctx());
    ui.add_enabled_ui(!shown.is_empty(), |ui| {
        ui.menu_button(t!("Export table"), |ui| {
            for title in shown {
                if ui.button(tf!("{title}…")).on_hover_text(t!("As CSV: SI units, all digits.")).clicked() {
                    table::want(ui.ctx(), &title);
                    ui.close();
                }
            }
        });
    });
}

fn entry(ui: &mut Ui, command: Command, enabled: bool, object: Option<&str>, asks: &mut Vec<Ask>) {
    let e = command.entry();
    let text = object.map_or_else(|| e.label.to_owned(), |object| format!("{} {object}", e.label));
    let mut button = Button::new(tr(text));
    if let Some(keys) = e.keys {
        button = button.shortcut_text(ui.ctx().format_shortcut(&keys));
    }
    if ui.add_enabled(enabled, button).on_hover_text(tr(e.tooltip)).clicked() {
        asks.push(Ask::Command(command));
        ui.close();
    }
}

/// Room in the bar of stages, points.
#[derive(Debug, Clone, Copy)]
struct Room {
    /// Beside the name of a stage, for its symbol and its mark.
    tab: f32,
    /// Of the arrow between two stages.
    chevron: f32,
    /// Before the reason.
    before: f32,
}

impl Room {
    const WIDE: Self = Self { tab: 58.0, chevron: 12.0, before: space::L };
    /// Where the reason would be cut short otherwise.
    const TIGHT: Self = Self { tab: 50.0, chevron: 8.0, before: space::S };

    /// What the stages leave for the reason.
    fn left(self, ui: &Ui) -> f32 {
        let names = Stage::ALL.map(|stage| width(ui, stage.label(), theme::font(size::HEADING)) + self.tab);
        let gaps = (Stage::ALL.len() - 1) as f32;
        let spacing = (2.0 * gaps + 2.0) * BETWEEN;
        ui.available_width() - names.iter().sum::<f32>() - gaps * self.chevron - spacing - self.before
    }
}

/// Between two things in the bar of stages, points.
const BETWEEN: f32 = 2.0;

fn stages(ui: &mut Ui, app: &App, asks: &mut Vec<Ask>) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = BETWEEN;
        let mark = app.status(app.view.stage);
        let fits = !reason_words(ui, &mark.reason, Room::WIDE.left(ui)).elided;
        let room = if fits { Room::WIDE } else { Room::TIGHT };
        for (k, stage) in Stage::ALL.into_iter().enumerate() {
            if k > 0 {
                chevron(ui, room);
            }
            if tab(ui, stage, app.view.stage == stage, &app.status(stage), room) {
                asks.push(Ask::Stage(stage));
            }
        }
        ui.add_space(room.before);
        let colour = if mark.kind == Kind::Attention { ui.palette().warning } else { ui.palette().weak };
        reason(ui, &mark.reason, colour);
    });
}

/// A reason on one line, or where there is little room on two.
fn reason_words(ui: &Ui, text: &str, room: f32) -> Arc<Galley> {
    // A number and its sign stay on one line.
    let together = tr(text).replace(" %", "\u{a0}%");
    folded(ui, &together, theme::font(size::SMALL), Color32::PLACEHOLDER, room, 2)
}

/// Why the stage stands where it stands.
fn reason(ui: &mut Ui, text: &str, colour: Color32) {
    let words = reason_words(ui, text, ui.available_width());
    let (rect, response) = ui.allocate_exact_size(words.size(), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, tr(text)));
    ui.painter().galley(rect.min, words, colour);
    response.on_hover_text(tr(text));
}

fn chevron(ui: &mut Ui, room: Room) {
    let (rect, _) = ui.allocate_exact_size(vec2(room.chevron, 34.0), Sense::hover());
    let c = rect.center();
    let points = vec![c + vec2(-2.0, -4.0), c + vec2(2.0, 0.0), c + vec2(-2.0, 4.0)];
    ui.painter().add(egui::Shape::line(points, theme::hair(ui.palette().weak)));
}

/// A stage with its mark; true when it was clicked.
fn tab(ui: &mut Ui, stage: Stage, open: bool, mark: &StageStatus, room: Room) -> bool {
    let (palette, nearer) = (ui.palette(), 0.5 * (Room::WIDE.tab - room.tab));
    let galley = ui.painter().layout_no_wrap(tr(stage.label()), theme::font(size::HEADING), Color32::PLACEHOLDER);
    let (rect, response) = ui.allocate_exact_size(vec2(galley.size().x + room.tab, 34.0), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::Tab, true, open, tr(stage.label())));
    let painter = ui.painter();
    if response.hovered() {
        painter.rect_filled(rect.shrink2(vec2(0.0, 3.0)), 5.0, palette.raised);
    }
    let ink = if open { palette.accent } else { palette.ink };
    let icon = Rect::from_center_size(rect.left_center() + vec2(17.0 - nearer, 0.0), vec2(15.0, 15.0));
    super::icons::stage(painter, stage, icon, ink);
    let centre = rect.right_center() - vec2(13.0 - nearer, 0.0);
    match mark.kind {
        Kind::Empty => drop(painter.circle_stroke(centre, 4.0, theme::pen(palette.weak))),
        Kind::Done => {
            painter.circle_filled(centre, 6.0, palette.good);
            let tick = vec![centre + vec2(-2.8, 0.2), centre + vec2(-0.8, 2.4), centre + vec2(3.0, -2.2)];
            painter.add(egui::Shape::line(tick, theme::pen(palette.pane)));
        }
        Kind::Attention => {
            painter.circle_filled(centre, 6.0, palette.warning);
            painter.text(centre, Align2::CENTER_CENTER, "!", theme::font(size::SMALL), palette.pane);
        }
    }
    painter.galley(rect.left_center() + vec2(31.0 - nearer, -0.5 * galley.size().y), galley, ink);
    if open {
        let line = Rect::from_min_max(rect.left_bottom() - vec2(0.0, 2.5), rect.right_bottom());
        painter.rect_filled(line, 1.0, palette.accent);
    }
    response.on_hover_text(tr(&mark.reason)).clicked()
}
