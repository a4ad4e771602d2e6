//! A map of cells on the screen, with what plots have: drag pans, right drag zooms a box, double click shows all, Backspace goes
//! back, Shift and click sets two cursors. Whole cells are in sight: an axis counts them in the terms of its figure.

use super::cursors::{self, Cursors, Reading};
use super::zoom::{Sight, Zoom};
use crate::plots::figure::{Axis, Figure};
use crate::window::appearance::theme::{self, size};
use crate::window::appearance::widgets::UiExt;
use egui::{Align2, Context, Id, PointerButton, Pos2, Rect, Response, StrokeKind, Ui, Vec2, pos2, vec2};
use std::ops::Range;

/// Least side of a box that is zoomed into, points: less is a click.
const LEAST: f32 = 4.0;

/// Between a map and what is read in it, points.
const GAP: f32 = 6.0;

/// Which cells there are, and where they lie along the axes of a figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Field {
    /// Ends along x and along y, as places of the axes.
    pub whole: Sight,
    /// Cells along x and along y.
    pub count: [usize; 2],
    /// Whether rows are counted from the top, as those of a table.
    pub down: bool,
}

impl Field {
    /// A table of so many columns and rows, each a unit long about its number.
    pub(crate) fn table(columns: usize, rows: usize) -> Self {
        let ends = |count: usize| [-0.5, count as f64 - 0.5];
        Self { whole: [ends(columns), ends(rows)], count: [columns, rows], down: true }
    }

    /// Length of a cell along an axis.
    fn step(&self, axis: usize) -> f64 {
        let [from, to] = self.whole[axis];
        (to - from) / self.count[axis].max(1) as f64
    }

    /// Place along an axis in cells from its beginning.
    fn cells(&self, axis: usize, place: f64) -> f64 {
        (place - self.whole[axis][0]) / self.step(axis)
    }

    /// The cells of a range of an axis that are drawn: whole ones, at least one.
    fn drawn(&self, axis: usize, [from, to]: [f64; 2]) -> Range<usize> {
        let count = self.count[axis];
        let first = (self.cells(axis, from).round().max(0.0) as usize).min(count.saturating_sub(1));
        let last = self.cells(axis, to).round().max(0.0) as usize;
        first..last.clamp((first + 1).min(count), count)
    }

    /// The least range of whole cells about a range, within the map.
    fn widened(&self, axis: usize, range: [f64; 2]) -> [f64; 2] {
        let count = self.count[axis] as f64;
        // A box that is drawn along the edge of a cell does not take the next one.
        let [first, last] = range.map(|v| self.cells(axis, v));
        let first = (first + 1e-3).floor().clamp(0.0, (count - 1.0).max(0.0));
        let last = (last - 1e-3).ceil().clamp(first + 1.0, count.max(first + 1.0));
        [first, last].map(|k| self.whole[axis][0] + k * self.step(axis))
    }

    /// A range moved along an axis, within the map.
    fn moved(&self, axis: usize, range: [f64; 2], by: f64) -> [f64; 2] {
        let [from, to] = self.whole[axis];
        let by = by.clamp((from - range[0]).min(0.0), (to - range[1]).max(0.0));
        range.map(|v| v + by)
    }

    /// The number of the cell at a place; `None` outside.
    fn cell(&self, place: [f64; 2]) -> Option<[usize; 2]> {
        let along = |axis: usize| {
            let k = self.cells(axis, place[axis]).floor();
            (k >= 0.0 && k < self.count[axis] as f64).then_some(k as usize)
        };
        Some([along(0)?, along(1)?])
    }

    /// The middle of a cell.
    fn middle(&self, cell: [usize; 2]) -> [f64; 2] {
        [0, 1].map(|axis| self.whole[axis][0] + (cell[axis] as f64 + 0.5) * self.step(axis))
    }
}

/// What is kept from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Kept {
    field: Field,
    sight: Sight,
    /// Where the box that is being drawn begins.
    start: Option<Pos2>,
}

/// A map that is drawn now.
pub(crate) struct CellMap<'a> {
    name: &'a str,
    figure: &'a Figure,
    zoom: Zoom,
    kept: Kept,
    /// A line above the map that what is read may cover.
    line: Option<Rect>,
}

impl<'a> CellMap<'a> {
    /// Before the map of that name is drawn, on the axes of `figure`; other cells are all in sight at first.
    pub(crate) fn begin(ctx: &Context, name: &'a str, figure: &'a Figure, field: Field) -> Self {
        let zoom = Zoom::begin(ctx, name);
        let fresh = Kept { field, sight: field.whole, start: None };
        let mut kept = ctx.data(|d| d.get_temp::<Kept>(id(name))).filter(|k| k.field == field).unwrap_or(fresh);
        if let Some(sight) = zoom.placed(field.whole) {
            kept.sight = [0, 1].map(|axis| field.widened(axis, sight[axis]));
        }
        Self { name, figure, zoom, kept, line: None }
    }

    /// The same below a line of words that gives way to what is read where there is no room beside the map.
    #[must_use]
    pub(crate) fn below(self, line: Option<Rect>) -> Self {
        Self { line, ..self }
    }

    /// The columns and rows in sight.
    pub(crate) fn in_sight(&self) -> [Range<usize>; 2] {
        [0, 1].map(|axis| self.kept.field.drawn(axis, self.kept.sight[axis]))
    }

    /// Whether everything is in sight.
    pub(crate) fn is_whole(&self) -> bool {
        self.in_sight() == self.kept.field.count.map(|n| 0..n)
    }

    /// After the cells in sight were drawn into `area`: takes the gestures, draws the cursors and what is read there; `value` is that
    /// of a column and a row, on the axis `height`.
    pub(crate) fn end(
        mut self,
        ui: &Ui,
        response: &Response,
        area: Rect,
        height: Axis,
        value: &dyn Fn([usize; 2]) -> Option<f64>,
    ) {
        self.gestures(ui, response, area);
        let field = self.kept.field;
        let read = |at: [f64; 2]| {
            let [x, y] = [self.figure.x.place(at[0])?, self.figure.y.place(at[1])?];
            value(field.cell([x, y])?)
        };
        let cursors = self.cursors(ui, response, area);
        let lines = cursors.words(self.figure, Some(&Reading { axis: height, value: &read }));
        let marked: Vec<Pos2> =
            cursors.places().iter().filter_map(|at| self.seen(area, *at)).map(|(at, _)| at).collect();
        self.read_out(ui, &lines, area, response.rect, &marked);
        ui.data_mut(|d| d.insert_temp(id(self.name), self.kept));
        self.zoom.end(ui, &[(response, self.figure, self.kept.sight)]);
    }

    /// Shows what is read where it covers no cell: under a table where the `room` of its pane is left, beside it, or in the line above it;
    /// else in a corner of the map.
    fn read_out(&self, ui: &Ui, lines: &[String], area: Rect, room: Rect, marked: &[Pos2]) {
        let (painter, palette, sight) = (ui.painter(), ui.palette(), ui.clip_rect());
        let size = cursors::size(painter, lines);
        if !self.kept.field.down {
            return cursors::paint(painter, lines, palette, corner(size, area, marked));
        }
        let below = Rect::from_min_size(area.left_bottom() + vec2(0.0, GAP), size);
        if room.contains_rect(below) {
            return cursors::paint(painter, lines, palette, below.min);
        }
        let top = area.top().min(sight.bottom() - size.y).max(sight.top());
        let beside = Rect::from_min_size(pos2(area.right() + 2.0 * GAP, top), size);
        if sight.contains_rect(beside) {
            return cursors::paint(painter, lines, palette, beside.min);
        }
        let joined = [lines.join("    ")];
        let single = cursors::size(painter, &joined);
        let above = self.line.map(|line| Rect::from_min_size(line.left_center() - vec2(0.0, 0.5 * single.y), single));
        match above.filter(|above| above.right() <= sight.right()) {
            Some(above) => {
                let painter = painter.with_clip_rect(above.union(sight));
                painter.rect_filled(self.line.unwrap_or(above), 0.0, palette.pane);
                cursors::paint(&painter, &joined, palette, above.min);
            }
            None => cursors::paint(painter, lines, palette, corner(size, area, marked)),
        }
    }

    /// Box, pan, and all.
    fn gestures(&mut self, ui: &Ui, response: &Response, area: Rect) {
        let before = self.kept;
        let (box_zoom, shift) = (PointerButton::Secondary, ui.input(|i| i.modifiers.shift));
        if response.drag_started_by(box_zoom) {
            self.kept.start = ui.input(|i| i.pointer.press_origin()).map(|at| at.clamp(area.min, area.max));
        }
        let drawn = self.kept.start.zip(ui.input(|i| i.pointer.interact_pos()));
        let drawn = drawn.map(|(start, end)| Rect::from_two_pos(start, end.clamp(area.min, area.max)));
        if let Some(rect) = drawn.filter(|_| response.dragged_by(box_zoom)) {
            ui.painter().rect_stroke(rect, 0.0, theme::bold(ui.palette().accent), StrokeKind::Middle);
        } else if let Some(rect) = drawn {
            self.kept.start = None;
            if response.drag_stopped_by(box_zoom) && rect.width() >= LEAST && rect.height() >= LEAST {
                let corners = [self.place(area, rect.min), self.place(area, rect.max)];
                let range = |axis: usize| {
                    let [a, b] = corners.map(|c| c[axis]);
                    self.kept.field.widened(axis, [a.min(b), a.max(b)])
                };
                self.kept.sight = [range(0), range(1)];
            }
        }
        if response.dragged_by(PointerButton::Primary) {
            let by = response.drag_delta();
            let [from, to] = [Pos2::ZERO, Pos2::ZERO - by].map(|at| self.place(area, at));
            let sight = self.kept.sight;
            self.kept.sight = [0, 1].map(|axis| self.kept.field.moved(axis, sight[axis], to[axis] - from[axis]));
        }
        if response.double_clicked() && !shift {
            self.kept.sight = self.kept.field.whole;
        }
        if self.kept != before {
            ui.request_repaint();
        }
    }

    /// The place on the axes of a point on the screen.
    fn place(&self, area: Rect, at: Pos2) -> [f64; 2] {
        let share = (at - area.min) / area.size();
        let upwards = if self.kept.field.down { share.y } else { 1.0 - share.y };
        let [x, y] = self.drawn_range();
        [x[0] + f64::from(share.x) * (x[1] - x[0]), y[0] + f64::from(upwards) * (y[1] - y[0])]
    }

    /// The point on the screen of a place; `None` out of sight.
    fn point(&self, area: Rect, at: [f64; 2]) -> Option<Pos2> {
        let range = self.drawn_range();
        let [x, y] = [0, 1].map(|axis| ((at[axis] - range[axis][0]) / (range[axis][1] - range[axis][0])) as f32);
        let y = if self.kept.field.down { y } else { 1.0 - y };
        let inside = (0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y);
        inside.then(|| pos2(area.left() + x * area.width(), area.top() + y * area.height()))
    }

    /// Ends of what is drawn, which are those of whole cells.
    fn drawn_range(&self) -> Sight {
        let (field, cells) = (self.kept.field, self.in_sight());
        [0, 1].map(|axis| {
            let ends = [cells[axis].start, cells[axis].end];
            ends.map(|k| field.whole[axis][0] + k as f64 * field.step(axis))
        })
    }

    /// Sets a cursor in the cell that was clicked with Shift, and draws those that there are.
    fn cursors(&self, ui: &Ui, response: &Response, area: Rect) -> Cursors {
        let (ctx, field, palette) = (ui.ctx(), self.kept.field, ui.palette());
        let mut cursors = Cursors::of(ctx, self.name);
        let clicked = response.clicked() && ui.input(|i| i.modifiers.shift);
        let at = ui.input(|i| i.pointer.interact_pos()).filter(|at| clicked && area.contains(*at));
        if let Some(cell) = at.and_then(|at| field.cell(self.place(area, at))) {
            let [x, y] = field.middle(cell);
            cursors.set([self.figure.x.value(x), self.figure.y.value(y)]);
            cursors.keep(ctx, self.name);
        }
        for (k, at) in cursors.places().iter().enumerate() {
            let Some((_, cell)) = self.seen(area, *at) else { continue };
            let rect = self.mark(ui, area, cell);
            // At its corner the number leaves that of the cell to be read.
            let number = ui.painter().layout_no_wrap((k + 1).to_string(), theme::font(size::SMALL), palette.pane);
            ui.painter().circle_filled(rect.min, 0.6 * number.size().y, palette.accent);
            let place = Align2::CENTER_CENTER.anchor_size(rect.min, number.size());
            ui.painter().galley(place.min, number, palette.pane);
        }
        cursors
    }

    /// Where a cursor is on the screen, and in which cell; `None` out of sight.
    fn seen(&self, area: Rect, at: [f64; 2]) -> Option<(Pos2, [usize; 2])> {
        let place = [self.figure.x.place(at[0])?, self.figure.y.place(at[1])?];
        Some((self.point(area, place)?, self.kept.field.cell(place)?))
    }

    /// A frame about a cell.
    fn mark(&self, ui: &Ui, area: Rect, cell: [usize; 2]) -> Rect {
        let [columns, rows] = self.in_sight();
        let across = area.width() / columns.len().max(1) as f32;
        let high = area.height() / rows.len().max(1) as f32;
        let column = (cell[0] - columns.start) as f32;
        let row = if self.kept.field.down { cell[1] - rows.start } else { rows.end - 1 - cell[1] } as f32;
        let corner = area.min + vec2(column * across, row * high);
        let rect = Rect::from_min_size(corner, vec2(across, high));
        ui.painter().rect_stroke(rect, 1.0, theme::pen(ui.palette().accent), StrokeKind::Middle);
        rect
    }
}

/// Where a box of what is read stands within a map: in the corner in which no marked cell is.
fn corner(size: Vec2, area: Rect, marked: &[Pos2]) -> Pos2 {
    let inner = area.shrink(GAP);
    let ends = [inner.min, inner.max - size];
    let corners = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[i, j]| pos2(ends[i].x, ends[j].y));
    let free = |at: &Pos2| {
        let ground = Rect::from_min_size(*at, size).expand(3.0 * GAP);
        marked.iter().all(|mark| !ground.contains(*mark))
    };
    corners.into_iter().find(free).unwrap_or(inner.min)
}

fn id(name: &str) -> Id {
    Id::NULL.with(("cells", name))
}

#[cfg(test)]
mod tests {
    use super::Field;

    #[test]
    fn boxes_take_whole_cells_and_pans_stay_within_the_map() {
        let field = Field::table(10, 4);
        assert_eq!(field.widened(0, [1.7, 3.2]), [1.5, 3.5]);
        assert_eq!(field.drawn(0, [1.5, 3.5]), 2..4);
        assert_eq!(field.widened(1, [-7.0, 90.0]), field.whole[1]);
        assert_eq!(field.moved(0, [1.5, 3.5], -5.0), [-0.5, 1.5]);
        assert_eq!(field.moved(0, [1.5, 3.5], 50.0), [7.5, 9.5]);
        assert_eq!((field.cell([9.4, 0.2]), field.cell([9.6, 0.2])), (Some([9, 0]), None));
        assert_eq!(field.middle([3, 2]), [3.0, 2.0]);
        // Without cells there is nothing to see, and no panic.
        let empty = Field::table(0, 0);
        assert_eq!((empty.drawn(0, [0.0, 1.0]), empty.cell([0.0, 0.0])), (0..0, None));
    }
}
