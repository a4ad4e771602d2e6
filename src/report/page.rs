//! A report as a list of parts, before it is written as HTML or as PDF.

use crate::plots::drawing::Drawing;

/// One part of a report.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Part {
    /// Title of a chapter.
    Chapter(String),
    /// Title of a part of a chapter.
    Section(String),
    /// A sentence.
    Sentence(String),
    /// A sentence of second rank.
    Remark(String),
    /// A sentence that should not be missed.
    Warning(String),
    /// Heads and rows; columns whose head ends in a bar `|` hold numbers and stand right.
    Table(Vec<String>, Vec<Vec<String>>),
    /// A drawing with its number.
    Figure(usize, Drawing),
}

/// A report under way.
#[derive(Debug, Default)]
pub(super) struct Page {
    parts: Vec<Part>,
    figures: usize,
}

impl Page {
    /// Adds a chapter's title.
    pub(super) fn chapter(&mut self, title: &str) {
        self.parts.push(Part::Chapter(title.to_owned()));
    }

    /// Adds the title of a part of a chapter.
    pub(super) fn section(&mut self, title: &str) {
        self.parts.push(Part::Section(title.to_owned()));
    }

    /// Adds a sentence.
    pub(super) fn sentence(&mut self, text: &str) {
        self.parts.push(Part::Sentence(text.to_owned()));
    }

    /// Adds a sentence of second rank.
    pub(super) fn remark(&mut self, text: &str) {
        self.parts.push(Part::Remark(text.to_owned()));
    }

    /// Adds a sentence that should not be missed.
    pub(super) fn warning(&mut self, text: &str) {
        self.parts.push(Part::Warning(text.to_owned()));
    }

    /// Adds a table; columns whose name ends in a bar `|` hold numbers and stand right.
    pub(super) fn table(&mut self, head: &[&str], rows: &[Vec<String>]) {
        self.parts.push(Part::Table(head.iter().map(|h| (*h).to_owned()).collect(), rows.to_vec()));
    }

    /// Adds a drawing.
    pub(super) fn drawing(&mut self, drawing: &Drawing) {
        self.figures += 1;
        self.parts.push(Part::Figure(self.figures, drawing.clone()));
    }

    /// All parts.
    pub(super) fn finish(self) -> Vec<Part> {
        self.parts
    }
}
