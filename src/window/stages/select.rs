//! Select: one row a step, its coefficients and alternatives, the angle against the number of sources, energy per run.

use super::identified;
use crate::display::{format, words};
use crate::effects::State;
use crate::exchange::Project;
use crate::identify::{Outcome, SelectionStatus, SelectionStep};
use crate::window::app::ask::Ask;
use crate::window::app::commands::Command;
use crate::window::app::opened::Opened;
use crate::window::app::view::View;
use crate::window::appearance::theme::{self, size, space};
use crate::window::appearance::widgets::{UiExt, folded};
use crate::window::document::edits::Edit;
use crate::window::language::{t, tf, tr};
use crate::window::plots::charts;
use egui::{Align, Galley, Layout, ScrollArea, Sense, Ui};
use egui_extras::{Column, TableBuilder, TableRow};
use std::sync::Arc;

/// Widths of the table of steps from which on it shows the energy error, and chi-square too, points.
const ROOMY: f32 = 345.0;
const WIDE: f32 = 400.0;
/// Widths of its columns, points.
const COUNT: f32 = 56.0;
const ANGLE: f32 = 74.0;
const ERROR: f32 = 76.0;
const CHI_SQUARE: f32 = 66.0;
/// Name of its last column.
const PER_ROW: &str = "χ² per row";

/// What the panes of the stage share: the answer and the step that is looked at.
fn ready(ui: &mut Ui, opened: &mut Opened<'_>, says_why: bool) -> Option<(Arc<Outcome>, usize)> {
    let document = opened.document;
    let look = if says_why { identified::outcome } else { identified::outcome_quietly };
    let outcome = look(ui, opened.derived, document)?;
    let current = opened.view.step.unwrap_or(outcome.accepted).min(outcome.steps.len().checked_sub(1)?);
    Some((outcome, current))
}

/// One row a step.
pub(crate) fn steps(ui: &mut Ui, opened: &mut Opened<'_>, asks: &mut Vec<Ask>) {
    let Some((outcome, current)) = ready(ui, opened, true) else { return };
    let document = opened.document;
    let mut chosen = opened.view.step;
    header(ui, &outcome, current, asks);
    table(ui, &document.project, &outcome, current, &mut chosen);
    opened.view.step = chosen;
}

/// The set that is looked at, what cannot be told from it, and the alternatives of its size.
pub(crate) fn set(ui: &mut Ui, opened: &mut Opened<'_>, asks: &mut Vec<Ask>) {
    let Some((outcome, current)) = ready(ui, opened, false) else { return };
    let document = opened.document;
    let p = &document.project;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        details(ui, p, &outcome.steps[current], asks);
        if current == outcome.accepted {
            doubts(ui, p, &outcome);
        }
        alternatives(ui, p, &outcome.steps[current], asks);
    });
}

/// Angle against the number of sources.
pub(crate) fn angle(ui: &mut Ui, opened: &mut Opened<'_>) {
    let Some((outcome, current)) = ready(ui, opened, false) else { return };
    let document = opened.document;
    charts::angle(ui, &outcome, current, document.project.settings.stop_angle_deg);
}

/// Measured and identified energy of every run.
pub(crate) fn energy(ui: &mut Ui, opened: &mut Opened<'_>) {
    let Some((outcome, current)) = ready(ui, opened, false) else { return };
    let document = opened.document;
    charts::energy(ui, &document.project, &outcome, current);
}

fn header(ui: &mut Ui, outcome: &Outcome, current: usize, asks: &mut Vec<Ask>) {
    ui.horizontal(|ui| {
        for (command, on) in [
            (Command::StepBack, current > 0),
            (Command::StepOn, current + 1 < outcome.steps.len()),
            (Command::StepEnd, current != outcome.accepted),
        ] {
            let entry = command.entry();
            let button = ui.add_enabled(on, egui::Button::new(tr(entry.label)));
            if button.on_hover_text(tr(entry.tooltip)).clicked() {
                asks.push(Ask::Command(command));
            }
        }
    });
    ending(ui, outcome, asks);
    ui.add_space(space::XS);
}

/// How the search ended and why; where something is left, the way on.
fn ending(ui: &mut Ui, outcome: &Outcome, asks: &mut Vec<Ask>) {
    let good = matches!(outcome.status, SelectionStatus::WithinNoise | SelectionStatus::BelowAngle);
    let colour = if good { ui.palette().good } else { ui.palette().warning };
    ui.horizontal_wrapped(|ui| {
        ui.pill(status(outcome.status), colour);
        ui.hint(&outcome.reason);
        let tip = "Takes what was identified as known and searches for what it does not explain.";
        if outcome.status == SelectionStatus::AboveNoise
            && ui.link(t!("What is missing?")).on_hover_text(tr(tip)).clicked()
        {
            asks.push(Ask::Command(Command::Explain));
        }
    });
}

/// How the search ended, in words.
pub(crate) fn status(status: SelectionStatus) -> &'static str {
    match status {
        SelectionStatus::WithinNoise => "data explained within the noise",
        SelectionStatus::AboveNoise => "does not reach the noise",
        SelectionStatus::BelowAngle => "below the angle limit",
        SelectionStatus::AboveAngle => "above the angle limit",
        SelectionStatus::NothingLeft => "nothing is left to judge by",
    }
}

/// The sources of a set as one line: `viscous dashpot 3, 5, 13`.
pub(crate) fn in_words(p: &Project, sources: impl Iterator<Item = usize>) -> String {
    let mut laws: Vec<(&'static str, Vec<String>)> = Vec::new();
    for source in sources.filter_map(|s| p.sources.get(s)) {
        let (law, place) = (source.effect.noun(), source.place.short_cell(&p.structure));
        match laws.iter_mut().find(|(l, _)| *l == law) {
            Some((_, places)) => places.push(place),
            None => laws.push((law, vec![place])),
        }
    }
    laws.iter().map(|(law, places)| format!("{law} {}", places.join(", "))).collect::<Vec<_>>().join("; ")
}

/// Names and widths of the columns of figures in a table of `width` points; of no width where the sets need the room.
fn columns(width: f32) -> [(&'static str, f32); 3] {
    let from = |least: f32, own: f32| if width > least { own } else { 0.0 };
    [("Angle", ANGLE), ("Energy error", from(ROOMY, ERROR)), (PER_ROW, from(WIDE, CHI_SQUARE))]
}

fn table(ui: &mut Ui, p: &Project, outcome: &Outcome, current: usize, chosen: &mut Option<usize>) {
    ui.style_mut().interaction.selectable_labels = false;
    let columns = columns(ui.available_width());
    let fixed = COUNT + columns.iter().map(|(_, width)| width).sum::<f32>();
    let room = ui.available_width() - fixed - 5.0 * ui.spacing().item_spacing.x;
    let lines: Vec<[Arc<Galley>; 2]> = outcome.steps.iter().map(|step| step_words(ui, p, step, room)).collect();
    let heights = lines.iter().map(|[a, b]| space::ROW.max(a.size().y + b.size().y + 8.0)).collect::<Vec<_>>();
    let moved = is_new(ui, (current, outcome.steps.len()));
    let mut table = TableBuilder::new(ui);
    if moved {
        table = table.scroll_to_row(current, None).animate_scrolling(false);
    }
    table
        .id_salt("steps")
        .striped(true)
        .sense(Sense::click())
        .cell_layout(Layout::left_to_right(Align::Center))
        .auto_shrink([false, false])
        .column(Column::exact(COUNT))
        .column(Column::remainder().at_least(60.0).clip(true))
        .column(Column::exact(columns[0].1))
        .column(Column::exact(columns[1].1))
        .column(Column::exact(columns[2].1))
        .header(space::ROW, |mut row| {
            row.col(|ui| drop(ui.hint("Sources")));
            row.col(|ui| drop(ui.hint("Which")));
            for (name, width) in columns {
                row.col(|ui| {
                    if width > 0.0 {
                        identified::head_right(ui, name);
                    }
                });
            }
        })
        .body(|body| {
            body.heterogeneous_rows(heights.into_iter(), |mut row| {
                let k = row.index();
                row.set_selected(k == current);
                cells(&mut row, outcome, k, &lines[k], &columns);
                if row.response().clicked() {
                    *chosen = Some(k);
                }
            });
        });
}

/// Whether another step of as many is looked at than in the frame before: it is brought into sight, and scrolled away at will.
fn is_new(ui: &Ui, step: (usize, usize)) -> bool {
    let id = ui.scope_id().with("step in sight");
    ui.data_mut(|data| {
        let before: Option<(usize, usize)> = data.get_temp(id);
        data.insert_temp(id, step);
        before != Some(step)
    })
}

/// The sources of a step and their coefficients, folded into `room` points.
fn step_words(ui: &Ui, p: &Project, step: &SelectionStep, room: f32) -> [Arc<Galley>; 2] {
    let palette = ui.palette();
    let which = in_words(p, step.sources.iter().map(|s| s.source));
    let values = words::coefficients(step.sources.iter().filter_map(|e| Some((p.sources.get(e.source)?, e))));
    [
        folded(ui, &which, theme::font(size::BODY), palette.ink, room, 4),
        folded(ui, &values, theme::font(size::SMALL), palette.weak, room, 4),
    ]
}

fn cells(
    row: &mut TableRow<'_, '_>,
    outcome: &Outcome,
    k: usize,
    lines: &[Arc<Galley>; 2],
    columns: &[(&str, f32); 3],
) {
    let step = &outcome.steps[k];
    row.col(|ui| {
        ui.label(step.count.to_string());
        if k == outcome.accepted {
            let best = egui::RichText::new(t!("best")).size(size::SMALL).color(ui.palette().model);
            ui.label(best).on_hover_text(tr(&outcome.reason));
        }
    });
    row.col(|ui| {
        ui.vertical(|ui| {
            ui.spacing_mut().item_spacing.y = 1.0;
            ui.add_space(3.0);
            for line in lines {
                ui.add(egui::Label::new(line.clone()));
            }
        });
    });
    let per_row = step.chi_square / step.freedom.max(1) as f64;
    let angle = format!("{}°", format::significant(step.angle_deg, 4));
    let figures = [angle, format::percent(step.relative_error), format::significant(per_row, 3)];
    for (figure, (_, width)) in figures.into_iter().zip(columns) {
        row.col(|ui| {
            if *width > 0.0 {
                ui.number(figure);
            }
        });
    }
}

fn details(ui: &mut Ui, p: &Project, step: &SelectionStep, asks: &mut Vec<Ask>) {
    let plural = if step.count == 1 { "source" } else { "sources" };
    let proved = if step.proved { "proved to be the best" } else { "the best set found" };
    ui.title(&format!("{} {plural}", step.count), proved);
    for estimate in &step.sources {
        let Some(source) = p.sources.get(estimate.source) else { continue };
        let forced = source.state == State::Forced;
        let to = if forced { State::Candidate } else { State::Forced };
        let text = if forced { t!("Release") } else { t!("Force in") };
        let hover = if forced { "Lets the search leave it out again." } else { "Every set must then hold it." };
        let share = format::percent(0.01 * estimate.energy_percent);
        ui.horizontal(|ui| {
            if ui.button(text).on_hover_text(tr(hover)).clicked() {
                asks.push(Ask::Edit(Edit::SetState(estimate.source, to)));
            }
            ui.vertical(|ui| {
                ui.spacing_mut().item_spacing.y = 1.0;
                let place = source.place.short_cell(&p.structure);
                ui.label(tf!("{} {place}", source.effect.noun()));
                ui.hint(format!("{},  {share} of the energy", words::coefficient(source, estimate)));
            });
        });
    }
}

/// What the data cannot tell apart, and what the user should know.
fn doubts(ui: &mut Ui, p: &Project, outcome: &Outcome) {
    let warning = ui.palette().warning;
    for collinear in &outcome.collinear {
        let others: Vec<String> = collinear.others.iter().map(|(s, _)| in_words(p, std::iter::once(*s))).collect();
        let one = in_words(p, std::iter::once(collinear.source));
        ui.colored_label(warning, tf!("{one} cannot be told from {}.", others.join(" or ")));
    }
    for text in &outcome.warnings {
        ui.colored_label(warning, tr(text));
    }
}

fn alternatives(ui: &mut Ui, p: &Project, step: &SelectionStep, asks: &mut Vec<Ask>) {
    ui.add_space(space::S);
    if let Some(best) = &step.best_of_all {
        let words = in_words(p, best.sources.iter().copied());
        let angle = format::significant(best.angle_deg, 4);
        ui.colored_label(
            ui.palette().warning,
            tf!("Over all sets, {words} is better ({angle}°): the kept single columns hide it."),
        );
        branch(ui, &best.sources, "Branch to it", asks);
    }
    if step.alternatives.is_empty() {
        return;
    }
    ui.title("Alternatives", "click one");
    for other in &step.alternatives {
        let words = in_words(p, other.sources.iter().copied());
        let text = format!("{}°   {words}", format::significant(other.angle_deg, 4));
        branch(ui, &other.sources, &text, asks);
    }
}

/// To branch from a set is to force its sources.
fn branch(ui: &mut Ui, sources: &[usize], text: &str, asks: &mut Vec<Ask>) {
    let button = egui::Button::new(tr(text)).frame(false).truncate();
    if ui.add(button).on_hover_text(t!("Forces these sources and searches on; Undo goes back.")).clicked() {
        asks.push(Ask::Edit(Edit::Force(sources.to_vec())));
    }
}

/// The step that is looked at.
pub(crate) fn current<'a>(view: &View, outcome: &'a Outcome) -> Option<&'a SelectionStep> {
    outcome.steps.get(view.step.unwrap_or(outcome.accepted))
}
