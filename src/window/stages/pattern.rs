//! Pattern: the palette of laws, families at one click, the list of sources.

use crate::effects::{Effect, Family, Kind, Source, State};
use crate::exchange::Project;
use crate::window::app::ask::Ask;
use crate::window::app::commands::Command;
use crate::window::app::view::View;
use crate::window::appearance::theme::{self, size, space};
use crate::window::appearance::widgets::UiExt;
use crate::window::document::edits::Edit;
use crate::window::language::{t, tr};
use crate::window::plots::localisation;
use crate::window::schematic::{paint::source_stroke, symbols};
use egui::text::{Galley, LayoutJob};
use egui::{
    Align, Frame, Margin, Panel, Response, RichText, Role, ScrollArea, Sense, StrokeKind, Ui, Vec2, WidgetInfo, pos2,
    vec2,
};
use egui_extras::{Column, TableBuilder};
use std::sync::Arc;

/// Height of a tile of the palette, least width, room between tiles, points.
const TILE: f32 = 60.0;
/// Height of the symbol on it with the rims above and below the words, points.
const SYMBOL: f32 = 34.0;
const LEAST_TILE: f32 = 94.0;
const BETWEEN: f32 = 5.0;
/// Least height of the palette, points.
const LEAST_PALETTE: f32 = 80.0;

/// The palette of laws and the families of places.
pub(crate) fn laws(ui: &mut Ui, law: &mut Effect, asks: &mut Vec<Ask>) {
    palette(ui, law, asks);
}

/// The list of sources.
pub(crate) fn sources(ui: &mut Ui, p: &Project, view: &mut View, asks: &mut Vec<Ask>) {
    if let Some(source) = list(ui, p, view, asks) {
        (view.source, view.dof) = (Some(source), None);
    }
}

fn palette(ui: &mut Ui, law: &mut Effect, asks: &mut Vec<Ask>) {
    // As high as its buttons need on one row or on two; the tiles have the rest.
    let frame = Frame::new().inner_margin(Margin { top: 2 * space::XS as i8, ..Margin::ZERO });
    Panel::bottom("families").frame(frame).show_separator_line(false).show(ui, |ui| families(ui, *law, asks));
    // A bar for scrolling stands at the right.
    let room = ui.available_width() - space::S;
    let columns = ((room + BETWEEN) / (LEAST_TILE + BETWEEN)).floor().max(1.0);
    let width = (room - BETWEEN * (columns - 1.0)) / columns - 0.5;
    let rows = rows(ui, columns as usize, width);
    let height = whole_rows(rows.iter().map(|row| row.height), ui.available_height());
    ScrollArea::vertical().max_height(height).auto_shrink(false).show(ui, |ui| {
        ui.spacing_mut().item_spacing = vec2(BETWEEN, BETWEEN);
        for row in rows {
            ui.horizontal(|ui| {
                for (effect, name) in row.laws {
                    if tile(ui, effect, effect == *law, name, vec2(width, row.height)) {
                        *law = effect;
                    }
                }
            });
        }
    });
}

/// Laws beside one another in the palette.
struct Row {
    /// With their names as they are laid out.
    laws: Vec<(Effect, Arc<Galley>)>,
    /// As high as its longest name wants, points.
    height: f32,
}

/// All laws that may be drawn, so many a row, on tiles of this width.
fn rows(ui: &Ui, columns: usize, width: f32) -> Vec<Row> {
    let effects: Vec<Effect> = Effect::ALL.into_iter().filter(|e| !e.is_of_channel()).collect();
    let row = |effects: &[Effect]| {
        let laws: Vec<_> = effects.iter().map(|&effect| (effect, law_name(ui, effect, width))).collect();
        let words = laws.iter().map(|(_, name)| name.size().y).fold(0.0, f32::max);
        Row { laws, height: TILE.max(SYMBOL + words) }
    };
    effects.chunks(columns).map(row).collect()
}

/// Height of as many rows as are whole in `room`, so that none is cut off before one scrolls.
fn whole_rows(heights: impl Iterator<Item = f32>, room: f32) -> f32 {
    let ends = heights.scan(-BETWEEN, |end, height| {
        *end += BETWEEN + height;
        Some(*end)
    });
    ends.take_while(|end| *end <= room).last().unwrap_or(room.max(LEAST_PALETTE))
}

/// The buttons that add a law at many places at once.
fn families(ui: &mut Ui, law: Effect, asks: &mut Vec<Ask>) {
    ui.horizontal_wrapped(|ui| {
        let weak = ui.palette().weak;
        ui.label(RichText::new(t!("Add candidates at")).color(weak));
        if matches!(law.kind(), Kind::Whole(_)) {
            if ui.button(t!("Whole structure")).clicked() {
                asks.push(Ask::Edit(Edit::DrawWhole(law)));
            }
            return;
        }
        for (family, label) in [
            (Family::EachTranslation, "Each translation"),
            (Family::EachDof, "Each DOF"),
            (Family::EachPair, "Each pair"),
            (Family::Chain, "One chain"),
        ] {
            if ui.button(tr(label)).clicked() {
                asks.push(Ask::Edit(Edit::DrawFamily(law, family)));
            }
        }
    });
}

/// A law with its symbol; true when it was clicked.
fn tile(ui: &mut Ui, effect: Effect, chosen: bool, words: Arc<Galley>, size: Vec2) -> bool {
    let palette = ui.palette();
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let name = effect.noun();
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, tr(name)));
    let lit = chosen || response.hovered() || response.has_focus();
    let fill = if chosen { palette.accent_faint } else { palette.canvas };
    let line = theme::hair(if lit { palette.accent } else { palette.line });
    ui.painter().rect(rect, 5.0, fill, line, StrokeKind::Inside);
    let ink = if chosen { palette.accent } else { palette.ink };
    let (x, y) = (rect.center().x, rect.top() + 20.0);
    symbols::draw(ui.painter(), effect, [pos2(x - 30.0, y), pos2(x + 30.0, y)], theme::pen(ink));
    let middle = 0.5 * (rect.top() + SYMBOL - 4.0 + rect.bottom());
    ui.painter().galley_with_override_text_color(pos2(x, middle - 0.5 * words.size().y), words, ink);
    response.on_hover_text(tr(parameters(effect))).clicked()
}

/// The name of a law under its symbol, on several lines where it is long.
fn law_name(ui: &Ui, effect: Effect, width: f32) -> Arc<Galley> {
    let (text, font) = (tr(effect.noun()), theme::font(size::SMALL));
    let mut job = LayoutJob::simple(text, font, ui.palette().ink, width - 8.0);
    job.halign = Align::Center;
    ui.painter().layout_job(job)
}

fn parameters(effect: Effect) -> String {
    let parameter_in_words = |p: &crate::effects::Parameter| {
        if p.unit.is_empty() {
            p.name.to_owned()
        } else {
            format!("{}, {}", p.name, crate::display::format::pretty_unit(p.unit))
        }
    };
    effect.parameters().iter().map(parameter_in_words).collect::<Vec<_>>().join("\n")
}

/// The list of sources; the one that was clicked.
fn list(ui: &mut Ui, p: &Project, view: &View, asks: &mut Vec<Ask>) -> Option<usize> {
    let mut chosen = None;
    let palette = ui.palette();
    ui.horizontal(|ui| {
        let count = |state: State| p.sources.iter().filter(|s| s.state == state).count();
        for state in [State::Candidate, State::Forced, State::Known, State::Reference, State::Off] {
            if count(state) > 0 {
                let colour = source_stroke(palette, state, false, true).color;
                ui.pill(&format!("{} {}", count(state), state.word()), colour);
            }
        }
        if count(State::Candidate) > 0 && ui.button(tr(Command::ClearCandidates.entry().label)).clicked() {
            asks.push(Ask::Command(Command::ClearCandidates));
        }
    });
    if p.sources.is_empty() {
        ui.empty("No sources yet", "Click a DOF on the schematic, or add a family of candidates at the left.");
        return None;
    }
    ui.add_space(space::XS);
    ui.style_mut().interaction.selectable_labels = false;
    let width = ui.available_width();
    let laws = super::result::widest(ui, p.sources.iter().map(|s| s.effect.noun().to_owned()));
    TableBuilder::new(ui)
        .striped(true)
        .sense(Sense::click())
        .cell_layout(egui::Layout::left_to_right(Align::Center))
        .column(Column::exact(56.0))
        .column(Column::exact(laws.clamp(110.0, (0.35 * width).max(110.0))).clip(true))
        .column(Column::remainder().clip(true))
        .column(Column::exact(84.0))
        .header(space::ROW, |mut header| {
            for name in ["", "Law", "Place", "State"] {
                header.col(|ui| drop(ui.hint(name)));
            }
        })
        .body(|body| {
            body.rows(space::ROW, p.sources.len(), |mut row| {
                let index = row.index();
                let s = &p.sources[index];
                row.set_selected(view.source == Some(index));
                let stroke = source_stroke(palette, s.state, false, true);
                row.col(|ui| {
                    let (rect, _) = ui.allocate_exact_size(vec2(46.0, space::ROW), Sense::hover());
                    symbols::draw(ui.painter(), s.effect, [rect.left_center(), rect.right_center()], stroke);
                });
                row.col(|ui| drop(ui.label(tr(s.effect.noun()))));
                row.col(|ui| drop(ui.label(tr(s.place.cell(&p.structure)))));
                row.col(|ui| drop(ui.pill(s.state.word(), stroke.color)));
                if localised(row.response(), p, s).clicked() {
                    chosen = Some(index);
                }
            });
        });
    chosen
}

/// A row that shows where the source under the pointer stands in the damping matrix.
fn localised(response: Response, p: &Project, source: &Source) -> Response {
    let legs = source.place.legs();
    if legs.is_empty() {
        return response;
    }
    response.on_hover_ui(|ui| {
        ui.label(t!("Where it stands in the matrix"));
        localisation::show(ui, &legs, |dof| p.structure.label(dof).to_owned());
    })
}
