//! A report as a list of parts, before it is written as HTML or as PDF.

use super::section::Section;
use crate::plots::drawing::Drawing;

/// One part of a report.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Part {
    /// Title of a chapter, with its number.
    Chapter(usize, String),
    /// Title of a part of a chapter.
    Section(String),
    /// A sentence.
    Sentence(String),
    /// A sentence of second rank.
    Remark(String),
    /// A sentence that should not be missed.
    Warning(String),
    /// A table with its number.
    Table(usize, Table),
    /// A drawing with its number and its values as CSV.
    Figure(usize, Drawing, String),
}

/// A table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table {
    /// What it holds.
    pub title: String,
    /// Heads; columns whose head ends in a bar `|` hold numbers and stand right.
    pub head: Vec<String>,
    /// Rows.
    pub rows: Vec<Vec<String>>,
}

/// A report under way.
#[derive(Debug, Default)]
pub(super) struct Page {
    /// Sections that are wanted; none for all.
    wanted: Vec<Section>,
    /// Whether the chapter under way is not.
    left_out: bool,
    parts: Vec<Part>,
    chapters: usize,
    figures: usize,
    tables: usize,
}

impl Page {
    /// A report of some sections; of all where there are none.
    pub(super) fn of(wanted: &[Section]) -> Self {
        Self { wanted: wanted.to_vec(), ..Self::default() }
    }

    fn push(&mut self, part: impl FnOnce(&mut Self) -> Part) {
        if !self.left_out {
            let part = part(self);
            self.parts.push(part);
        }
    }

    /// Begins a chapter of a section; all that follows is left out where the section is.
    pub(super) fn chapter(&mut self, section: Section, title: &str) {
        self.left_out = !self.wanted.is_empty() && !self.wanted.contains(&section);
        self.push(|page| {
            page.chapters += 1;
            Part::Chapter(page.chapters, title.to_owned())
        });
    }

    /// Adds the title of a part of a chapter.
    pub(super) fn section(&mut self, title: &str) {
        self.push(|_| Part::Section(title.to_owned()));
    }

    /// Adds a sentence.
    pub(super) fn sentence(&mut self, text: &str) {
        self.push(|_| Part::Sentence(text.to_owned()));
    }

    /// Adds a sentence of second rank.
    pub(super) fn remark(&mut self, text: &str) {
        self.push(|_| Part::Remark(text.to_owned()));
    }

    /// Adds a sentence that should not be missed.
    pub(super) fn warning(&mut self, text: &str) {
        self.push(|_| Part::Warning(text.to_owned()));
    }

    /// Adds a table; columns whose name ends in a bar `|` hold numbers and stand right.
    pub(super) fn table(&mut self, title: &str, head: &[&str], rows: &[Vec<String>]) {
        self.push(|page| {
            page.tables += 1;
            let head = head.iter().map(|h| (*h).to_owned()).collect();
            Part::Table(page.tables, Table { title: title.to_owned(), head, rows: rows.to_vec() })
        });
    }

    /// Adds a drawing with its values as a table with tabs.
    pub(super) fn drawing(&mut self, drawing: &Drawing, values: &str) {
        self.push(|page| {
            page.figures += 1;
            Part::Figure(page.figures, drawing.clone(), crate::plots::figure::csv(values))
        });
    }

    /// All parts.
    pub(super) fn finish(self) -> Vec<Part> {
        self.parts
    }
}

/// Numbers and titles of the chapters, in their order.
pub(super) fn chapters(parts: &[Part]) -> impl Iterator<Item = (usize, &str)> {
    parts.iter().filter_map(|part| match part {
        Part::Chapter(number, title) => Some((*number, title.as_str())),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::{Page, Part, Section};

    #[test]
    fn what_is_not_wanted_takes_no_number() {
        let mut page = Page::of(&[Section::Ratios]);
        for (section, title) in [(Section::Structure, "a"), (Section::Ratios, "b"), (Section::Ledger, "c")] {
            page.chapter(section, title);
            page.table(title, &["x"], &[vec!["1".to_owned()]]);
        }
        let parts = page.finish();
        assert_eq!(parts[0], Part::Chapter(1, "b".to_owned()));
        assert!(matches!(&parts[1..], [Part::Table(1, table)] if table.title == "b"), "{parts:?}");
    }
}
