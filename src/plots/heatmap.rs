//! A symmetric matrix as a heat map with its numbers.

use super::drawing::{Drawing, Stroke};
use super::style::{self as theme, Palette, size};
use crate::display::format;
use ecolor::Color32;
use emath::{Align2, Pos2, Rect, Vec2, pos2, vec2};
use faer::Mat;

/// A matrix with the labels of its rows.
#[derive(Debug, Clone, Copy)]
pub struct HeatMap<'a> {
    /// Values.
    pub matrix: &'a Mat<f64>,
    /// Rows shown.
    pub rows: &'a [usize],
    /// Columns shown.
    pub columns: &'a [usize],
    /// Label of every row of the matrix.
    pub labels: &'a [String],
    /// Unit of the values.
    pub unit: &'a str,
    /// Magnitude of the strongest colour where maps are compared; `None` is the largest in sight.
    pub scale: Option<f64>,
}

/// Rows with an entry that is not zero.
pub fn occupied(matrix: &Mat<f64>) -> Vec<usize> {
    (0..matrix.nrows()).filter(|&i| (0..matrix.ncols()).any(|j| matrix[(i, j)] != 0.0)).collect()
}

/// Room for labels above, and the least at the left.
const LABEL: f32 = 30.0;
/// Room for the scale of colours at the right, and its least height with the unit above.
const SCALE: f32 = 66.0;
const LEAST_SCALE: f32 = 58.0;
/// Largest side of a cell: a matrix of two rows fills no whole screen.
const LARGEST: f32 = 128.0;
/// What the labels are, in the corner, and its room.
const CORNER: &str = "DOF";
const BESIDE: f32 = 36.0;
/// Width of a letter of a label.
const LETTER: f32 = 6.4;

/// Where the cells stand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cells {
    origin: Pos2,
    cell: f32,
}

impl Cells {
    /// Their area, so many across and so many down.
    pub fn area(&self, across: usize, down: usize) -> Rect {
        Rect::from_min_size(self.origin, self.cell * vec2(across as f32, down as f32))
    }
}

impl HeatMap<'_> {
    /// It with its title, for a file.
    pub fn paper(&self, title: &str, palette: &Palette) -> Drawing {
        let room = Rect::from_min_max(pos2(16.0, 48.0), pos2(704.0, 644.0));
        let used = LABEL + (self.rows.len() as f32 * self.cell(room)).max(LEAST_SCALE) + 16.0;
        let mut drawing = Drawing::new(vec2(720.0, room.top() + used), palette.canvas, title);
        drawing.words(pos2(16.0, 20.0), Align2::LEFT_CENTER, title, size::HEADING, palette.ink);
        self.draw(&mut drawing, room, palette);
        drawing
    }

    /// Row and column of the matrix under a point.
    pub fn at(&self, cells: Cells, at: Pos2) -> Option<[usize; 2]> {
        let at = ((at - cells.origin) / cells.cell).floor();
        let among = |list: &[usize], v: f32| (v >= 0.0).then_some(v as usize).and_then(|k| list.get(k).copied());
        Some([among(self.rows, at.y)?, among(self.columns, at.x)?])
    }

    /// Characters of the longest label.
    fn longest(&self) -> f32 {
        let shown = self.rows.iter().chain(self.columns);
        shown.map(|&i| self.labels[i].chars().count()).max().unwrap_or(1) as f32
    }

    /// Room for the labels at the left.
    fn left(&self) -> f32 {
        (LETTER * self.longest() + 12.0).max(BESIDE)
    }

    /// Side of a cell that fits into `room`.
    fn cell(&self, room: Rect) -> f32 {
        let [across, down] = [self.columns, self.rows].map(|list| list.len().max(1) as f32);
        ((room.width() - self.left() - SCALE) / across).min((room.height() - LABEL - 10.0) / down).clamp(2.0, LARGEST)
    }

    /// Draws it into `room`; gives back where its cells stand.
    pub fn draw(&self, drawing: &mut Drawing, room: Rect, palette: &Palette) -> Cells {
        let cell = self.cell(room);
        let cells = Cells { origin: room.min + vec2(self.left(), LABEL), cell };
        let ground = cells.area(self.columns.len(), self.rows.len());
        if cell < 8.0 {
            drawing.rect(ground, palette.raised, Stroke::NONE);
        }
        let largest = self.largest();
        let type_size = size::SMALL.min(0.30 * cell + 2.0);
        let every = ((LETTER * self.longest() + 5.0).max(13.0) / cell).ceil().max(1.0) as usize;
        self.labels(drawing, cells, every, palette);
        for (r, &i) in self.rows.iter().enumerate() {
            for (c, &j) in self.columns.iter().enumerate() {
                let value = self.matrix[(i, j)];
                if value == 0.0 && cell < 8.0 {
                    continue; // the ground shows through
                }
                let at = cells.origin + vec2(c as f32 * cell, r as f32 * cell);
                let rect = Rect::from_min_size(at, Vec2::splat(cell)).shrink((0.02 * cell).min(0.5));
                let fill = if value == 0.0 { palette.raised } else { palette.diverging((value / largest) as f32) };
                drawing.rect(rect, fill, Stroke::NONE);
                if cell < 30.0 || value == 0.0 {
                    continue;
                }
                let text = format::significant(value, 3);
                // A number that is wider than its cell would run into the next one.
                if LETTER * text.chars().count() as f32 + 2.0 <= cell {
                    drawing.words(rect.center(), Align2::CENTER_CENTER, text, type_size, palette.text_on(fill));
                }
            }
        }
        drawing.rect(ground, Color32::TRANSPARENT, theme::hair(palette.line));
        self.scale(drawing, ground, palette);
        cells
    }

    /// Labels of columns above and of rows at the left, one in `every`.
    fn labels(&self, drawing: &mut Drawing, cells: Cells, every: usize, palette: &Palette) {
        let middle = |k: usize| (k as f32 + 0.5) * cells.cell;
        // Wide labels over narrow cells reach into the corner.
        if LETTER * self.longest() <= cells.cell + 12.0 {
            drawing.words(cells.origin - Vec2::splat(8.0), Align2::RIGHT_BOTTOM, CORNER, size::SMALL, palette.weak);
        }
        let mut write = |at: Pos2, align: Align2, label: usize| {
            drawing.words(at, align, self.labels[label].clone(), size::SMALL, palette.weak);
        };
        for (c, &j) in self.columns.iter().enumerate().step_by(every) {
            write(cells.origin + vec2(middle(c), -8.0), Align2::CENTER_BOTTOM, j);
        }
        for (r, &i) in self.rows.iter().enumerate().step_by(every) {
            write(cells.origin + vec2(-8.0, middle(r)), Align2::RIGHT_CENTER, i);
        }
    }

    /// The scale of colours at the right, as high as the cells; only the half that occurs.
    fn scale(&self, drawing: &mut Drawing, cells: Rect, palette: &Palette) {
        const STEPS: usize = 40;
        let largest = self.largest();
        let negative = self.rows.iter().any(|&i| self.columns.iter().any(|&j| self.matrix[(i, j)] < 0.0));
        let low = if negative { -1.0 } else { 0.0 };
        let height = cells.height().clamp(LEAST_SCALE, 220.0);
        let bar = Rect::from_min_size(cells.right_top() + vec2(14.0, 24.0), vec2(10.0, height - 24.0));
        for k in 0..STEPS {
            let share = 1.0 - (1.0 - low) * (k as f32 + 0.5) / STEPS as f32;
            let top = bar.top() + bar.height() * k as f32 / STEPS as f32;
            let strip =
                Rect::from_min_size(pos2(bar.left(), top), vec2(bar.width(), bar.height() / STEPS as f32 + 0.5));
            drawing.rect(strip, palette.diverging(share), Stroke::NONE);
        }
        drawing.rect(bar, Color32::TRANSPARENT, theme::hair(palette.line));
        let unit = format::pretty_unit(self.unit);
        drawing.words(cells.right_top() + vec2(14.0, 6.0), Align2::LEFT_CENTER, unit, size::SMALL, palette.weak);
        // Between the ends only where its label has room.
        let ends: &[f32] = match negative {
            true if bar.height() >= 4.0 * size::SMALL => &[1.0, 0.0, -1.0],
            true => &[1.0, -1.0],
            false => &[1.0, 0.0],
        };
        for &share in ends {
            let y = bar.top() + bar.height() * (1.0 - share) / (1.0 - low);
            let text = format::significant(f64::from(share) * largest, 3);
            drawing.words(pos2(bar.right() + 5.0, y), Align2::LEFT_CENTER, text, size::SMALL, palette.weak);
        }
    }

    /// Magnitude of the strongest colour.
    pub(crate) fn largest(&self) -> f64 {
        if let Some(scale) = self.scale.filter(|s| *s > 0.0) {
            return scale;
        }
        let all = self.rows.iter().flat_map(|&i| self.columns.iter().map(move |&j| self.matrix[(i, j)].abs()));
        all.fold(f64::MIN_POSITIVE, f64::max)
    }

    /// The shown rows with their labels as a table with tabs.
    pub fn table(&self) -> String {
        let mut text = self.unit.to_owned();
        self.columns.iter().for_each(|&j| text += &format!("\t{}", self.labels[j]));
        for &i in self.rows {
            text += &format!("\n{}", self.labels[i]);
            self.columns.iter().for_each(|&j| text += &format!("\t{:e}", self.matrix[(i, j)]));
        }
        text + "\n"
    }

    /// All values that are not zero, row by row, for screen readers and tests.
    pub fn words(&self) -> String {
        let mut text = String::from("Matrix");
        for &i in self.rows {
            for &j in self.columns {
                if self.matrix[(i, j)] != 0.0 && text.len() < 4000 {
                    text.push_str(&format!(
                        "; {} {} {}",
                        self.labels[i],
                        self.labels[j],
                        format::significant(self.matrix[(i, j)], 3)
                    ));
                }
            }
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::{Cells, HeatMap, occupied};
    use emath::pos2;
    use faer::Mat;

    #[test]
    fn rows_without_entries_are_left_out() {
        let mut m = Mat::<f64>::zeros(4, 4);
        m[(1, 3)] = 2.0;
        m[(3, 1)] = 2.0;
        assert_eq!(occupied(&m), [1, 3]);
    }

    #[test]
    fn cells_are_found_and_tabled() {
        let m = Mat::from_fn(3, 3, |i, j| (10 * i + j) as f64);
        let labels = ["a", "b", "c"].map(str::to_owned);
        let map = HeatMap { matrix: &m, rows: &[0, 2], columns: &[0, 2], labels: &labels, unit: "N s/m", scale: None };
        let cells = Cells { origin: pos2(30.0, 30.0), cell: 20.0 };
        assert_eq!(map.at(cells, pos2(51.0, 35.0)), Some([0, 2]));
        assert_eq!(map.at(cells, pos2(29.0, 35.0)), None);
        assert_eq!(map.at(cells, pos2(71.0, 35.0)), None);
        assert_eq!(map.table(), "N s/m\ta\tc\na\t0e0\t2e0\nc\t2e1\t2.2e1\n");
        // A part of it has columns of its own.
        let part = HeatMap { rows: &[2], columns: &[0, 1, 2], ..map };
        assert_eq!(part.at(cells, pos2(75.0, 35.0)), Some([2, 2]));
        assert_eq!(part.table(), "N s/m\ta\tb\tc\nc\t2e1\t2.1e1\t2.2e1\n");
    }
}
