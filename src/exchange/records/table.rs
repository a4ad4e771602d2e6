//! A table of separated values as bytes: which separator, which decimal sign, where each row stands.

use super::error::{At, RecordFileError, RecordProblem};
use crate::measurement::record::MOST;
use csv::{ByteRecord, ReaderBuilder, Trim};

/// Longest text that an error message repeats.
const LONGEST_QUOTE: usize = 40;

/// A table opened at its header.
pub(super) struct Table<'a> {
    rows: csv::Reader<&'a [u8]>,
    row: ByteRecord,
    /// Names of the columns.
    pub(super) header: Vec<String>,
    /// Line of the header.
    pub(super) header_line: u64,
    /// Number that a decimal comma is allowed in: separators other than the comma leave it free.
    decimal_comma: bool,
    text: &'a [u8],
    at: At<'a>,
}

impl<'a> Table<'a> {
    /// Finds the separator in the header and reads the names of the columns.
    pub(super) fn open(bytes: &'a [u8], at: At<'a>) -> Result<Self, RecordFileError> {
        let text = plain_text(bytes).map_err(|problem| at.file(problem))?;
        let separator = separator(text);
        let rows = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .delimiter(separator)
            .trim(Trim::All)
            .from_reader(text);
        let mut table = Self {
            rows,
            row: ByteRecord::new(),
            header: Vec::new(),
            header_line: 1,
            decimal_comma: separator != b',',
            text,
            at,
        };
        if !table.next()? {
            return Err(at.file(RecordProblem::Empty));
        }
        table.header_line = table.line();
        let cells = table.cells();
        let names: Result<Vec<&str>, _> = (0..cells).map(|i| std::str::from_utf8(&table.row[i])).collect();
        let names = names.map_err(|_| at.line(table.header_line, RecordProblem::HeaderNotUtf8))?;
        table.header = names.into_iter().map(str::to_owned).collect();
        Ok(table)
    }

    /// Moves to the next row that holds anything; false at the end.
    pub(super) fn next(&mut self) -> Result<bool, RecordFileError> {
        loop {
            let more = self
                .rows
                .read_byte_record(&mut self.row)
                .map_err(|error| self.at.file(RecordProblem::Unreadable { reason: error.to_string() }))?;
            if !more {
                return Ok(false);
            }
            if self.cells() > 0 {
                return Ok(true);
            }
        }
    }

    /// Line of the current row, from 1.
    pub(super) fn line(&self) -> u64 {
        // A row's position is where the one before ended: blank lines between them are counted here.
        self.row.position().map_or(1, |position| {
            let behind = &self.text[(position.byte() as usize).min(self.text.len())..];
            let blank = behind.iter().take_while(|byte| matches!(byte, b'\n' | b'\r'));
            position.line() + blank.filter(|&&byte| byte == b'\n').count() as u64
        })
    }

    /// Share of the text that has been read.
    pub(super) fn progress(&self) -> f64 {
        self.rows.position().byte() as f64 / self.text.len().max(1) as f64
    }

    /// Cells of the current row up to the last that is not empty.
    fn cells(&self) -> usize {
        (0..self.row.len()).rev().find(|&i| !self.row[i].is_empty()).map_or(0, |i| i + 1)
    }

    /// Fails unless the current row fills the columns of the header; empty cells at its end may be too many.
    pub(super) fn check_width(&self) -> Result<(), RecordFileError> {
        let expected = self.header.len();
        if self.row.len() >= expected && self.cells() <= expected {
            return Ok(());
        }
        let found = self.cells();
        let decimals = !self.decimal_comma && found > expected;
        let hint = if decimals { "; with a decimal comma, separate the columns by semicolons" } else { "" };
        Err(self.at.line(self.line(), RecordProblem::Ragged { found, expected, hint }))
    }

    /// Bytes of a cell of the current row.
    pub(super) fn bytes(&self, column: usize) -> &[u8] {
        self.row.get(column).unwrap_or_default()
    }

    /// Text of a cell of the current row.
    pub(super) fn text(&self, column: usize) -> String {
        String::from_utf8_lossy(self.bytes(column)).into_owned()
    }

    /// Error at a cell of the current row.
    pub(super) fn error(&self, column: usize, problem: RecordProblem) -> RecordFileError {
        self.at.cell(self.line(), &self.header[column], problem)
    }

    /// Finite number in a cell of the current row.
    pub(super) fn number(&self, column: usize) -> Result<f64, RecordFileError> {
        let cell = self.bytes(column);
        let parsed = match parse(cell) {
            None if self.decimal_comma => parse_decimal_comma(cell),
            parsed => parsed,
        };
        match parsed {
            Some(value) if value.is_finite() => Ok(value),
            Some(_) => Err(self.error(column, RecordProblem::NotFinite { text: quote(cell) })),
            None if cell.is_empty() => Err(self.error(column, RecordProblem::EmptyCell)),
            None => Err(self.error(column, RecordProblem::NotANumber { text: quote(cell) })),
        }
    }

    /// A number of a sensor in a cell of the current row, times `to_si`: what none reads is refused.
    pub(super) fn reading(&self, column: usize, to_si: f64) -> Result<f64, RecordFileError> {
        let value = self.number(column)? * to_si;
        if value.abs() <= MOST {
            return Ok(value);
        }
        Err(self.error(column, RecordProblem::TooLarge { value }))
    }
}

/// The start of a text for a message: one line, not too long.
pub(super) fn quote(cell: &[u8]) -> String {
    let text: String = String::from_utf8_lossy(cell).chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    match text.char_indices().nth(LONGEST_QUOTE) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

fn parse(cell: &[u8]) -> Option<f64> {
    std::str::from_utf8(cell).ok()?.parse().ok()
}

/// Parses `1,25e-3`. A cell with both signs has thousands in it and is left to the user.
fn parse_decimal_comma(cell: &[u8]) -> Option<f64> {
    if cell.contains(&b'.') || cell.iter().filter(|&&byte| byte == b',').count() != 1 {
        return None;
    }
    let mended: Vec<u8> = cell.iter().map(|&byte| if byte == b',' { b'.' } else { byte }).collect();
    parse(&mended)
}

/// The text without its byte order mark, or why it is none.
fn plain_text(bytes: &[u8]) -> Result<&[u8], RecordProblem> {
    if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
        return Err(RecordProblem::Utf16);
    }
    let text = bytes.strip_prefix(&[0xEF, 0xBB, 0xBF]).unwrap_or(bytes);
    let start = &text[..text.len().min(1024)];
    if start.contains(&0) {
        // Text of two bytes a letter has a zero in every second place; anything else with zeros is no text.
        let pairs = start.chunks_exact(2);
        let wide = |i: usize| pairs.clone().filter(|pair| pair[i] == 0).count() * 10 > pairs.len() * 8;
        return Err(if wide(0) == wide(1) { RecordProblem::Binary } else { RecordProblem::Utf16 });
    }
    if text.iter().all(u8::is_ascii_whitespace) { Err(RecordProblem::Empty) } else { Ok(text) }
}

/// The separator that stands most often in the first line that is not blank, outside of quotes.
fn separator(text: &[u8]) -> u8 {
    let line = text.split(|&byte| byte == b'\n' || byte == b'\r').find(|line| !line.trim_ascii().is_empty());
    let mut counts = [0_usize; 3];
    let mut quoted = false;
    for &byte in line.unwrap_or_default() {
        match byte {
            b'"' => quoted = !quoted,
            b'\t' if !quoted => counts[0] += 1,
            b';' if !quoted => counts[1] += 1,
            b',' if !quoted => counts[2] += 1,
            _ => {}
        }
    }
    let [tabs, semicolons, commas] = counts;
    if tabs > semicolons && tabs > commas {
        b'\t'
    } else if semicolons > commas {
        b';'
    } else {
        b','
    }
}
