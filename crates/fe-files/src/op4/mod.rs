//! NASTRAN `OUTPUT4` files, ascii and binary.
//!
//! A matrix is a header (columns, rows, form, type, name), its columns, and a last column that is one too many. A column is
//! dense (first row, number of words, values) or, where its first row is 0, a number of strings: runs of values below each
//! other. A string's head is `IS = row + 65536 (words + 1)`, or, with `BIGMAT` (negative number of rows), `words + 1` and `row`.

mod ascii;
mod binary;

use crate::Matrix;
use crate::error::{FileError, Place, Problem};

/// Reads all real square matrices of a file called `file` in messages.
pub fn read(bytes: &[u8], file: &str) -> Result<Vec<Matrix>, FileError> {
    // A binary file begins with the length of its first record, which has bytes below a space.
    let is_binary = bytes.iter().take(4).any(|&byte| byte < b' ' && !byte.is_ascii_whitespace());
    let matrices = if is_binary { binary::read(bytes, file)? } else { ascii::read(bytes, file)? };
    if matrices.is_empty() {
        return Err(FileError::new(file, Place::File, Problem::NoMatrix { expected: "a matrix of OUTPUT4" }));
    }
    // Tables and complex matrices may stand beside mass and stiffness, not in their place.
    if let Some(first) = matrices
        .iter()
        .find(|m| m.header.refused.is_some())
        .filter(|_| matrices.iter().all(|m| m.header.refused.is_some()))
        && let Some(problem) = &first.header.refused
    {
        return Err(FileError::new(file, first.place, problem.clone()));
    }
    let usable = matrices.into_iter().filter(|m| m.header.refused.is_none());
    usable.map(|m| Matrix::new(file, &m.header.name, m.header.size, None, m.entries)).collect()
}

/// Head of a matrix.
#[derive(Debug, Clone, PartialEq)]
struct Header {
    name: String,
    size: usize,
    columns: i64,
    is_double: bool,
    /// Strings have heads of two numbers.
    is_big: bool,
    /// Why it is neither mass nor stiffness.
    refused: Option<Problem>,
}

struct Found {
    /// Where its header stands.
    place: Place,
    header: Header,
    entries: Vec<(usize, usize, f64)>,
}

impl Header {
    /// Checks the numbers of a header; `most` is what a file of its length could hold.
    fn new(columns: i64, rows: i64, kind: i64, name: &str, most: usize) -> Result<Self, Problem> {
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
    fn place(&self, row: i64, column: i64) -> Result<(usize, usize), Problem> {
        let inside = |k: i64| usize::try_from(k - 1).ok().filter(|&k| k < self.size);
        let outside = || Problem::Outside { name: self.name.clone(), row, column, size: self.size };
        inside(row).zip(inside(column)).ok_or_else(outside)
    }
}

/// Row and number of words of a string's head of one number.
fn short_head(head: i64) -> (i64, i64) {
    (head % 65_536, head / 65_536 - 1)
}

#[cfg(test)]
mod tests;
