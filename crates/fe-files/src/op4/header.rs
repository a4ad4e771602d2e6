//! Heads of matrices and of strings, whatever the coding of the file.

use crate::error::{Place, Problem};

/// Head of a matrix.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Header {
    pub name: String,
    pub size: usize,
    pub columns: i64,
    pub is_double: bool,
    /// Strings have heads of two numbers.
    pub is_big: bool,
    /// Why it is neither mass nor stiffness.
    pub refused: Option<Problem>,
}

pub(super) struct Found {
    /// Where its header stands.
    pub place: Place,
    pub header: Header,
    pub entries: Vec<(usize, usize, f64)>,
}

impl Header {
    /// Checks the numbers of a header; `most` is what a file of its length could hold.
    pub(super) fn new(columns: i64, rows: i64, kind: i64, name: &str, most: usize) -> Result<Self, Problem> {
        let name = name.trim().to_owned();
        let (columns, height) = (columns.unsigned_abs(), rows.unsigned_abs());
        let refused = if kind == 3 || kind == 4 {
            Some(Problem::Complex { name: name.clone() })
        } else if columns != height {
            Some(Problem::NotSquare { name: name.clone(), rows: height, columns })
        } else {
            None
        };
        let size = usize::try_from(height).ok().filter(|&n| n > 0 && n <= most);
        let size = size.ok_or_else(|| Problem::TooLarge { name: name.clone(), rows: height })?;
        let (is_double, is_big) = (kind == 2, rows < 0 || height > 65_535);
        Ok(Self { name, size, columns: columns.try_into().unwrap_or(i64::MAX), is_double, is_big, refused })
    }

    /// Row and column from 0.
    pub(super) fn place(&self, row: i64, column: i64) -> Result<(usize, usize), Problem> {
        let inside = |k: i64| usize::try_from(k - 1).ok().filter(|&k| k < self.size);
        let outside = || Problem::Outside { name: self.name.clone(), row, column, size: self.size };
        inside(row).zip(inside(column)).ok_or_else(outside)
    }
}

/// Row and number of words of a string's head of one number.
pub(super) fn short_head(head: i64) -> (i64, i64) {
    (head % 65_536, head / 65_536 - 1)
}
