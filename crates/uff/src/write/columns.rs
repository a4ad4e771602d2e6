//! Text in fixed columns.

use crate::error::Problem;

/// A set while it is written.
#[derive(Default)]
pub(super) struct Columns {
    pub bytes: Vec<u8>,
}

impl Columns {
    pub(super) fn end(&mut self) {
        self.bytes.push(b'\n');
    }

    pub(super) fn delimiter(&mut self) {
        self.bytes.extend_from_slice(b"    -1\n");
    }

    /// A line of text as it is.
    pub(super) fn text_line(&mut self, field: &'static str, text: &str) -> Result<(), Problem> {
        self.left(field, text, text.chars().count())?;
        self.end();
        Ok(())
    }

    /// A line of at most 80 columns, `NONE` where it is empty.
    pub(super) fn named(&mut self, field: &'static str, text: &str) -> Result<(), Problem> {
        const WIDTH: usize = 80;
        if text.trim() == "-1" {
            return Err(Problem::Character { field, text: "-1 (the delimiter)".to_string() });
        }
        self.left(field, if text.is_empty() { "NONE" } else { text }, WIDTH)?;
        self.end();
        Ok(())
    }

    /// Text at the left of its columns, as latin-1.
    pub(super) fn left(&mut self, field: &'static str, text: &str, width: usize) -> Result<(), Problem> {
        let start = self.bytes.len();
        for c in text.chars() {
            let byte = u8::try_from(u32::from(c)).ok().filter(|_| !c.is_control());
            self.bytes.push(byte.ok_or_else(|| Problem::Character { field, text: text.to_string() })?);
        }
        let written = self.bytes.len() - start;
        if written > width {
            return Err(Problem::TooWide { field, text: format!("\"{text}\""), width });
        }
        self.bytes.resize(start + width, b' ');
        Ok(())
    }

    /// Text at the right of its columns.
    pub(super) fn right(&mut self, field: &'static str, text: &str, width: usize) -> Result<(), Problem> {
        self.left(field, &format!("{text:>width$}"), width)
    }

    /// A whole number at the right of its columns.
    pub(super) fn integer(&mut self, field: &'static str, number: i64, width: usize) -> Result<(), Problem> {
        self.right(field, &number.to_string(), width)
    }

    /// Whole numbers in columns of ten.
    pub(super) fn integers(&mut self, field: &'static str, numbers: &[i64]) -> Result<(), Problem> {
        numbers.iter().try_for_each(|&number| self.integer(field, number, 10))
    }

    /// Whole numbers in columns of ten, eight a line.
    pub(super) fn integer_lines(&mut self, field: &'static str, numbers: &[i64]) -> Result<(), Problem> {
        for line in numbers.chunks(8) {
            self.integers(field, line)?;
            self.end();
        }
        Ok(())
    }

    /// A number in 13 columns with five decimals.
    pub(super) fn single(&mut self, x: f64) {
        self.real(x, 13, 5, 'E');
    }

    /// A number in 25 columns with 17 decimals, which reads back exactly.
    pub(super) fn double(&mut self, x: f64) {
        self.real(x, 25, 17, 'D');
    }

    /// Numbers in 13 columns, six a line.
    pub(super) fn single_lines(&mut self, numbers: &[f64]) {
        for line in numbers.chunks(6) {
            line.iter().for_each(|&x| self.single(x));
            self.end();
        }
    }

    /// A number with an exponent of two digits at least.
    pub(super) fn real(&mut self, x: f64, width: usize, decimals: usize, letter: char) {
        let text = scientific(x, decimals, letter);
        self.bytes.extend_from_slice(format!("{text:>width$}").as_bytes());
    }
}

/// `-1.50000E+00`.
pub(super) fn scientific(x: f64, decimals: usize, letter: char) -> String {
    if !x.is_finite() {
        let word = if x.is_nan() { "NaN" } else { "Inf" };
        return format!("{}{word}", if x < 0.0 { "-" } else { "" });
    }
    let text = format!("{x:.decimals$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let (sign, digits) = exponent.strip_prefix('-').map_or(('+', exponent), |digits| ('-', digits));
    format!("{mantissa}{letter}{sign}{digits:0>2}")
}

/// Refuses a set whose counts contradict one another.
pub(super) fn consistent(what: &'static str, found: usize, expected: usize) -> Result<(), Problem> {
    if found == expected { Ok(()) } else { Err(Problem::Inconsistent { what, found, expected }) }
}
