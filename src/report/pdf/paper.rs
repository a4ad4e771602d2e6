//! Parts of a report on A4 pages: text broken into lines, tables that go on over the page under their head, figures with
//! their numbers.

use super::drawn;
use super::face::Face;
use crate::plots::drawing::Drawing;
use crate::report::page::{Part, Table};
use ecolor::Color32;
use pdf_writer::Content;

/// A4, points.
pub(super) const WIDTH: f32 = 595.28;
/// A4, points.
pub(super) const HEIGHT: f32 = 841.89;

pub(super) const LEFT: f32 = 56.0;
pub(super) const TOP: f32 = 60.0;
const BOTTOM: f32 = 62.0;
pub(super) const ROOM: f32 = WIDTH - 2.0 * LEFT;
/// Sizes of type.
pub(super) const BODY: f32 = 9.5;
pub(super) const SMALL: f32 = 8.0;
const CHAPTER: f32 = 15.0;
pub(super) const SECTION: f32 = 11.5;
pub(super) const TITLE: f32 = 24.0;
/// Room between two columns of a table.
const GAP: f32 = 12.0;
/// Largest height of a figure.
const FIGURE: f32 = 420.0;

pub(super) const INK: Color32 = Color32::from_rgb(0x16, 0x19, 0x1d);
pub(super) const WEAK: Color32 = Color32::from_rgb(0x5c, 0x66, 0x70);
const WARNING: Color32 = Color32::from_rgb(0x8a, 0x5a, 0x00);
const LINE: Color32 = Color32::from_rgb(0xd5, 0xda, 0xde);

/// Pages under way.
pub(super) struct Paper<'a> {
    pub(super) face: &'a Face,
    pages: Vec<Content>,
    /// Number, title and page, from 0, of every chapter.
    chapters: Vec<(usize, String, usize)>,
    /// Distance of what comes next from the top of the page.
    pub(super) at: f32,
}

impl<'a> Paper<'a> {
    /// The first page, empty.
    pub(super) fn new(face: &'a Face) -> Self {
        Self { face, pages: vec![Content::new()], chapters: Vec::new(), at: TOP }
    }

    /// Adds a part; a title stays with what comes `next`.
    pub(super) fn part(&mut self, part: &Part, next: Option<&Part>) {
        let figure = match next {
            Some(Part::Figure(_, drawing, _)) => scale(drawing) * drawing.size.y + 30.0,
            _ => 0.0,
        };
        match part {
            Part::Chapter(number, title) => {
                self.need(90.0 + figure);
                self.at += 16.0;
                self.chapters.push((*number, title.clone(), self.pages.len() - 1));
                self.paragraph(&format!("{number}  {title}"), CHAPTER, INK);
                self.rule(self.at - 3.0);
                self.at += 4.0;
            }
            Part::Section(title) => {
                self.need(60.0 + figure);
                self.at += 8.0;
                self.paragraph(title, SECTION, INK);
            }
            Part::Sentence(text) => self.paragraph(text, BODY, INK),
            Part::Remark(text) => self.paragraph(text, BODY, WEAK),
            Part::Warning(text) => self.paragraph(text, BODY, WARNING),
            Part::Table(number, table) => self.table(*number, table),
            Part::Figure(number, drawing, _) => self.figure(*number, drawing),
        }
    }

    /// All pages, and the chapters with theirs.
    pub(super) fn finish(self) -> (Vec<Content>, Vec<(usize, String, usize)>) {
        (self.pages, self.chapters)
    }

    pub(super) fn page(&mut self) -> &mut Content {
        if self.pages.is_empty() {
            self.pages.push(Content::new());
        }
        let last = self.pages.len() - 1;
        &mut self.pages[last]
    }

    /// Goes on to the next page where less than `height` is left.
    pub(super) fn need(&mut self, height: f32) -> bool {
        let full = self.at + height > HEIGHT - BOTTOM;
        if full {
            self.pages.push(Content::new());
            self.at = TOP;
        }
        full
    }

    /// One line of text with its baseline at `y` from the top.
    pub(super) fn text(&mut self, text: &str, size: f32, colour: Color32, x: f32, y: f32) {
        let face = self.face;
        let page = self.page();
        drawn::fill(page, colour, Color32::WHITE);
        drawn::show(page, face, text, size, [1.0, 0.0, 0.0, 1.0, x, HEIGHT - y]);
    }

    pub(super) fn rule(&mut self, y: f32) {
        let page = self.page();
        let [r, g, b] = [LINE.r(), LINE.g(), LINE.b()].map(|v| f32::from(v) / 255.0);
        page.set_stroke_rgb(r, g, b).set_line_width(0.7);
        page.move_to(LEFT, HEIGHT - y).line_to(LEFT + ROOM, HEIGHT - y).stroke();
    }

    pub(super) fn paragraph(&mut self, text: &str, size: f32, colour: Color32) {
        let leading = 1.4 * size;
        for line in self.face.lines(text, size, ROOM) {
            self.need(leading);
            self.text(&line, size, colour, LEFT, self.at + size);
            self.at += leading;
        }
        self.at += 0.35 * size;
    }

    fn figure(&mut self, number: usize, drawing: &Drawing) {
        let scale = scale(drawing);
        let height = scale * drawing.size.y;
        self.need(height + 30.0);
        let (face, corner) = (self.face, [LEFT, HEIGHT - self.at]);
        drawn::draw(self.page(), face, drawing, corner, scale);
        self.at += height + 4.0;
        self.paragraph(&format!("Figure {number}. {}", drawing.title), SMALL, WEAK);
        self.at += 6.0;
    }

    fn table(&mut self, number: usize, Table { title, head, rows }: &Table) {
        self.need(70.0);
        self.paragraph(&format!("Table {number}. {title}"), SMALL, WEAK);
        let names: Vec<String> = head.iter().map(|h| h.trim_end_matches('|').to_owned()).collect();
        let right: Vec<bool> = head.iter().map(|h| h.ends_with('|')).collect();
        let widths = self.columns(&names, rows);
        self.row(&names, &widths, &right, WEAK);
        self.rule(self.at);
        self.at += 3.0;
        for row in rows {
            let lines =
                row.iter().zip(&widths).map(|(cell, w)| self.face.lines(cell, SMALL, *w).len()).max().unwrap_or(1);
            if self.need(1.35 * SMALL * lines as f32 + 4.0) {
                self.row(&names, &widths, &right, WEAK);
                self.rule(self.at);
            }
            self.row(row, &widths, &right, INK);
        }
        self.at += 8.0;
    }

    /// Widths of the columns: as wide as they want; where that is too much, the widest share what the others leave.
    fn columns(&self, names: &[String], rows: &[Vec<String>]) -> Vec<f32> {
        let n = names.len();
        let wanted = |k: usize| {
            let cells = rows.iter().filter_map(|row| row.get(k)).chain(names.get(k));
            cells.map(|text| self.face.width(text, SMALL) + 0.5).fold(0.0, f32::max)
        };
        let wanted: Vec<f32> = (0..n).map(wanted).collect();
        let room = ROOM - GAP * n.saturating_sub(1) as f32;
        shared(&wanted, room)
    }

    fn row(&mut self, cells: &[String], widths: &[f32], right: &[bool], colour: Color32) {
        let leading = 1.35 * SMALL;
        let mut x = LEFT;
        let mut deepest = 0.0_f32;
        for ((cell, &width), &right) in cells.iter().zip(widths).zip(right) {
            let lines = self.face.lines(cell, SMALL, width);
            for (k, line) in lines.iter().enumerate() {
                let shift = if right { width - self.face.width(line, SMALL) } else { 0.0 };
                self.text(line, SMALL, colour, x + shift, self.at + SMALL + leading * k as f32);
            }
            deepest = deepest.max(leading * lines.len() as f32);
            x += width + GAP;
        }
        self.at += deepest + 3.0;
    }
}

/// As much of `room` for each as it wants; where that is too much, those that want more than an even share of what the
/// others leave have such a share each.
fn shared(wanted: &[f32], room: f32) -> Vec<f32> {
    let mut sorted = wanted.to_vec();
    sorted.sort_by(f32::total_cmp);
    let (mut left, mut most) = (room, f32::INFINITY);
    for (k, width) in sorted.iter().enumerate() {
        let even = left / (sorted.len() - k) as f32;
        if *width > even {
            most = even;
            break;
        }
        left -= width;
    }
    wanted.iter().map(|width| width.min(most)).collect()
}

/// Writes the title and its number at the foot of every page.
pub(super) fn footers(face: &Face, title: &str, pages: &mut [Content]) {
    let count = pages.len();
    for (k, page) in pages.iter_mut().enumerate() {
        let number = format!("{} of {count}", k + 1);
        let right = WIDTH - LEFT - face.width(&number, SMALL);
        let title = face.lines(title, SMALL, 0.8 * ROOM).swap_remove(0);
        drawn::fill(page, WEAK, Color32::WHITE);
        for (text, x) in [(&title, LEFT), (&number, right)] {
            drawn::show(page, face, text, SMALL, [1.0, 0.0, 0.0, 1.0, x, 32.0]);
        }
    }
}

/// How much a drawing is made smaller to fit the page.
fn scale(drawing: &Drawing) -> f32 {
    (ROOM / drawing.size.x).min(FIGURE / drawing.size.y).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::shared;

    /// Narrow columns keep what they want, and a few wide ones do not take it from one that is little wider than the mean.
    #[test]
    fn the_widest_columns_share_what_the_others_leave() {
        assert_eq!(shared(&[10.0, 80.0, 20.0], 200.0), [10.0, 80.0, 20.0]);
        assert_eq!(shared(&[10.0, 80.0, 500.0, 20.0], 200.0), [10.0, 80.0, 90.0, 20.0]);
        assert_eq!(shared(&[300.0, 500.0], 200.0), [100.0, 100.0]);
    }
}
