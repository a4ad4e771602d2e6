//! The classical methods side by side: ratios and errors of each, and the matrix of one beside what it is held against.

use super::identified;
use crate::classical::Damping;
use crate::classical::method::Method;
use crate::classical::reference_shapes::{Beside, Match};
use crate::classical::side_by_side::{Applied, SideBySide};
use crate::display::{format, units};
use crate::plots::heatmap::{HeatMap, occupied};
use crate::window::app::opened::Opened;
use crate::window::appearance::theme::{self, size, space};
use crate::window::appearance::widgets::{UiExt, width};
use crate::window::language::{t, tr};
use egui::{Align, Layout, RichText, ScrollArea, Sense, Ui, vec2};
use egui_extras::{Column, TableBody, TableBuilder};
use faer::Mat;

/// Most modes whose ratios have a column.
const MOST_MODES: usize = 6;
/// Width of a column of numbers.
const NUMBER: f32 = 52.0;
/// Share of the width that belongs to the table.
const SHARE: f32 = 0.7;
/// Width of the names.
const NAME: f32 = 146.0;

/// Shows the table at the left and the matrices at the right.
pub(crate) fn show(ui: &mut Ui, opened: &mut Opened<'_>) {
    let document = opened.document;
    let found = match opened.derived.methods(ui.ctx(), document) {
        Some(Ok(found)) => found,
        Some(Err(error)) => return ui.empty("The classical methods cannot run", &error),
        None => return ui.empty("The classical methods are running", "Their progress is in the bar below."),
    };
    let identified = match opened.derived.known_outcome(document) {
        Some(Ok(outcome)) => Some(outcome.results.viscous.clone()),
        _ => None,
    };
    let labels: Vec<String> = document.project.structure.dofs().iter().map(|d| d.label.clone()).collect();
    let mut chosen = opened.view.method.filter(|m| ran(&found, *m).is_some()).or_else(|| first(&found));
    let room = ui.available_size();
    ui.horizontal_top(|ui| {
        ui.allocate_ui(vec2(SHARE * room.x, room.y), |ui| {
            ui.vertical(|ui| {
                ui.set_width(SHARE * room.x);
                let words = format!("Complex modes: {}", found.modes_from);
                let words = if found.modes_from.is_empty() { String::new() } else { words };
                ui.hint(words);
                ScrollArea::vertical().id_salt("methods").auto_shrink(false).show(ui, |ui| {
                    table(ui, &found, &mut chosen);
                    of_other_programs(ui, &found.beside);
                    refused(ui, &found);
                });
            });
        });
        ui.vertical(|ui| {
            let Some((method, applied)) = chosen.and_then(|m| Some((m, ran(&found, m)?))) else { return };
            let [name, needs, limits] = method.words();
            ui.title(name, "");
            ui.hint(format!("Needs {needs}; {limits}."));
            let Some(damping) = &applied.damping else {
                ui.hint("Gives ratios only, no matrix.");
                return;
            };
            ScrollArea::vertical().show(ui, |ui| matrices(ui, &found, damping, identified.as_ref(), &labels));
        });
    });
    opened.view.method = chosen;
}

fn ran(found: &SideBySide, method: Method) -> Option<&Applied> {
    found.entries.iter().find(|e| e.method == method)?.outcome.as_ref().ok()
}

/// The first method that gives a matrix, else the first that runs.
fn first(found: &SideBySide) -> Option<Method> {
    let ran = || found.entries.iter().filter_map(|e| Some((e.method, e.outcome.as_ref().ok()?)));
    ran().find(|(_, a)| a.damping.is_some()).or_else(|| ran().next()).map(|(method, _)| method)
}

fn table(ui: &mut Ui, found: &SideBySide, chosen: &mut Option<Method>) {
    let known = found.reference.is_some();
    let free = ui.available_width() - NAME - space::M - if known { 2.0 * NUMBER } else { 0.0 };
    let modes = found.measured.min(MOST_MODES).min((free / NUMBER).max(1.0) as usize);
    let errors = if known { 2 } else { 0 };
    ui.style_mut().interaction.selectable_labels = false;
    ui.spacing_mut().item_spacing.x = 2.0;
    TableBuilder::new(ui)
        .id_salt("methods")
        .vscroll(false)
        .striped(true)
        .sense(Sense::click())
        .cell_layout(Layout::left_to_right(Align::Center))
        .column(Column::remainder().at_least(NAME).clip(true))
        .columns(Column::exact(NUMBER), errors + modes)
        .header(space::ROW, |mut row| {
            row.col(|ui| drop(ui.hint("Method")));
            if known {
                for name in ["Error C", "MAC error"] {
                    row.col(|ui| drop(identified::head_right(ui, name)));
                }
            }
            for mode in 0..modes {
                let [symbol, unit] = units::now().damping.symbol();
                let name = with_comma(&format!("{symbol}{}", mode + 1), unit);
                row.col(|ui| drop(identified::head_right(ui, &name).on_hover_text(t!("Damping of the mode."))));
            }
        })
        .body(|mut body| {
            for entry in &found.entries {
                if let Ok(applied) = &entry.outcome {
                    applied_row(&mut body, entry.method, applied, known, modes, chosen);
                }
            }
            summary(&mut body, found, errors, modes);
        });
}

/// Modes and operating shapes of other programs beside the same modes here.
fn of_other_programs(ui: &mut Ui, beside: &[Beside]) {
    if beside.is_empty() {
        return;
    }
    ui.add_space(space::S);
    ui.label(t!("Modes of other programs"));
    let (_, hz) = units::shown("Hz");
    let [symbol, unit] = units::now().damping.symbol();
    let damping = with_comma(symbol, unit);
    let heads = [
        hz.clone(),
        damping.clone(),
        with_comma(t!("Here"), &hz),
        damping,
        "MAC".into(),
        with_comma(t!("Model"), &hz),
        "MAC".into(),
    ];
    TableBuilder::new(ui)
        .id_salt("modes of other programs")
        .vscroll(false)
        .striped(true)
        .cell_layout(Layout::left_to_right(Align::Center))
        .column(Column::remainder().at_least(NAME).clip(true))
        .columns(Column::exact(NUMBER + space::S), heads.len())
        .header(space::ROW, |mut row| {
            row.col(|ui| drop(ui.hint("Shape")));
            for head in &heads {
                row.col(|ui| drop(identified::head_right(ui, head)));
            }
        })
        .body(|mut body| beside.iter().for_each(|one| shape_row(&mut body, one)));
}

/// A shape of another program and the same mode here.
fn shape_row(body: &mut TableBody<'_>, Beside { reference, measured, model }: &Beside) {
    let (factor, _) = units::shown("Hz");
    let hz = |value: f64| format::significant(factor * value, 5);
    let damping = |ratio: Option<f64>| ratio.map_or_else(dash, measure);
    let match_cells = |found: &Option<Match>| {
        let cells = |found: &Match| [hz(found.frequency_hz), format::significant(found.mac, 3)];
        found.as_ref().map_or_else(|| [dash(), dash()], cells)
    };
    let ([ours, mac], [undamped, undamped_mac]) = (match_cells(measured), match_cells(model));
    let ratio = damping(measured.as_ref().and_then(|found| found.damping_ratio));
    let own = [hz(reference.frequency_hz), damping(reference.damping_ratio)];
    body.row(space::ROW, |mut row| {
        row.col(|ui| drop(name(ui, &reference.name).on_hover_text(tr(reference.kind.word()))));
        let cells = own.into_iter().chain([ours, ratio, mac, undamped, undamped_mac]);
        cells.for_each(|cell| drop(row.col(|ui| drop(ui.number(cell)))));
    });
}

/// Methods that cannot run on these data, with one line why.
fn refused(ui: &mut Ui, found: &SideBySide) {
    ui.add_space(space::S);
    ui.label(t!("Cannot run on these data"));
    for entry in &found.entries {
        if let Err(why) = &entry.outcome {
            ui.hint(format!("{}: {why}", entry.method.title()));
        }
    }
}

fn applied_row(
    body: &mut TableBody<'_>,
    method: Method,
    applied: &Applied,
    known: bool,
    modes: usize,
    chosen: &mut Option<Method>,
) {
    body.row(space::ROW, |mut row| {
        row.set_selected(*chosen == Some(method));
        row.col(|ui| drop(name(ui, method.title()).on_hover_text(tr(method.words().join("\n")))));
        if let Some(errors) = known.then_some(applied.errors) {
            row.col(|ui| drop(ui.number(errors.map_or_else(dash, |e| format::percent(0.01 * e.eps_c)))));
            row.col(|ui| drop(ui.number(errors.map_or_else(dash, |e| format::significant(e.mac, 2)))));
        }
        for mode in 0..modes {
            let ratio = applied.ratios.iter().find(|r| r.mode == mode).map(|r| r.ratio);
            row.col(|ui| drop(ui.number(ratio.map_or_else(dash, measure))));
        }
        if row.response().clicked() {
            *chosen = Some(method);
        }
    });
}

/// What all methods are held against: the spread between them, the modes as measured, the truth where it is known.
fn summary(body: &mut TableBody<'_>, found: &SideBySide, errors: usize, modes: usize) {
    let spread = |mode: usize| {
        found.spread.iter().find(|s| s.0 == mode).map(|s| format!("{} %", format::significant(100.0 * s.1, 2)))
    };
    let measured =
        |mode: usize| found.modal.as_ref().filter(|m| mode < m.len()).map(|m| measure(m.damping_ratio(mode)));
    let truth = |mode: usize| found.reference_ratios.get(mode).map(|r| measure(r.ratio));
    let rows: [(&str, &dyn Fn(usize) -> Option<String>); 3] =
        [("Spread of the methods", &spread), ("Complex modes as measured", &measured), ("Reference", &truth)];
    for (name, value) in rows {
        if (0..modes).all(|mode| value(mode).is_none()) {
            continue;
        }
        body.row(space::ROW, |mut row| {
            row.col(|ui| drop(self::name(ui, name)));
            (0..errors).for_each(|_| drop(row.col(|_| ())));
            for mode in 0..modes {
                row.col(|ui| drop(ui.number(value(mode).unwrap_or_else(dash))));
            }
        });
    }
}

/// A name in full: in small letters where the column is narrow.
fn name(ui: &mut Ui, text: &str) -> egui::Response {
    let fits = width(ui, text, theme::font(size::BODY)) <= ui.available_width();
    ui.label(RichText::new(tr(text)).size(if fits { size::BODY } else { size::SMALL }).color(ui.palette().ink))
}

/// A damping ratio in the measure that is chosen, without its unit.
fn measure(ratio: f64) -> String {
    format::significant(units::now().damping.of(ratio, 0.0)[0], 3)
}

/// `name, unit`; the name alone of what has none.
fn with_comma(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name}, {unit}") }
}

fn dash() -> String {
    "–".to_owned()
}

/// The matrix of the method above the reference, or above that of the energy balance; one scale of colours for both.
fn matrices(ui: &mut Ui, found: &SideBySide, damping: &Damping, identified: Option<&Mat<f64>>, labels: &[String]) {
    let against = match (&found.reference, identified) {
        (Some(reference), _) => Some(("Reference", reference)),
        (None, Some(identified)) => Some(("Energy balance of this program", identified)),
        (None, None) => None,
    };
    let mut rows = occupied(&damping.viscous);
    rows.extend(against.iter().flat_map(|(_, m)| occupied(m)));
    rows.sort_unstable();
    rows.dedup();
    let largest = |m: &Mat<f64>| m.norm_max();
    let scale = against.map_or(0.0, |(_, m)| largest(m)).max(largest(&damping.viscous));
    let (factor, unit) = units::shown("N s/m");
    let shown = std::iter::once(("Damping matrix of the method", &damping.viscous)).chain(against);
    let height = (0.5 * ui.available_height() - 26.0).max(140.0);
    for (name, matrix) in shown {
        ui.hint(name);
        ui.allocate_ui(vec2(ui.available_width(), height), |ui| {
            let matrix = &(faer::Scale(factor) * matrix);
            HeatMap { matrix, rows: &rows, columns: &rows, labels, unit: &unit, scale: Some(factor * scale) }
                .show(ui, name);
        });
    }
    for note in &damping.notes {
        ui.hint(note.as_str());
    }
}
