//! The lines of one set, with their places and the warnings that come up while they are read.

use crate::error::{Error, Problem};
use crate::number::{self, Token, next_token};
use crate::place::Place;
use crate::text::quote;
use crate::warning::{Fault, Warning};

/// One line without its end.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line<'a> {
    pub bytes: &'a [u8],
    /// Offset in the set.
    pub at: usize,
    /// Lines of the set before it.
    pub lines_before: u64,
}

/// The text of one set.
pub(crate) struct Body<'a> {
    bytes: &'a [u8],
    at: usize,
    lines: u64,
    /// Place of the first byte.
    origin: Place,
    pub warnings: Vec<Warning>,
}

impl<'a> Body<'a> {
    pub(crate) fn new(bytes: &'a [u8], origin: Place) -> Self {
        Self { bytes, at: 0, lines: 0, origin, warnings: Vec::new() }
    }

    /// The next line, blank or not.
    pub(crate) fn any_line(&mut self) -> Option<Line<'a>> {
        let rest = self.bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let length = rest.iter().position(|&b| b == b'\n');
        let line = Line { bytes: &rest[..length.unwrap_or(rest.len())], at: self.at, lines_before: self.lines };
        self.at += length.map_or(rest.len(), |length| length + 1);
        self.lines += 1;
        Some(Line { bytes: line.bytes.strip_suffix(b"\r").unwrap_or(line.bytes), ..line })
    }

    /// The next line that is not blank; blank ones are told.
    pub(crate) fn line(&mut self) -> Option<Line<'a>> {
        loop {
            let line = self.any_line()?;
            if !number::trim(line.bytes).is_empty() {
                return Some(line);
            }
            if self.rest().iter().any(|b| !b.is_ascii_whitespace()) {
                self.warn(line, Fault::BlankLine);
            }
        }
    }

    /// The line that must follow.
    pub(crate) fn required(&mut self, record: &'static str) -> Result<Line<'a>, Error> {
        self.any_line().ok_or_else(|| self.error_here(Problem::Ends { record }))
    }

    /// The line after this one, left where it is.
    pub(crate) fn peek(&mut self) -> Option<Line<'a>> {
        let (at, lines, warnings) = (self.at, self.lines, self.warnings.len());
        let line = self.line();
        (self.at, self.lines) = (at, lines);
        self.warnings.truncate(warnings);
        line
    }

    /// Goes back to the beginning of a line.
    pub(crate) fn back_to(&mut self, line: Line<'_>) {
        self.at = line.at;
        self.lines = line.lines_before;
    }

    /// What was not read yet.
    pub(crate) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or_default()
    }

    pub(crate) fn place(&self, line: Line<'_>) -> Place {
        self.place_at(line.at, line.lines_before)
    }

    fn place_at(&self, at: usize, lines: u64) -> Place {
        Place { line: self.origin.line.map(|first| first + lines), byte: self.origin.byte + at as u64, ..self.origin }
    }

    pub(crate) fn warn(&mut self, line: Line<'_>, fault: Fault) {
        let place = self.place(line);
        self.warnings.push(Warning { place, fault });
    }

    /// A warning at the place where reading stopped.
    pub(crate) fn warn_here(&mut self, fault: Fault) {
        let place = self.place_at(self.at, self.lines);
        self.warnings.push(Warning { place, fault });
    }

    pub(crate) fn error(&self, line: Line<'_>, problem: Problem) -> Error {
        Error { place: self.place(line), problem }
    }

    pub(crate) fn error_here(&self, problem: Problem) -> Error {
        Error { place: self.place_at(self.at, self.lines), problem }
    }

    /// Whole numbers separated by blanks, or `None` if something else stands there.
    pub(crate) fn integers(line: Line<'_>) -> Option<Vec<i64>> {
        let mut numbers = Vec::new();
        for token in line.bytes.split(u8::is_ascii_whitespace).filter(|token| !token.is_empty()) {
            numbers.push(number::integer(token)?);
        }
        Some(numbers)
    }

    /// Real numbers of the coming lines until `wanted` are there or the set ends. Tells what is not finite.
    pub(crate) fn reals(&mut self, wanted: usize) -> Result<Vec<f64>, Error> {
        // A number takes two bytes at least: a count never asks for more memory than the set could fill.
        let mut values = Vec::with_capacity(wanted.min(self.rest().len() / 2 + 1));
        let mut odd = Odd::default();
        while values.len() < wanted {
            let Some(line) = self.line() else { break };
            self.reals_of(line, wanted, &mut values, &mut odd)?;
        }
        odd.tell(self);
        Ok(values)
    }

    /// The numbers of one line, as many as are still wanted.
    pub(crate) fn reals_of(
        &self,
        line: Line<'a>,
        wanted: usize,
        values: &mut Vec<f64>,
        odd: &mut Odd<'a>,
    ) -> Result<(), Error> {
        let mut at = 0;
        while let Some(token) = next_token(line.bytes, &mut at) {
            match token {
                _ if values.len() == wanted => odd.surplus(line),
                Token::Number(value) => {
                    odd.not_finite(line, !value.is_finite());
                    values.push(value);
                }
                Token::Overflowed => {
                    odd.overflowed(line);
                    values.push(f64::NAN);
                }
                Token::Bad(text) => return Err(self.error(line, Problem::Value { text: quote(text) })),
            }
        }
        Ok(())
    }
}

/// Oddities among many numbers, told once with the place of the first.
#[derive(Default)]
pub(crate) struct Odd<'a> {
    not_finite: Option<(Line<'a>, u64)>,
    overflowed: Option<(Line<'a>, u64)>,
    /// Numbers beyond those wanted, on the last line that was read.
    pub surplus: Option<(Line<'a>, u64)>,
}

impl<'a> Odd<'a> {
    fn not_finite(&mut self, line: Line<'a>, odd: bool) {
        if odd {
            self.not_finite.get_or_insert((line, 0)).1 += 1;
        }
    }

    fn overflowed(&mut self, line: Line<'a>) {
        self.overflowed.get_or_insert((line, 0)).1 += 1;
    }

    fn surplus(&mut self, line: Line<'a>) {
        self.surplus.get_or_insert((line, 0)).1 += 1;
    }

    /// Adds the oddities of later lines.
    pub(crate) fn join(&mut self, later: Self) {
        let add = |sum: &mut Option<(Line<'a>, u64)>, more: Option<(Line<'a>, u64)>| {
            if let Some((line, count)) = more {
                sum.get_or_insert((line, 0)).1 += count;
            }
        };
        add(&mut self.not_finite, later.not_finite);
        add(&mut self.overflowed, later.overflowed);
    }

    /// Hands the warnings over.
    pub(crate) fn tell(&self, body: &mut Body<'a>) {
        if let Some((line, values)) = self.not_finite {
            body.warn(line, Fault::NotFinite { values });
        }
        if let Some((line, values)) = self.overflowed {
            body.warn(line, Fault::Overflowed { values });
        }
    }
}
