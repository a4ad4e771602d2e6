//! Plots side by side or under each other as one drawing: the layout of what is exported.

use super::drawing::{Drawing, Mark, Stroke};
use super::figure::{Figure, Look, Series};
use super::style::{self as theme, Palette, size};
use super::ticks;
use ecolor::Color32;
use emath::{Align2, Pos2, Rect, Vec2, pos2, vec2};

const LEFT: f32 = 66.0;
const RIGHT: f32 = 18.0;
const TOP: f32 = 40.0;
const BOTTOM: f32 = 46.0;
/// A row of keys; the mark of a key with the room before its words, a letter of them at most, the room to the next key.
const KEY_ROW: f32 = 15.0;
const KEY: f32 = 22.0;
const LETTER: f32 = 6.2;
const BETWEEN: f32 = 18.0;

/// A plot with what is in sight of it: places of x and of y.
#[derive(Debug, Clone)]
pub(crate) struct Panel {
    /// The plot.
    pub figure: Figure,
    /// First and last place in sight on both axes.
    pub bounds: [[f64; 2]; 2],
}

/// Plots that belong together.
#[derive(Debug, Clone)]
pub(crate) struct Sheet {
    /// What they show together.
    pub title: String,
    /// Plots side by side; the others stand below.
    pub columns: usize,
    /// The plots.
    pub panels: Vec<Panel>,
}

impl Sheet {
    /// Plots under each other with all of them in sight.
    pub(crate) fn of(title: &str, figures: Vec<Figure>) -> Self {
        let panels = figures.into_iter().map(|figure| Panel { bounds: figure.bounds(), figure }).collect();
        Self { title: title.to_owned(), columns: 1, panels }
    }

    /// Width and height of its paper, points: square for plots with equal units, higher for more plots.
    pub(crate) fn paper(&self) -> Vec2 {
        let square = self.panels.iter().any(|p| p.figure.square);
        let rows = self.panels.len().div_ceil(self.columns.max(1));
        let more = rows.saturating_sub(1) as f32;
        if square { vec2(640.0, 600.0) } else { vec2(900.0, 300.0 + 220.0 * more) }
    }

    /// All values in sight as a table with tabs.
    pub(crate) fn table(&self) -> String {
        let panel_as_text = |p: &Panel| {
            let [from, to] = p.bounds[0].map(|v| p.figure.x.value(v));
            p.figure.table(from, to)
        };
        self.panels.iter().map(panel_as_text).collect()
    }

    /// The drawing of `size` points.
    pub(crate) fn drawing(&self, size: Vec2, palette: &Palette) -> Drawing {
        let mut drawing = Drawing::new(size, palette.canvas, &self.title);
        drawing.words(pos2(16.0, 20.0), Align2::LEFT_CENTER, self.title.clone(), size::HEADING, palette.ink);
        let columns = self.columns.clamp(1, self.panels.len().max(1));
        let rows = self.panels.len().div_ceil(columns).max(1);
        let room = Rect::from_min_max(pos2(0.0, 34.0), size.to_pos2());
        let cell = vec2(room.width() / columns as f32, room.height() / rows as f32);
        let keys = |panel: &Panel| panel.keys(cell.x).len().saturating_sub(1) as f32 * KEY_ROW;
        for (row, panels) in self.panels.chunks(columns).enumerate() {
            // Plots beside each other are of one height, whatever their keys need.
            let keys = panels.iter().map(keys).fold(0.0, f32::max);
            for (column, panel) in panels.iter().enumerate() {
                let corner = room.min + vec2(column as f32 * cell.x, row as f32 * cell.y);
                let outer = Rect::from_min_size(corner, cell);
                let mut area = inner(outer);
                area.min.y += keys;
                panel.fitted(area).draw(&mut drawing, outer, area, palette);
            }
        }
        drawing
    }
}

/// The area of the curves within the area of a plot with its rulers, below one row of keys.
pub(crate) fn inner(outer: Rect) -> Rect {
    Rect::from_min_max(outer.min + vec2(LEFT, TOP), outer.max - vec2(RIGHT, BOTTOM))
}

impl Panel {
    /// The same with equal lengths along both axes where the plot asks for it: more is in sight of one of them.
    fn fitted(&self, area: Rect) -> Self {
        let mut panel = self.clone();
        if self.figure.square {
            let length = |[low, high]: [f64; 2]| high - low;
            let sides = [f64::from(area.width()), f64::from(area.height())];
            let scale = (length(self.bounds[0]) / sides[0]).max(length(self.bounds[1]) / sides[1]);
            for (bounds, side) in panel.bounds.iter_mut().zip(sides) {
                let more = 0.5 * (scale * side - length(*bounds));
                *bounds = [bounds[0] - more, bounds[1] + more];
            }
        }
        panel
    }

    /// Where a point x, y of the data stands in `area`; `None` for what has no place on the axes.
    pub(crate) fn at(&self, [x, y]: [f64; 2], area: Rect) -> Option<Pos2> {
        let share = |place: f64, [low, high]: [f64; 2]| ((place - low) / (high - low)) as f32;
        let (x, y) = (self.figure.x.place(x)?, self.figure.y.place(y)?);
        let (u, v) = (share(x, self.bounds[0]), share(y, self.bounds[1]));
        Some(pos2(area.left() + u * area.width(), area.bottom() - v * area.height()))
    }

    /// Share of the height at which a value of y stands.
    fn height(&self, y: f64) -> Option<f32> {
        let [low, high] = self.bounds[1];
        Some(((self.figure.y.place(y)? - low) / (high - low)) as f32)
    }

    fn draw(&self, drawing: &mut Drawing, outer: Rect, area: Rect, palette: &Palette) {
        self.head(drawing, outer, palette);
        self.grid(drawing, area, palette);
        drawing.marks.push(Mark::Inside(area, self.figure.title.clone()));
        for series in &self.figure.series {
            self.series(drawing, series, area);
        }
        for label in &self.figure.labels {
            if let Some(at) = self.at(label.at, area) {
                drawing.words(at, Align2::RIGHT_BOTTOM, label.text.clone(), size::SMALL, label.colour);
            }
        }
        drawing.marks.push(Mark::Whole);
        drawing.rect(area, Color32::TRANSPARENT, theme::hair(palette.line));
    }

    /// Title and key above the curves.
    fn head(&self, drawing: &mut Drawing, outer: Rect, palette: &Palette) {
        let y = outer.top() + 24.0;
        let x = outer.left() + LEFT;
        // A plot alone bears its name already as that of the sheet.
        if self.figure.title != drawing.title {
            drawing.words(pos2(x, y - 16.0), Align2::LEFT_CENTER, self.figure.title.clone(), size::BODY, palette.ink);
        }
        for (row, keys) in self.keys(outer.width()).into_iter().enumerate() {
            let y = y + row as f32 * KEY_ROW;
            for (from, series) in keys {
                key(drawing, series, pos2(x + from, y));
                let at = pos2(x + from + KEY, y);
                drawing.words(at, Align2::LEFT_CENTER, series.name.clone(), size::SMALL, palette.weak);
            }
        }
    }

    /// Series with names, each name once, in rows of a plot of this width with its rulers; with the place in the row.
    fn keys(&self, width: f32) -> Vec<Vec<(f32, &Series)>> {
        let room = width - LEFT - RIGHT;
        let mut rows: Vec<Vec<(f32, &Series)>> = vec![Vec::new()];
        let (mut x, mut seen) = (0.0, vec![""]);
        for series in &self.figure.series {
            if seen.contains(&series.name.as_str()) {
                continue;
            }
            seen.push(&series.name);
            let words = LETTER * series.name.chars().count() as f32;
            if x > 0.0 && x + KEY + words > room {
                rows.push(Vec::new());
                x = 0.0;
            }
            if let Some(row) = rows.last_mut() {
                row.push((x, series));
            }
            x += KEY + words + BETWEEN;
        }
        rows
    }

    fn grid(&self, drawing: &mut Drawing, area: Rect, palette: &Palette) {
        let line = |strong: bool| theme::hair(if strong { palette.line } else { palette.line.gamma_multiply(0.5) });
        let [xs, ys] = self.bounds;
        for rule in ticks::rules(&self.figure.x, xs, area.width()) {
            let x = area.left() + ((rule.at - xs[0]) / (xs[1] - xs[0])) as f32 * area.width();
            drawing.line([pos2(x, area.top()), pos2(x, area.bottom())], line(rule.strong));
            let at = pos2(x, area.bottom() + 10.0);
            drawing.words(at, Align2::CENTER_CENTER, rule.label, size::SMALL, palette.weak);
        }
        for rule in ticks::rules(&self.figure.y, ys, 1.6 * area.height()) {
            let y = area.bottom() - ((rule.at - ys[0]) / (ys[1] - ys[0])) as f32 * area.height();
            drawing.line([pos2(area.left(), y), pos2(area.right(), y)], line(rule.strong));
            // Where both axes have long labels, those of the corner would touch.
            if !self.figure.square || y < area.bottom() - 10.0 {
                let at = pos2(area.left() - 6.0, y);
                drawing.words(at, Align2::RIGHT_CENTER, rule.label, size::SMALL, palette.weak);
            }
        }
        let below = pos2(area.center().x, area.bottom() + 30.0);
        drawing.words(below, Align2::CENTER_CENTER, self.figure.x.label(), size::SMALL, palette.ink);
        drawing.marks.push(Mark::Words {
            at: pos2(area.left() - 52.0, area.center().y),
            align: Align2::CENTER_CENTER,
            text: self.figure.y.label(),
            size: size::SMALL,
            colour: palette.ink,
            upright: true,
        });
    }

    fn series(&self, drawing: &mut Drawing, series: &Series, area: Rect) {
        let [from, to] = self.bounds[0].map(|v| self.figure.x.value(v));
        let points = series.points(from, to, area.width() as usize);
        let places: Vec<Pos2> = points.iter().filter_map(|p| self.at(*p, area)).collect();
        let stroke = |width: f32| Stroke::new(width, series.colour);
        match series.look {
            Look::Line(width) => drawing.line(places, stroke(width)),
            Look::Dashed(width) | Look::Dotted(width) => {
                drawing.marks.push(Mark::Line { points: places, stroke: stroke(width), dashed: true });
            }
            Look::Dots(radius) => disc(drawing, &places, radius, series.colour, Stroke::NONE),
            Look::Rings(radius) => disc(drawing, &places, radius, Color32::TRANSPARENT, stroke(1.6)),
            Look::Bars(width) => self.bars(drawing, series, &points, width, area),
            Look::Uprights(width) => places.iter().for_each(|p| {
                drawing.line([pos2(p.x, area.top()), pos2(p.x, area.bottom())], stroke(width));
            }),
            Look::Levels(width) => {
                for share in points.iter().filter_map(|p| self.height(p[1])) {
                    let y = area.bottom() - share * area.height();
                    let level = vec![pos2(area.left(), y), pos2(area.right(), y)];
                    drawing.marks.push(Mark::Line { points: level, stroke: stroke(width), dashed: true });
                }
            }
        }
        self.deviations(drawing, series, &points, area);
    }

    fn bars(&self, drawing: &mut Drawing, series: &Series, points: &[[f64; 2]], width: f64, area: Rect) {
        for &[x, y] in points {
            let ends = [[x - 0.5 * width, 0.0], [x + 0.5 * width, y]].map(|p| self.at(p, area));
            if let [Some(a), Some(b)] = ends {
                drawing.rect(Rect::from_two_pos(a, b), series.colour, Stroke::NONE);
            }
        }
    }

    fn deviations(&self, drawing: &mut Drawing, series: &Series, points: &[[f64; 2]], area: Rect) {
        let least = self.figure.least();
        for (&point, &d) in points.iter().zip(&series.deviation) {
            let ends = self.figure.deviation_bar(point, d, least).map(|p| self.at(p, area));
            if let [Some(a), Some(b)] = ends {
                drawing.line([a, b], Stroke::new(1.4, series.colour));
            }
        }
    }
}

fn disc(drawing: &mut Drawing, places: &[Pos2], radius: f32, fill: Color32, stroke: Stroke) {
    drawing.marks.extend(places.iter().map(|&centre| Mark::Disc { centre, radius, fill, stroke }));
}

fn key(drawing: &mut Drawing, series: &Series, at: Pos2) {
    let middle = at + vec2(8.0, 0.0);
    match series.look {
        Look::Dots(_) => disc(drawing, &[middle], 3.5, series.colour, Stroke::NONE),
        Look::Rings(_) => disc(drawing, &[middle], 4.0, Color32::TRANSPARENT, Stroke::new(1.6, series.colour)),
        Look::Bars(_) => {
            drawing.rect(Rect::from_center_size(middle, vec2(12.0, 8.0)), series.colour, Stroke::NONE);
        }
        Look::Dashed(_) | Look::Dotted(_) | Look::Levels(_) => {
            let stroke = Stroke::new(1.6, series.colour);
            drawing.marks.push(Mark::Line { points: vec![at, at + vec2(16.0, 0.0)], stroke, dashed: true });
        }
        _ => drawing.line([at, at + vec2(16.0, 0.0)], Stroke::new(2.0, series.colour)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plots::figure::Axis;

    /// Keys that are too many for the width of their plot go on in another row; a name that stands twice has one key.
    #[test]
    fn keys_stay_within_their_plot() {
        let names = ["identified", "viscous dashpot", "9.69 s", "6.50 s", "7.17 s", "identified", ""];
        let empty = Figure::new("Missing force", Axis::new("Displacement", "m"), Axis::new("Force", "N"));
        let add = |figure: Figure, name: &str| figure.points(name, Color32::BLACK, Look::Line(1.0), Vec::new());
        let figure = names.iter().fold(empty, |figure, name| add(figure, name));
        let panel = Panel { figure, bounds: [[0.0, 1.0]; 2] };
        for (width, rows) in [(900.0, 1), (450.0, 2), (200.0, 5)] {
            let keys = panel.keys(width);
            assert_eq!((keys.len(), keys.iter().flatten().count()), (rows, 5), "{width}");
            let ends = keys.iter().flatten().map(|(x, s)| x + KEY + LETTER * s.name.len() as f32);
            assert!(ends.fold(0.0, f32::max) <= width - LEFT - RIGHT, "{width}");
        }
    }
}
