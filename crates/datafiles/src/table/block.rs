//! A block of numbers under its header.

use super::cell::Cell;
use super::header_line::HeaderLine;

/// A block of numbers.
#[derive(Debug, Clone, Default)]
pub(crate) struct Block {
    /// Lines above it, without blank ones.
    pub header: Vec<HeaderLine>,
    /// Rows.
    pub rows: usize,
    /// Line of the first row, from 1, and of the last.
    pub lines: [u64; 2],
    /// Cells of the last row.
    pub last_width: usize,
    pub columns: Vec<Numbers>,
    /// Columns of texts, ascending: they hold no numbers.
    pub texts: Vec<usize>,
    /// Columns in front of the first that hold what is said of the table, and are none of it.
    pub skip: usize,
}

/// Numbers of a column while its rows come in.
#[derive(Debug, Clone, Default)]
pub(crate) struct Numbers {
    pub re: Vec<f64>,
    /// As long as `re` where any number was complex, else empty.
    pub im: Vec<f64>,
    /// Whether the numbers are clock times.
    pub clock: bool,
    /// Rows from the end without a number.
    pub missing: usize,
    /// Empty cells between numbers.
    pub gaps: usize,
    /// Row of the first number.
    pub first: usize,
}

impl Numbers {
    pub(super) fn push(&mut self, cell: &Cell, row: usize) {
        let [re, im] = match cell {
            Cell::Real(value) => [*value, 0.0],
            Cell::Complex(value) => *value,
            Cell::Clock(value) | Cell::Span(value, _) => {
                self.clock = true;
                [*value, 0.0]
            }
            Cell::Empty | Cell::Word(_) => {
                self.missing += 1;
                return;
            }
        };
        if self.re.is_empty() {
            self.first = row;
            self.missing = 0;
        }
        for _ in 0..self.missing {
            self.re.push(f64::NAN);
            self.gaps += 1;
        }
        self.missing = 0;
        if matches!(cell, Cell::Complex(_)) || !self.im.is_empty() {
            self.im.resize(self.re.len(), 0.0);
            self.im.push(im);
        }
        self.re.push(re);
    }
}
