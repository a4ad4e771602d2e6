//! The error map: one cell a run and channel, coloured from the noise floor to the largest error; its legend.

use crate::display::format;
use crate::display::format::in_words;
use crate::exchange::Project;
use crate::plots::error_map::{self, Cell, ENERGY, Grid, Scale};
use crate::plots::figure::{Axis, Figure, Ticks};
use crate::window::appearance::theme::{self, Palette, size};
use crate::window::appearance::widgets::{UiExt, width};
use crate::window::language::{numbers, t, tr};
use crate::window::plots::cell_map::{CellMap, Field};
use crate::window::plots::export;
use egui::{
    Align2, Color32, FontId, Pos2, Rect, Response, Role, ScrollArea, Sense, Shape, Stroke, StrokeKind, Ui, Vec2,
    WidgetInfo, pos2, vec2,
};
use std::ops::Range;

/// Its name on the screen and in files.
const NAME: &str = "Error map";
/// Most cells that are nodes of their own for screen readers.
const MANY: usize = 800;
const HEAD: f32 = 18.0;
/// Room under the last row for the outline of a cell, points.
const FOOT: f32 = 3.0;
/// Room about the number in a cell, and least size of a cell that has one, points.
const ABOUT: f32 = 5.0;
const READABLE: Vec2 = vec2(20.0, 13.0);
/// Least height of a cell, points.
pub(super) const LEAST: f32 = 12.0;
/// Pieces of the legend's colours.
const STEPS: usize = 48;

/// What the map shows.
pub(super) struct Map<'a> {
    /// Project, for frequencies and levels.
    pub project: &'a Project,
    /// Numbers.
    pub grid: &'a Grid,
    /// Colours.
    pub scale: Scale,
    /// Selected run and channel.
    pub selected: Option<(usize, &'a str)>,
    /// Whether it is that of an earlier model while the present one is computed.
    pub stale: bool,
    /// The line of words above it.
    pub line: Option<Rect>,
}

impl Map<'_> {
    /// Shows the map no higher than `most`; gives back the cell that was clicked, as run and row.
    pub(super) fn show(&self, ui: &mut Ui, most: f32) -> Option<(usize, String)> {
        let figure = self.axes();
        let whole = self.grid;
        let map = CellMap::begin(ui.ctx(), NAME, &figure, Field::table(whole.runs.len(), whole.channels.len()));
        let map = map.below(self.line);
        if map.is_whole() {
            return self.in_sight(ui, most, whole, map);
        }
        let part = whole.part(map.in_sight());
        Map { grid: &part, ..*self }.in_sight(ui, most, whole, map)
    }

    /// Shows what is in sight of the `whole` map.
    fn in_sight(&self, ui: &mut Ui, most: f32, whole: &Grid, map: CellMap<'_>) -> Option<(usize, String)> {
        let font = theme::font(size::SMALL);
        let width = |name: &String| ui.painter().layout_no_wrap(tr(name), font.clone(), Color32::WHITE).size().x;
        let label = self.grid.channels.iter().map(width).fold(24.0, f32::max) + 10.0;
        let (columns, rows) = (self.grid.runs.len().max(1) as f32, self.grid.channels.len().max(1) as f32);
        let cell = vec2(
            ((ui.available_width() - label - 2.0) / columns).clamp(7.0, 64.0),
            ((most - HEAD - FOOT) / rows).clamp(LEAST, 26.0),
        );
        let extent = vec2(label + columns * cell.x, HEAD + rows * cell.y + FOOT);
        let mut clicked = None;
        ScrollArea::both().id_salt("map").max_height(most.max(HEAD + 24.0)).auto_shrink([false, true]).show(ui, |ui| {
            let (area, mut response) = ui.allocate_exact_size(extent, Sense::click_and_drag());
            response.widget_info(|| WidgetInfo::labeled(Role::Image, true, tr(NAME)));
            let sheet = Sheet { origin: area.min + vec2(label, HEAD), cell };
            let in_sight = sheet.columns(ui.clip_rect(), self.grid.runs.len());
            self.head(ui, area, &sheet, in_sight.clone());
            self.cells(ui, &sheet, in_sight, self.numbered(ui, cell));
            if let Some((row, column)) = response.hover_pos().and_then(|p| self.at(&sheet, p)) {
                response.clone().on_hover_text_at_pointer(tr(self.words(row, column)));
            }
            if self.grid.runs.len() * self.grid.channels.len() <= MANY {
                clicked = self.nodes(ui, &sheet, &mut response);
            } else if let Some((row, column)) = response.interact_pointer_pos().and_then(|p| self.at(&sheet, p)) {
                clicked = response.clicked().then(|| (self.grid.runs[column], self.grid.channels[row].clone()));
            }
            let ground = Rect::from_min_size(sheet.origin, cell * vec2(columns, rows));
            let value = |[column, row]: [usize; 2]| Some(100.0 * (*whole.cells.get(row)?.get(column)?)?.error);
            map.end(ui, &response, ground, Axis::new("Error", "%"), &value);
            let draw = |palette: &Palette| self.grid.draw(&self.scale, NAME, palette);
            export::offer(ui, &[response], NAME, &draw, &|| whole.table());
        });
        // With Shift a cell takes a cursor.
        clicked.filter(|_| !ui.input(|i| i.modifiers.shift))
    }

    /// Runs and channels as axes with names.
    fn axes(&self) -> Figure {
        let runs: Vec<String> = self.grid.runs.iter().map(|run| (run + 1).to_string()).collect();
        let axis = |name: &str, names: &[String]| Axis::new(name, "").ticks(Ticks::Names(names.into()));
        Figure::new(NAME, axis("Run", &runs), axis("", &self.grid.channels))
    }

    /// Names of the channels, and numbers of the runs in the `columns` in sight.
    fn head(&self, ui: &Ui, area: Rect, sheet: &Sheet, columns: Range<usize>) {
        let (palette, font) = (ui.palette(), theme::font(size::SMALL));
        let painter = ui.painter();
        let step = (22.0 / sheet.cell.x).ceil().max(1.0) as usize;
        let selected = self.selected.map(|(run, _)| run);
        let corner = pos2(sheet.origin.x - 6.0, area.top() + 0.5 * HEAD);
        painter.text(corner, Align2::RIGHT_CENTER, t!("run"), font.clone(), palette.weak);
        for (k, &run) in self.grid.runs.iter().enumerate().take(columns.end).skip(columns.start) {
            if k % step != 0 && selected != Some(run) {
                continue;
            }
            let at = pos2(sheet.rect(0, k).center().x, area.top() + 0.5 * HEAD);
            let colour = if selected == Some(run) { palette.accent } else { palette.weak };
            painter.text(at, Align2::CENTER_CENTER, run + 1, font.clone(), colour);
        }
        for (row, name) in self.grid.channels.iter().enumerate() {
            let at = pos2(sheet.origin.x - 6.0, sheet.rect(row, 0).center().y);
            let lit = self.selected.is_some_and(|(_, channel)| channel == name);
            let colour = if lit { palette.accent } else { palette.ink };
            painter.text(at, Align2::RIGHT_CENTER, tr(name), font.clone(), colour);
        }
    }

    /// Whether cells of that size hold their numbers.
    fn numbered(&self, ui: &Ui, cell: Vec2) -> bool {
        let fits = |c: &Cell| width(ui, &error_map::percent(*c), figures()) + ABOUT <= cell.x;
        cell.y >= READABLE.y && cell.x >= READABLE.x && self.grid.cells.iter().flatten().flatten().all(fits)
    }

    /// The cells in the `columns` in sight.
    fn cells(&self, ui: &Ui, sheet: &Sheet, columns: Range<usize>, numbered: bool) {
        let palette = ui.palette();
        let font = figures();
        for (row, cells) in self.grid.cells.iter().enumerate() {
            for (column, cell) in cells.iter().enumerate().take(columns.end).skip(columns.start) {
                let rect = sheet.rect(row, column).shrink(0.5);
                let Some(cell) = cell else {
                    ui.painter().rect_stroke(rect, 1.5, theme::hair(palette.line), StrokeKind::Inside);
                    continue;
                };
                let fill = shade(palette, &self.scale, *cell, self.stale);
                ui.painter().rect_filled(rect, 1.5, fill);
                if !self.grid.used[column] {
                    hatch(ui, rect, palette.weak);
                } else if numbered {
                    let text = numbers::local(&error_map::percent(*cell)).into_owned();
                    ui.painter().text(rect.center(), Align2::CENTER_CENTER, text, font.clone(), palette.text_on(fill));
                }
            }
        }
        let place = self.selected.and_then(|(run, channel)| {
            let column = self.grid.runs.iter().position(|&r| r == run)?;
            Some((self.grid.channels.iter().position(|c| c == channel)?, column))
        });
        if let Some((row, column)) = place {
            let rect = sheet.rect(row, column);
            ui.painter().rect_stroke(rect, 2.0, Stroke::new(2.0, palette.accent), StrokeKind::Outside);
        }
    }

    /// Every cell reached by Tab and read aloud; what the pointer does to one it does to the `whole`.
    fn nodes(&self, ui: &mut Ui, sheet: &Sheet, whole: &mut Response) -> Option<(usize, String)> {
        let mut clicked = None;
        for (row, channel) in self.grid.channels.iter().enumerate() {
            for (column, &run) in self.grid.runs.iter().enumerate() {
                if self.grid.cells[row][column].is_none() {
                    continue;
                }
                let id = ui.scope_id().with(("cell", channel, run));
                let response = ui.interact(sheet.rect(row, column), id, Sense::click());
                let chosen = self.selected == Some((run, channel));
                response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, tr(self.words(row, column))));
                if response.has_focus() {
                    let stroke = theme::pen(ui.palette().accent);
                    ui.painter().rect_stroke(sheet.rect(row, column), 2.0, stroke, StrokeKind::Outside);
                }
                if response.clicked() {
                    clicked = Some((run, channel.clone()));
                }
                *whole = whole.union(response.on_hover_text(tr(self.words(row, column))));
            }
        }
        clicked
    }

    fn at(&self, sheet: &Sheet, pointer: Pos2) -> Option<(usize, usize)> {
        let at = ((pointer - sheet.origin) / sheet.cell).floor();
        let inside = at.x >= 0.0 && at.y >= 0.0;
        let (row, column) = (at.y as usize, at.x as usize);
        (inside && row < self.grid.channels.len() && column < self.grid.runs.len()).then_some((row, column))
    }

    /// `Run 3, 10.4 Hz, level 2, acc@7: error 23.1 %, noise floor 0.31 %`.
    fn words(&self, row: usize, column: usize) -> String {
        let (index, channel) = (self.grid.runs[column], &self.grid.channels[row]);
        let (run, record) = (self.project.runs.get(index), self.project.transient_runs.get(index));
        let level = run.map_or_else(|| record.and_then(|r| r.level), |r| r.level);
        let level = level.map_or_else(String::new, |l| format!(", level {l}"));
        let steady = run.map(|run| format::with_unit(run.frequency_hz(), "Hz"));
        let which = steady.or_else(|| record.map(|r| r.file.clone())).unwrap_or_default();
        let what = if channel == ENERGY { "energy" } else { channel };
        let Some(cell) = self.grid.cells[row][column] else { return format!("Run {}: no {channel}", index + 1) };
        format!(
            "Run {}, {which}{level}, {what}: error {}, noise floor {}{}",
            index + 1,
            in_words(cell.error),
            format::percent(cell.noise_floor),
            if self.grid.used[column] { "" } else { ", not used" }
        )
    }
}

/// Font of the numbers in cells.
fn figures() -> FontId {
    theme::font(size::SMALL - 0.5)
}

/// Height of a map whose cells are `cell` points high.
pub(super) fn height(grid: &Grid, cell: f32) -> f32 {
    HEAD + cell * grid.channels.len().max(1) as f32 + FOOT
}

/// Where cells stand.
struct Sheet {
    origin: Pos2,
    cell: Vec2,
}

impl Sheet {
    fn rect(&self, row: usize, column: usize) -> Rect {
        Rect::from_min_size(self.origin + self.cell * vec2(column as f32, row as f32), self.cell)
    }

    /// Those of `count` columns that are in sight, whole or in part.
    fn columns(&self, sight: Rect, count: usize) -> Range<usize> {
        let column = |x: f32| ((x - self.origin.x) / self.cell.x).max(0.0);
        let (first, last) = (column(sight.left()).floor() as usize, column(sight.right()).ceil() as usize);
        first.min(count)..last.min(count)
    }
}

/// Colour of a cell: that of the ground where the error is noise.
fn shade(palette: &Palette, scale: &Scale, cell: Cell, stale: bool) -> Color32 {
    let colour = error_map::shade(palette, scale, cell);
    if stale { palette.pane.lerp_to_gamma(colour, 0.45) } else { colour }
}

/// Slanted lines over a run that takes no part.
fn hatch(ui: &Ui, rect: Rect, colour: Color32) {
    let painter = ui.painter_at(rect);
    let mut x = rect.left() - rect.height();
    while x < rect.right() {
        let line = [pos2(x, rect.bottom()), pos2(x + rect.height(), rect.top())];
        painter.line_segment(line, Stroke::new(1.0, colour.gamma_multiply(0.6)));
        x += 5.0;
    }
}

/// The scale of colours with its ends, round values and the noise floor.
pub(super) fn legend(ui: &mut Ui, scale: &Scale) -> Response {
    let palette = ui.palette();
    let font = theme::font(size::SMALL);
    let (area, response) = ui.allocate_exact_size(vec2(ui.available_width(), 28.0), Sense::hover());
    let painter = ui.painter();
    let noise = Rect::from_min_size(area.min + vec2(0.0, 1.0), vec2(16.0, 9.0));
    painter.rect(noise, 2.0, palette.raised, theme::hair(palette.line), StrokeKind::Inside);
    let below = noise.bottom() + 2.0;
    let floor = format!("floor {}", format::percent(scale.floor));
    // The floor stands under the left end where it is least, beside the word of the box before it.
    let left = width(ui, "noise", font.clone()) + 0.5 * width(ui, &floor, font.clone()) + 8.0;
    let ends = [area.left() + left.max(78.0), area.right() - 30.0];
    let bar = Rect::from_x_y_ranges(ends[0]..=ends[1], noise.y_range());
    for k in 0..STEPS {
        let abscissa = |k: usize| bar.left() + bar.width() * k as f32 / STEPS as f32;
        let piece = Rect::from_min_max(pos2(abscissa(k), bar.top()), pos2(abscissa(k + 1) + 0.5, bar.bottom()));
        painter.rect_filled(piece, 0.0, palette.error_shade((k as f32 + 0.5) / STEPS as f32));
    }
    painter.text(pos2(area.left(), below), Align2::LEFT_TOP, t!("noise"), font.clone(), palette.weak);
    let mark = |value: f64, text: String, colour: Color32| {
        let x = bar.left() + bar.width() * scale.share(value);
        painter.line_segment([pos2(x, bar.top() - 1.0), pos2(x, bar.bottom() + 2.0)], theme::hair(colour));
        painter.text(pos2(x, below), Align2::CENTER_TOP, tr(text), font.clone(), colour);
    };
    mark(scale.floor, floor, palette.ink);
    let clear = |v: &f64| bar.width() * scale.share(*v) > 62.0 && bar.width() * (1.0 - scale.share(*v)) > 34.0;
    for value in scale.ticks().into_iter().filter(clear) {
        mark(value, trimmed(value), palette.weak);
    }
    mark(scale.most, in_words(scale.most), palette.weak);
    painter.add(Shape::rect_stroke(bar, 2.0, theme::hair(palette.line), StrokeKind::Outside));
    response
}

/// A round share as per cent without trailing zeros.
fn trimmed(share: f64) -> String {
    if share > 10.0 {
        return format!("1e{:.0} %", (100.0 * share).log10());
    }
    let value = (100.0 * share * 1e6).round() / 1e6;
    format!("{value} %")
}
