//! Binary: Fortran records, each between two copies of its length in bytes; the byte order is told by the first.

use super::header::{Found, Header, short_head};
use crate::error::{FileError, Place, Problem};

type Read<T> = Result<T, (usize, Problem)>;

pub(super) fn read(bytes: &[u8], file: &str) -> Result<Vec<Found>, FileError> {
    matrices(bytes).map_err(|(byte, problem)| FileError::new(file, Place::Byte(byte), problem))
}

fn matrices(bytes: &[u8]) -> Read<Vec<Found>> {
    let first: [u8; 4] = bytes.get(..4).and_then(|b| b.try_into().ok()).ok_or((0, END))?;
    let [little, big] = [u32::from_le_bytes(first), u32::from_be_bytes(first)];
    let is_header = |length: u32| length == 24 || length == 48;
    let is_little = is_header(little);
    if !is_little && !is_header(big) {
        return Err((0, Problem::NotOutput4 { found: little }));
    }
    let mut records = Records { bytes, at: 0, is_little };
    let mut found = Vec::new();
    while records.at < bytes.len() {
        let (at, record) = records.next()?;
        let wrong = |problem| (at, problem);
        let words = Words { bytes: record, is_little, is_wide: record.len() == 48 };
        if !is_header(record.len() as u32) {
            return Err(wrong(Problem::NotOutput4 { found: record.len() as u32 }));
        }
        let [columns, rows, _, kind] = [0, 1, 2, 3].map(|k| words.whole(k).unwrap_or(0));
        let name = String::from_utf8_lossy(&record[record.len() * 2 / 3..]).into_owned();
        let header = Header::new(columns, rows, kind, &name, bytes.len()).map_err(wrong)?;
        let is_wide = words.is_wide;
        let entries = columns_of(&mut records, &header, is_wide)?;
        found.push(Found { place: Place::Byte(at), header, entries });
    }
    Ok(found)
}

const END: Problem = Problem::EndsEarly { what: "a record" };

fn columns_of(records: &mut Records<'_>, header: &Header, is_wide: bool) -> Read<Vec<(usize, usize, f64)>> {
    let mut entries = Vec::new();
    loop {
        let (at, record) = records.next()?;
        let words = Words { bytes: record, is_little: records.is_little, is_wide };
        let wrong = |problem| (at, problem);
        let head = [0, 1, 2].map(|k| words.whole(k));
        let [Some(column), Some(row), Some(count)] = head else { return Err(wrong(END)) };
        if column > header.columns {
            return Ok(entries);
        }
        if header.refused.is_some() {
            continue;
        }
        let mut run = Run { header, words, next: 3, column, entries: &mut entries };
        if row > 0 {
            run.values(row, count).map_err(wrong)?;
        } else {
            run.strings(count).map_err(wrong)?;
        }
    }
}

struct Records<'a> {
    bytes: &'a [u8],
    at: usize,
    is_little: bool,
}

impl<'a> Records<'a> {
    /// Byte at which the record begins, and what is in it.
    fn next(&mut self) -> Read<(usize, &'a [u8])> {
        let at = self.at;
        let length = |at: usize| {
            let four: [u8; 4] = self.bytes.get(at..at + 4)?.try_into().ok()?;
            Some(if self.is_little { u32::from_le_bytes(four) } else { u32::from_be_bytes(four) } as usize)
        };
        let size = length(at).ok_or((at, END))?;
        let record = self.bytes.get(at + 4..at + 4 + size).ok_or((at, END))?;
        if length(at + 4 + size) != Some(size) {
            return Err((at, END));
        }
        self.at = at + 8 + size;
        Ok((at, record))
    }
}

/// Words of a record: four bytes, eight in files of 64-bit whole numbers.
#[derive(Clone, Copy)]
struct Words<'a> {
    bytes: &'a [u8],
    is_little: bool,
    is_wide: bool,
}

impl Words<'_> {
    fn width(self) -> usize {
        if self.is_wide { 8 } else { 4 }
    }

    fn four(self, at: usize) -> Option<[u8; 4]> {
        let mut four: [u8; 4] = self.bytes.get(at..at + 4)?.try_into().ok()?;
        if !self.is_little {
            four.reverse();
        }
        Some(four)
    }

    fn eight(self, at: usize) -> Option<[u8; 8]> {
        let mut eight: [u8; 8] = self.bytes.get(at..at + 8)?.try_into().ok()?;
        if !self.is_little {
            eight.reverse();
        }
        Some(eight)
    }

    fn whole(self, word: usize) -> Option<i64> {
        let at = word * self.width();
        if self.is_wide {
            self.eight(at).map(i64::from_le_bytes)
        } else {
            self.four(at).map(|b| i32::from_le_bytes(b).into())
        }
    }

    fn real(self, word: usize, is_double: bool) -> Option<f64> {
        let at = word * self.width();
        if is_double || self.is_wide {
            self.eight(at).map(f64::from_le_bytes)
        } else {
            self.four(at).map(|b| f32::from_le_bytes(b).into())
        }
    }
}

/// Where the reading of one column stands.
struct Run<'a, 'b> {
    header: &'a Header,
    words: Words<'a>,
    /// Next word of the record.
    next: usize,
    column: i64,
    entries: &'b mut Vec<(usize, usize, f64)>,
}

impl Run<'_, '_> {
    /// `count` words of values below each other from `row` on.
    fn values(&mut self, row: i64, count: i64) -> Result<(), Problem> {
        let each = if self.header.is_double && !self.words.is_wide { 2 } else { 1 };
        for k in 0..count / each {
            let value = self.words.real(self.next, self.header.is_double).ok_or(END)?;
            if !value.is_finite() {
                return Err(Problem::Number { text: value.to_string() });
            }
            let (row, column) = self.header.place(row + k, self.column)?;
            self.entries.push((row, column, value));
            self.next += each as usize;
        }
        Ok(())
    }

    /// Strings in `count` words.
    fn strings(&mut self, count: i64) -> Result<(), Problem> {
        let end = self.next + usize::try_from(count).map_err(|_| END)?;
        while self.next < end {
            let first = self.words.whole(self.next).ok_or(END)?;
            let (row, words) = if self.header.is_big {
                let row = self.words.whole(self.next + 1).ok_or(END)?;
                self.next += 2;
                (row, first - 1)
            } else {
                self.next += 1;
                short_head(first)
            };
            if words <= 0 {
                return Err(END);
            }
            self.values(row, words)?;
        }
        Ok(())
    }
}
