//! Parts of a report on A4 pages: text broken into lines, tables that go on over the page under their head, figures with
//! their numbers, lines to sign at the end.

use super::drawn;
use super::face::Face;
use crate::plots::drawing::Drawing;
use crate::report::page::Part;
use ecolor::Color32;
use pdf_writer::Content;

/// A4, points.
pub(super) const WIDTH: f32 = 595.28;
/// A4, points.
pub(super) const HEIGHT: f32 = 841.89;

const LEFT: f32 = 56.0;
const TOP: f32 = 60.0;
const BOTTOM: f32 = 62.0;
const ROOM: f32 = WIDTH - 2.0 * LEFT;
/// Sizes of type.
const BODY: f32 = 9.5;
const SMALL: f32 = 8.0;
const CHAPTER: f32 = 15.0;
const SECTION: f32 = 11.5;
const TITLE: f32 = 24.0;
/// Room between two columns of a table.
const GAP: f32 = 12.0;
/// Largest height of a figure.
const FIGURE: f32 = 420.0;

const INK: Color32 = Color32::from_rgb(0x16, 0x19, 0x1d);
const WEAK: Color32 = Color32::from_rgb(0x5c, 0x66, 0x70);
const WARNING: Color32 = Color32::from_rgb(0x8a, 0x5a, 0x00);
const LINE: Color32 = Color32::from_rgb(0xd5, 0xda, 0xde);

/// Pages under way.
pub(super) struct Paper<'a> {
    face: &'a Face,
    title: &'a str,
    pages: Vec<Content>,
    /// Distance of what comes next from the top of the page.
    at: f32,
}

impl<'a> Paper<'a> {
    /// The first page with the title.
    pub(super) fn new(face: &'a Face, title: &'a str) -> Self {
        let mut paper = Self { face, title, pages: vec![Content::new()], at: TOP + 10.0 };
        paper.paragraph(title, TITLE, INK);
        let kind = concat!("Report of a vibration test, made by Dashpot ", env!("CARGO_PKG_VERSION"));
        paper.paragraph(kind, BODY, WEAK);
        paper.at += 8.0;
        paper
    }

    /// Adds a part; a title stays with what comes `next`.
    pub(super) fn part(&mut self, part: &Part, next: Option<&Part>) {
        let figure = match next {
            Some(Part::Figure(_, drawing)) => scale(drawing) * drawing.size.y + 30.0,
            _ => 0.0,
        };
        match part {
            Part::Chapter(title) => {
                self.need(90.0 + figure);
                self.at += 16.0;
                self.paragraph(title, CHAPTER, INK);
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
            Part::Table(head, rows) => self.table(head, rows),
            Part::Figure(number, drawing) => self.figure(*number, drawing),
        }
    }

    /// All pages with their numbers, lines to sign on the last.
    pub(super) fn finish(mut self) -> Vec<Content> {
        self.need(80.0);
        self.at += 50.0;
        for (k, name) in ["Place and date", "Signature"].into_iter().enumerate() {
            let x = LEFT + 0.55 * ROOM * k as f32;
            let y = HEIGHT - self.at;
            let page = self.page();
            page.set_stroke_rgb(0.36, 0.4, 0.44).set_line_width(0.6);
            page.move_to(x, y).line_to(x + 0.4 * ROOM, y).stroke();
            self.text(name, SMALL, WEAK, x, self.at + 11.0);
        }
        let count = self.pages.len();
        for k in 0..count {
            let number = format!("{} of {count}", k + 1);
            let (y, right) = (HEIGHT - 32.0, WIDTH - LEFT - self.face.width(&number, SMALL));
            self.text_on(k, self.title, WEAK, LEFT, y);
            self.text_on(k, &number, WEAK, right, y);
        }
        // Every page ends what it began.
        for page in &mut self.pages {
            page.save_state().restore_state();
        }
        self.pages
    }

    fn page(&mut self) -> &mut Content {
        if self.pages.is_empty() {
            self.pages.push(Content::new());
        }
        let last = self.pages.len() - 1;
        &mut self.pages[last]
    }

    /// Goes on to the next page where less than `height` is left.
    fn need(&mut self, height: f32) -> bool {
        let full = self.at + height > HEIGHT - BOTTOM;
        if full {
            self.pages.push(Content::new());
            self.at = TOP;
        }
        full
    }

    /// One line of text with its baseline at `y` from the top.
    fn text(&mut self, text: &str, size: f32, colour: Color32, x: f32, y: f32) {
        let face = self.face;
        let page = self.page();
        drawn::fill(page, colour, Color32::WHITE);
        drawn::show(page, face, text, size, [1.0, 0.0, 0.0, 1.0, x, HEIGHT - y]);
    }

    fn text_on(&mut self, page: usize, text: &str, colour: Color32, x: f32, y: f32) {
        let face = self.face;
        let page = &mut self.pages[page];
        drawn::fill(page, colour, Color32::WHITE);
        drawn::show(page, face, text, SMALL, [1.0, 0.0, 0.0, 1.0, x, HEIGHT - y]);
    }

    fn rule(&mut self, y: f32) {
        let page = self.page();
        let [r, g, b] = [LINE.r(), LINE.g(), LINE.b()].map(|v| f32::from(v) / 255.0);
        page.set_stroke_rgb(r, g, b).set_line_width(0.7);
        page.move_to(LEFT, HEIGHT - y).line_to(LEFT + ROOM, HEIGHT - y).stroke();
    }

    fn paragraph(&mut self, text: &str, size: f32, colour: Color32) {
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

    fn table(&mut self, head: &[String], rows: &[Vec<String>]) {
        let names: Vec<String> = head.iter().map(|h| h.trim_end_matches('|').to_owned()).collect();
        let right: Vec<bool> = head.iter().map(|h| h.ends_with('|')).collect();
        let widths = self.columns(&names, rows);
        self.need(50.0);
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

    /// Widths of the columns: as wide as they want; where that is too much, the wide ones share what is left.
    fn columns(&self, names: &[String], rows: &[Vec<String>]) -> Vec<f32> {
        let n = names.len();
        let wanted = |k: usize| {
            let cells = rows.iter().filter_map(|row| row.get(k)).chain(names.get(k));
            cells.map(|text| self.face.width(text, SMALL) + 0.5).fold(0.0, f32::max)
        };
        let wanted: Vec<f32> = (0..n).map(wanted).collect();
        let room = ROOM - GAP * n.saturating_sub(1) as f32;
        if wanted.iter().sum::<f32>() <= room {
            return wanted;
        }
        let fair = room / n.max(1) as f32;
        let narrow: f32 = wanted.iter().filter(|w| **w <= fair).sum();
        let wide: f32 = wanted.iter().filter(|w| **w > fair).sum();
        wanted.iter().map(|&w| if w <= fair { w } else { w * (room - narrow) / wide }).collect()
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

/// How much a drawing is made smaller to fit the page.
fn scale(drawing: &Drawing) -> f32 {
    (ROOM / drawing.size.x).min(FIGURE / drawing.size.y).min(1.0)
}
