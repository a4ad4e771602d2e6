//! The page of laws: what each kind of damping looks like on a small structure, before one's own data are looked at.

mod figures;
pub mod lesson;
mod page;

pub use page::Learn;

use super::plots::show::Stack;
use crate::display::{format, words};
use crate::effects::Effect;
use crate::plots::figure::Figure;
use crate::response::portrait::Portrait;
use crate::window::app::ask::Ask;
use crate::window::app::commands::Command;
use crate::window::appearance::theme::{Palette, space};
use crate::window::appearance::widgets::UiExt;
use crate::window::language::{numbers, t, tr};
use egui::{CentralPanel, Frame, Margin, Panel, ScrollArea, Slider, Ui, vec2};
use lesson::{Lesson, System};
use std::ops::RangeInclusive;
use std::sync::Arc;

/// Width of the choices at the left.
const CHOICES: f32 = 300.0;
/// Plots in a row.
const COLUMNS: usize = 3;

/// Room between the plots of a row, points: a curve that ends at its frame does not run into the words of the next.
const BETWEEN: f32 = 20.0;

/// Shows the page in place of the panes.
pub fn show(ui: &mut Ui, learn: &mut Learn, asks: &mut Vec<Ask>) {
    let palette = Palette::of(ui.visuals());
    learn.update(ui.ctx());
    let left = Frame::new().fill(palette.pane).inner_margin(Margin::same(14));
    Panel::left("choices of laws").frame(left).resizable(false).exact_size(CHOICES).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| choices(ui, &mut learn.lesson, asks));
    });
    let right = Frame::new().fill(palette.pane).inner_margin(Margin { left: 14, right: 28, top: 10, bottom: 10 });
    CentralPanel::default().frame(right).show(ui, |ui| match &learn.last {
        Some(Ok(portrait)) => plots(ui, &Arc::clone(portrait), &learn.lesson),
        Some(Err(error)) => ui.empty("This law cannot be shown", error),
        None => ui.empty("The law is being computed", ""),
    });
}

fn choices(ui: &mut Ui, lesson: &mut Lesson, asks: &mut Vec<Ask>) {
    ui.title("Laws of damping", "");
    ui.hint("What each law looks like on a small structure, before you look for it in your own data.");
    ui.add_space(space::S);
    if let Some(system) = ui.choice("Structure", lesson.system, &System::ALL, System::word) {
        *lesson = Lesson::new(system, lesson.effect);
    }
    ui.hint(lesson.system.values());
    if let Some(effect) = ui.choice("Law", lesson.effect, &Lesson::laws(), Effect::noun) {
        *lesson = Lesson { at: lesson.at, ..Lesson::new(lesson.system, effect) };
    }
    ui.hint(lesson.effect.sentence());
    let places = lesson.system.places();
    if let Some(at) = ui.choice("Place", lesson.at, places, lesson::At::word) {
        lesson.at = at;
    }
    ui.add_space(space::M);
    ui.title("Parameters of the law", "");
    for (k, parameter) in lesson.effect.parameters().iter().enumerate() {
        let (range, logarithmic) = Lesson::range(lesson.effect, k, parameter);
        slider(ui, &words::parameter(parameter.name), &mut lesson.parameters[k], range, logarithmic, parameter.unit);
    }
    ui.add_space(space::M);
    ui.title("Test", "");
    slider(ui, "Force amplitude", &mut lesson.force, 0.05..=50.0, true, "N");
    slider(ui, "Frequency of the loops", &mut lesson.frequency_hz, 0.5..=10.0, true, "Hz");
    slider(ui, "Released from", &mut lesson.displacement, 1e-4..=0.1, true, "m");
    slider(ui, "Dashpot at every mass", &mut lesson.background, 0.0..=20.0, false, "N s/m");
    ui.add_space(space::M);
    ui.horizontal(|ui| {
        if ui.button(t!("Start values")).on_hover_text(t!("Puts all values back.")).clicked() {
            *lesson = Lesson::new(lesson.system, lesson.effect);
        }
        if ui.primary("Close").clicked() {
            asks.push(Ask::Command(Command::Laws));
        }
    });
}

fn slider(ui: &mut Ui, name: &str, value: &mut f64, range: RangeInclusive<f64>, logarithmic: bool, unit: &str) {
    let label = ui.hint(name);
    let unit = format::pretty_unit(unit);
    let suffix = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    ui.spacing_mut().slider_width = CHOICES - 140.0;
    let slider = Slider::new(value, range)
        .logarithmic(logarithmic)
        .suffix(suffix)
        .custom_formatter(|v, _| tr(format::significant(v, 3)))
        .custom_parser(numbers::typed);
    ui.add(slider).labelled_by(label.id);
}

/// A plot or two of the grid, with its title and a remark.
struct Cell {
    title: &'static str,
    remark: String,
    figures: Result<Vec<(Figure, f32)>, String>,
}

fn cells(portrait: &Portrait, lesson: &Lesson, palette: &Palette) -> [Cell; 6] {
    let alone = |figure: Figure| vec![(figure, 1.0)];
    let [magnitude, phase] = figures::bode(portrait, palette);
    let energy = figures::energy(portrait, palette);
    let power = energy.as_ref().map(|e| e.1.clone()).unwrap_or_default();
    let at = format!("at {}", format::with_unit(lesson.frequency_hz, "Hz"));
    let failed = portrait.curves.iter().find_map(|c| c.found.as_ref().err());
    [
        Cell {
            title: "Free motion",
            remark: format!("released from {}", format::with_unit(lesson.displacement, "m")),
            figures: figures::decay(portrait, palette).map(alone),
        },
        Cell {
            title: "Bode diagram",
            remark: failed.cloned().unwrap_or_else(|| "of mass 1, dotted where unstable".to_owned()),
            figures: Ok(vec![(magnitude, 0.6), (phase, 0.4)]),
        },
        Cell {
            title: "Nyquist diagram",
            remark: "of the receptance".to_owned(),
            figures: Ok(alone(figures::nyquist(portrait, palette))),
        },
        Cell {
            title: "Hysteresis of the exciter",
            remark: at.clone(),
            figures: Ok(alone(figures::loops("Hysteresis of the exciter", &portrait.loops, palette))),
        },
        Cell {
            title: "Hysteresis of the law",
            remark: at.clone(),
            figures: Ok(alone(figures::loops("Hysteresis of the law", &portrait.own, palette))),
        },
        Cell { title: "Energy per cycle", remark: power, figures: energy.map(|e| alone(e.0)) },
    ]
}

fn plots(ui: &mut Ui, portrait: &Portrait, lesson: &Lesson) {
    let palette = ui.palette();
    let room = ui.available_size();
    let rows = 6_usize.div_ceil(COLUMNS);
    let size = vec2((room.x + BETWEEN) / COLUMNS as f32 - BETWEEN, room.y / rows as f32 - 8.0);
    let mut cells = cells(portrait, lesson, palette).into_iter();
    for _ in 0..rows {
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = BETWEEN;
            for cell in cells.by_ref().take(COLUMNS) {
                ui.allocate_ui(size, |ui| {
                    ui.vertical(|ui| {
                        ui.set_width(size.x);
                        ui.title(cell.title, &cell.remark);
                        let title = format!("{}, {}", cell.title, lesson.effect.noun());
                        ui.allocate_ui(vec2(size.x, size.y - 30.0), |ui| match cell.figures {
                            Ok(figures) => Stack { id: cell.title, title: &title, figures, keys: true }.show(ui),
                            Err(why) => ui.empty("Not for this law", &why),
                        });
                    });
                });
            }
        });
    }
}
