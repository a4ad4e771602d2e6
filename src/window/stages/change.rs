//! Change: two states of the structure held against each other, each source and mode with its deviations.

use super::identified;
use super::result::widest;
use crate::display::units::{self, Damping};
use crate::display::{change as said, format};
use crate::identify::change::{ModeChange, Pair, SourceChange};
use crate::session::states::{Against, Compared, sessions};
use crate::window::app::ask::Ask;
use crate::window::app::opened::Opened;
use crate::window::appearance::theme::space;
use crate::window::appearance::widgets::UiExt;
use crate::window::files::Pick;
use crate::window::language::{t, tf, tr};
use egui::{Align, Layout, RichText, ScrollArea, Ui};
use egui_extras::{Column, TableBuilder, TableRow};

/// Width of the column of chances, points.
const CHANCE: f32 = 64.0;

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, opened: &mut Opened<'_>, asks: &mut Vec<Ask>) {
    let document = opened.document;
    let names = sessions(&document.project);
    let Some(against) = opened.view.against.clone() else {
        ui.empty(
            "What changed?",
            "Choose the project of an earlier state: before the bolt was tightened, before the repair.",
        );
        ui.vertical_centered(|ui| choices(ui, &names, &mut opened.view.against, asks));
        return;
    };
    let found = opened.derived.change(ui.ctx(), document, &against);
    ui.horizontal_wrapped(|ui| choices(ui, &names, &mut opened.view.against, asks));
    match found {
        None => ui.empty("Both states are being identified", "The progress is in the bar below."),
        Some(Err(error)) => ui.empty("The states cannot be compared", &error),
        Some(Ok(compared)) => {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| answer(ui, &compared, &against));
        }
    }
}

/// Buttons for what the project is held against.
fn choices(ui: &mut Ui, names: &[String], against: &mut Option<Against>, asks: &mut Vec<Ask>) {
    let tip = "Its sources and those of this project are identified in both states and compared.";
    if ui.button(t!("Choose the earlier state…")).on_hover_text(tr(tip)).clicked() {
        asks.push(Ask::Pick(Pick::EarlierState));
    }
    for pair in names.windows(2) {
        if ui.button(tf!("Session {} against {}", pair[0], pair[1])).clicked() {
            *against = Some(Against::Sessions([pair[0].clone(), pair[1].clone()]));
        }
    }
    if against.is_some()
        && ui.button(t!("End comparison")).on_hover_text(t!("Compares with nothing any more.")).clicked()
    {
        *against = None;
    }
}

fn answer(ui: &mut Ui, compared: &Compared, against: &Against) {
    let Compared { titles, structure, change } = compared;
    // Two states of one structure often bear one title.
    let which = match against {
        Against::Project(_) => [", the earlier state", ", this project"],
        Against::Sessions(_) => ["", ""],
    };
    ui.hint(format!("First: {}{}.  Second: {}{}.", titles[0], which[0], titles[1], which[1]));
    let any = change.changed().next().is_some();
    let colour = if any { ui.palette().missing } else { ui.palette().ink };
    ui.label(RichText::new(tr(said::sentence(structure, change))).color(colour));
    ui.add_space(space::XS);
    let source = |s: &SourceChange| Row {
        name: format!("{} {}", s.source.effect.noun(), s.source.place.short_cell(structure)),
        unit: format::pretty_unit(&units::shown(said::unit(s)).1),
        pair: scaled(&s.coefficient, units::shown(said::unit(s)).0),
    };
    table(ui, "Source", &change.sources.iter().map(source).collect::<Vec<_>>());
    if change.modes.is_empty() {
        return;
    }
    ui.add_space(space::S);
    let measure = units::now().damping;
    ui.title(measure.words()[0], "of the modes of both models");
    let mode = |m: &ModeChange| Row {
        name: format::with_unit(m.frequency_hz[0], "Hz"),
        unit: measure.words()[1].to_owned(),
        pair: measured(&m.ratio, measure),
    };
    table(ui, "Mode", &change.modes.iter().map(mode).collect::<Vec<_>>());
}

/// A pair in another unit.
fn scaled(pair: &Pair, factor: f64) -> Pair {
    let times = |v: f64| factor * v;
    Pair {
        values: pair.values.map(times),
        deviations: pair.deviations.map(times),
        difference: times(pair.difference),
        deviation: times(pair.deviation),
        chance: pair.chance,
    }
}

/// Damping ratios in the measure that is chosen, with deviations to first order; whether they differ is judged by the ratios.
fn measured(ratio: &Pair, measure: Damping) -> Pair {
    let [first, second] = [0, 1].map(|k| measure.of(ratio.values[k], ratio.deviations[k]));
    let own = first[1].hypot(second[1]);
    let of_ratios = ratio.deviations[0].hypot(ratio.deviations[1]);
    // What both states share makes the difference surer than the two deviations alone.
    let shared = if of_ratios > 0.0 { ratio.deviation / of_ratios } else { 1.0 };
    Pair {
        values: [first[0], second[0]],
        deviations: [first[1], second[1]],
        difference: second[0] - first[0],
        deviation: shared * own,
        chance: ratio.chance,
    }
}

/// A value in both states.
struct Row {
    name: String,
    unit: String,
    pair: Pair,
}

impl Row {
    /// Values in both states; without their deviations where there is little room.
    fn states(&self, in_full: bool) -> [String; 2] {
        let Pair { values, deviations, .. } = self.pair;
        let said = |k: usize| {
            if in_full {
                format::with_deviation(values[k], deviations[k], "")
            } else {
                format::significant(values[k], 4)
            }
        };
        [0, 1].map(said)
    }

    fn difference(&self) -> String {
        format::signed(self.pair.difference, self.pair.deviation, "")
    }
}

fn table(ui: &mut Ui, what: &str, rows: &[Row]) {
    ui.style_mut().interaction.selectable_labels = false;
    let names = widest(ui, rows.iter().map(|r| r.name.clone()));
    let full = widest(ui, rows.iter().flat_map(|r| r.states(true)));
    let short = widest(ui, rows.iter().flat_map(|r| r.states(false)));
    let difference = widest(ui, rows.iter().map(Row::difference)).max(70.0);
    let unit = widest(ui, rows.iter().map(|r| r.unit.clone()));
    let in_full =
        names + 2.0 * full + difference + unit + CHANCE + 5.0 * ui.spacing().item_spacing.x <= ui.available_width();
    let states = if in_full { full } else { short };
    TableBuilder::new(ui)
        .id_salt(what)
        .vscroll(false)
        .striped(true)
        .cell_layout(Layout::left_to_right(Align::Center))
        .column(Column::remainder().at_least(90.0).clip(true))
        .columns(Column::exact(states), 2)
        .column(Column::exact(difference))
        .column(Column::exact(unit))
        .column(Column::exact(CHANCE))
        .header(space::ROW, |mut head| {
            head.col(|ui| drop(ui.hint(what)));
            for name in ["First", "Second", "Difference"] {
                head.col(|ui| drop(identified::head_right(ui, name)));
            }
            head.col(|ui| drop(ui.hint("Unit")));
            head.col(|ui| {
                identified::head_right(ui, "Chance");
            });
        })
        .body(|body| body.rows(space::ROW, rows.len(), |mut row| cells(&mut row, rows, in_full)));
}

fn cells(row: &mut TableRow<'_, '_>, rows: &[Row], in_full: bool) {
    let entry = &rows[row.index()];
    let changed = entry.pair.is_significant();
    row.set_selected(changed);
    row.col(|ui| drop(ui.label(tr(&entry.name))));
    for state in entry.states(in_full) {
        row.col(|ui| drop(ui.number(state)));
    }
    row.col(|ui| drop(ui.number(entry.difference())));
    row.col(|ui| drop(ui.hint(&entry.unit)));
    row.col(|ui| drop(ui.number(said::chance(entry.pair.chance))));
}
