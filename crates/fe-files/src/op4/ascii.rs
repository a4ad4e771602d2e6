//! Ascii: numbers in fields of the width that the header gives (such as `1P,3E23.16`), heads as whole numbers in lines of their own.

use super::header::{Found, Header, short_head};
use crate::error::{FileError, Place, Problem, quote};
use crate::number::{real, whole};

/// Width of a value where the header gives none.
const WIDTH: usize = 16;

pub(super) fn read(bytes: &[u8], file: &str) -> Result<Vec<Found>, FileError> {
    let text = String::from_utf8_lossy(bytes);
    let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line)).peekable();
    let mut matrices = Vec::new();
    while let Some((at, line)) = lines.next() {
        if line.trim().is_empty() {
            continue;
        }
        let (header, width) = header(line, bytes.len()).map_err(|problem| FileError::line(file, at, problem))?;
        let mut columns = Columns { header: &header, width, entries: Vec::new(), column: 0, row: 0 };
        let mut is_done = false;
        for (at, line) in lines.by_ref() {
            let wrong = |problem| FileError::line(file, at, problem);
            // The one value of the column too many ends the matrix.
            if is_done {
                break;
            }
            is_done = columns.line(line).map_err(wrong)?;
        }
        if !is_done {
            return Err(FileError::new(file, Place::File, Problem::EndsEarly { what: "a matrix" }));
        }
        let entries = columns.entries;
        matrices.push(Found { place: Place::Line(at), header, entries });
    }
    Ok(matrices)
}

/// Four whole numbers, eight characters of name, the format.
fn header(line: &str, most: usize) -> Result<(Header, usize), Problem> {
    let bad = || Problem::Row { expected: "columns, rows, form, type and name", text: quote(line) };
    let mut rest = line;
    let mut numbers = [0; 4];
    for (k, number) in numbers.iter_mut().enumerate() {
        let begin = rest.trim_start();
        // The name may follow the type, one digit, at once.
        let end = if k == 3 { 1 } else { begin.find(char::is_whitespace).unwrap_or(begin.len()) };
        let word = begin.get(..end).ok_or_else(bad)?;
        *number = whole(word, "a size, form or type").map_err(|_| bad())?;
        rest = &begin[end..];
    }
    let cut = rest.char_indices().nth(8).map_or(rest.len(), |(i, _)| i);
    let (name, format) = rest.split_at(cut);
    let width = format.split(['E', 'D', 'e', 'd']).nth(1).and_then(|w| w.split('.').next()?.trim().parse().ok());
    let [columns, rows, _, kind] = numbers;
    Ok((Header::new(columns, rows, kind, name, most)?, width.filter(|w| (8..=64).contains(w)).unwrap_or(WIDTH)))
}

struct Columns<'a> {
    header: &'a Header,
    width: usize,
    entries: Vec<(usize, usize, f64)>,
    /// Column and row of the next value, from 1.
    column: i64,
    row: i64,
}

impl Columns<'_> {
    /// Whether the head of the last column was read.
    fn line(&mut self, line: &str) -> Result<bool, Problem> {
        if line.contains('.') {
            if self.header.refused.is_none() {
                self.values(line)?;
            }
            return Ok(false);
        }
        let numbers = line.split_whitespace().map(|word| whole(word, "a head of a column or string"));
        match numbers.collect::<Result<Vec<i64>, Problem>>()?[..] {
            [column, row, _] => {
                (self.column, self.row) = (column, row);
                return Ok(column > self.header.columns);
            }
            [_, row] if self.header.is_big => self.row = row,
            [head] if !self.header.is_big => self.row = short_head(head).0,
            [] => {}
            _ => return Err(Problem::Row { expected: "a head of a column or string", text: quote(line) }),
        }
        Ok(false)
    }

    fn values(&mut self, line: &str) -> Result<(), Problem> {
        let line = line.trim_end();
        if !line.is_ascii() {
            return Err(Problem::Number { text: quote(line) });
        }
        let mut rest = line;
        while !rest.trim().is_empty() {
            let (field, next) = rest.split_at(self.width.min(rest.len()));
            let (row, column) = self.header.place(self.row, self.column)?;
            self.entries.push((row, column, real(field)?));
            self.row += 1;
            rest = next;
        }
        Ok(())
    }
}
