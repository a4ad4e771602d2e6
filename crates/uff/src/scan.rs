//! Where the sets of a file begin and end.
//!
//! A set stands between two lines with only `-1`; the line after the first one holds its number. Binary functions may
//! hold anything that looks like a delimiter, so that their end is computed from the header and then looked at; long
//! functions in text are passed over in the same way.

use crate::entry::{Entry, Summary};
use crate::error::{Error, Problem, io_at};
use crate::lines::{FileLine, Lines, delimiter};
use crate::number::{integer, trim};
use crate::place::Place;
use crate::text::quote;
use crate::warning::{Fault, Warning};
use std::io::{Read, Seek};

/// The sets of a file, and the faults between them.
#[derive(Default)]
pub(crate) struct Found {
    pub sets: Vec<Entry>,
    pub warnings: Vec<Warning>,
}

/// Lines at the head of a set that its summary is made from.
const HEAD: usize = 20;

/// Lists the sets of a file.
pub(crate) fn scan<R: Read + Seek>(lines: &mut Lines<R>) -> Result<Found, Error> {
    let mut found = Found::default();
    let mut outside = false;
    // A line with -1 that closed a set and may open the next one too.
    let mut closing: Option<FileLine> = None;
    while let Some(line) = next(lines)? {
        let line = without_mark(line);
        if trim(&line.bytes).is_empty() {
            continue;
        }
        if let Some(indent) = delimiter(&line.bytes) {
            outside = false;
            closing = set(lines, &mut found, line, indent)?;
        } else if let (Some(shared), Some(_)) = (&closing, kind(&line.bytes).filter(|kind| kind.known)) {
            found.warn(shared, Fault::MissingDelimiter);
            closing = one_set(lines, &mut found, line)?;
        } else {
            if !outside {
                found.warn(&line, Fault::TextOutside);
            }
            (outside, closing) = (true, None);
        }
    }
    if found.sets.is_empty() {
        let place = Place { line: Some(1), ..Place::default() };
        return Err(Error { place, problem: Problem::NoSets });
    }
    Ok(found)
}

fn next<R: Read + Seek>(lines: &mut Lines<R>) -> Result<Option<FileLine>, Error> {
    let at = lines.byte;
    lines.next().map_err(io_at(at))
}

/// The first line of a file without the byte order mark of UTF-8.
fn without_mark(mut line: FileLine) -> FileLine {
    if line.byte == 0 && line.bytes.starts_with(b"\xef\xbb\xbf") {
        line.bytes.drain(..3);
    }
    line
}

impl Found {
    fn warn(&mut self, line: &FileLine, fault: Fault) {
        let place = Place { line: line.line, byte: line.byte, ..Place::default() };
        self.warnings.push(Warning { place, fault });
    }
}

/// What the line after a delimiter says.
struct KindLine {
    number: u32,
    binary: bool,
    known: bool,
}

fn kind(line: &[u8]) -> Option<KindLine> {
    let text = trim(line);
    let digits = text.iter().take_while(|b| b.is_ascii_digit()).count();
    let number = u32::try_from(integer(&text[..digits])?).ok()?;
    let rest = &text[digits..];
    let binary = number == 58 && rest.first().is_some_and(|b| matches!(b, b'b' | b'B'));
    let plain = rest.first().is_none_or(u8::is_ascii_whitespace);
    let alone = binary || rest.iter().all(u8::is_ascii_whitespace);
    let known = alone && matches!(number, 15 | 18 | 55 | 58 | 82 | 151 | 164 | 2411 | 2412 | 2414 | 2420);
    (binary || plain).then_some(KindLine { number, binary, known })
}

/// The set after a delimiter. Gives the line that closes it.
fn set<R: Read + Seek>(
    lines: &mut Lines<R>,
    found: &mut Found,
    mut opening: FileLine,
    indent: usize,
) -> Result<Option<FileLine>, Error> {
    const INDENT: usize = 4;
    if indent != INDENT {
        found.warn(&opening, Fault::Indented);
    }
    loop {
        let Some(line) = next(lines)? else {
            found.warn(&opening, Fault::NumberMissing);
            return Ok(None);
        };
        if trim(&line.bytes).is_empty() {
            continue;
        }
        if delimiter(&line.bytes).is_some() {
            found.warn(&opening, Fault::StrayDelimiter);
            opening = line;
            continue;
        }
        return one_set(lines, found, line);
    }
}

/// The set whose number stands in `first`. Gives the line that closes it.
fn one_set<R: Read + Seek>(
    lines: &mut Lines<R>,
    found: &mut Found,
    first: FileLine,
) -> Result<Option<FileLine>, Error> {
    let index = found.sets.len();
    let said = kind(&first.bytes);
    let number = said.as_ref().map_or(0, |said| said.number);
    let binary = said.as_ref().is_some_and(|said| said.binary);
    let place = Place { set: Some(index), kind: said.as_ref().map(|_| number), line: first.line, byte: first.byte };
    let mut head = first.bytes.clone();
    head.push(b'\n');
    let end = if number == 58 { function_end(lines, &mut head, place, binary)? } else { plain_end(lines, &mut head)? };
    let summary = match said {
        Some(_) => Summary::read(number, &head, place),
        None => Summary::Unreadable(Error { place, problem: Problem::NotASetNumber { text: quote(&first.bytes) } }),
    };
    let bytes = first.byte..end.as_ref().map_or(lines.length, |end| end.byte);
    if end.is_none() {
        let place = Place { line: lines.line, byte: lines.length, ..place };
        found.warnings.push(Warning { place, fault: Fault::NotClosed });
    }
    found.sets.push(Entry { number, binary, place, bytes, summary });
    Ok(end)
}

/// The closing line of a set of text; its first lines go to `head`.
fn plain_end<R: Read + Seek>(lines: &mut Lines<R>, head: &mut Vec<u8>) -> Result<Option<FileLine>, Error> {
    let mut kept = 1;
    while let Some(line) = next(lines)? {
        if delimiter(&line.bytes).is_some() {
            return Ok(Some(line));
        }
        if kept < HEAD {
            head.extend_from_slice(&line.bytes);
            head.push(b'\n');
            kept += 1;
        }
    }
    Ok(None)
}

/// The closing line of a function.
fn function_end<R: Read + Seek>(
    lines: &mut Lines<R>,
    head: &mut Vec<u8>,
    place: Place,
    binary: bool,
) -> Result<Option<FileLine>, Error> {
    const RECORDS: usize = 11;
    for _ in 0..RECORDS {
        let Some(line) = next(lines)? else { return Ok(None) };
        if delimiter(&line.bytes).is_some() {
            return Ok(Some(line));
        }
        head.extend_from_slice(&line.bytes);
        head.push(b'\n');
    }
    let Summary::Function(header) = Summary::read(58, head, place) else {
        return if binary { search(lines) } else { plain_end(lines, &mut Vec::new()) };
    };
    if binary {
        let declared = header.binary.map_or(0, |binary| binary.bytes);
        let [all, narrow] = header.binary_sizes();
        for size in [declared, all, narrow] {
            if let Some(line) = closing_at(lines, size)? {
                return Ok(Some(line));
            }
        }
        return search(lines);
    }
    if let Some(line) = text_jump(lines, header.count.saturating_mul(header.numbers_per_value()))? {
        return Ok(Some(line));
    }
    plain_end(lines, &mut Vec::new())
}

/// The closing line after `size` bytes, with blanks and line ends before it let pass; stays where it was if there is none.
fn closing_at<R: Read + Seek>(lines: &mut Lines<R>, size: u64) -> Result<Option<FileLine>, Error> {
    const LOOKED_AT: u64 = 128;
    let start = lines.byte;
    let Some(at) = start.checked_add(size).filter(|&at| at <= lines.length) else { return Ok(None) };
    let bytes = lines.bytes(at, LOOKED_AT).map_err(io_at(at))?;
    let mut from = 0;
    while let Some(rest) = bytes.get(from..).filter(|rest| !rest.is_empty()) {
        let length = rest.iter().position(|&b| b == b'\n').map_or(rest.len(), |length| length + 1);
        if delimiter(&rest[..length]).is_some() {
            let byte = at + from as u64;
            lines.go(byte, None).map_err(io_at(byte))?;
            return next(lines);
        }
        if !trim(&rest[..length]).is_empty() {
            break;
        }
        from += length;
    }
    lines.go(start, None).map_err(io_at(start))?;
    Ok(None)
}

/// Passes over the lines of a long function of text, all of which are as long as the first; stays where it was if no
/// delimiter stands where it should then.
fn text_jump<R: Read + Seek>(lines: &mut Lines<R>, numbers: u64) -> Result<Option<FileLine>, Error> {
    const WORTH_IT: u64 = 10_000;
    let (start, line) = (lines.byte, lines.line);
    let Some(first) = next(lines)? else { return Ok(None) };
    let (length, mut per_line, mut at) = (lines.byte - start, 0, 0);
    while crate::number::next_token(&first.bytes, &mut at).is_some() {
        per_line += 1;
    }
    if numbers >= WORTH_IT && per_line > 0 {
        let width = first.bytes.len() as u64 / per_line;
        let ending = length - first.bytes.len() as u64;
        let (full, rest) = (numbers / per_line, numbers % per_line);
        let lasts = if rest == 0 { vec![0] } else { vec![rest * width + ending, length] };
        for last in lasts {
            let end = full.checked_mul(length).and_then(|size| start.checked_add(size)?.checked_add(last));
            let Some(end) = end.filter(|&end| end < lines.length) else { continue };
            lines.go(end - 1, None).map_err(io_at(end))?;
            let before = next(lines)?.is_some_and(|line| line.bytes.is_empty());
            lines.line = line.map(|line| line + full + u64::from(rest > 0));
            if before && let Some(line) = next(lines)?.filter(|line| delimiter(&line.bytes).is_some()) {
                return Ok(Some(line));
            }
        }
    }
    lines.go(start, line).map_err(io_at(start))?;
    Ok(None)
}

/// Searches the bytes for a delimiter after which the file ends or another set begins.
fn search<R: Read + Seek>(lines: &mut Lines<R>) -> Result<Option<FileLine>, Error> {
    const BLOCK: u64 = 1 << 20;
    const OVERLAP: u64 = 256;
    const MARK: &[u8] = b"    -1";
    let start = lines.byte;
    let mut from = start;
    loop {
        let block = lines.bytes(from, BLOCK).map_err(io_at(from))?;
        let last = from + block.len() as u64 >= lines.length;
        let mut at = 0;
        while let Some(hit) = block[at..].windows(MARK.len()).position(|window| window == MARK).map(|hit| at + hit) {
            let cut = !last && block.len() as u64 - (hit as u64) < OVERLAP;
            if !cut && closes(&block[hit + MARK.len()..]) {
                let byte = from + hit as u64;
                lines.go(byte, None).map_err(io_at(byte))?;
                return next(lines);
            }
            at = hit + 1;
        }
        if last {
            lines.go(lines.length, None).map_err(io_at(lines.length))?;
            return Ok(None);
        }
        from += BLOCK - OVERLAP;
    }
}

/// Whether what follows a `-1` says that it is a delimiter: blanks, a line end, then the end of the file or another `-1`.
fn closes(after: &[u8]) -> bool {
    let mut lines = after.split(|&b| b == b'\n');
    let rest_of_line = lines.next().unwrap_or_default();
    if !trim(rest_of_line).is_empty() {
        return false;
    }
    lines.find(|line| !trim(line).is_empty()).is_none_or(|line| delimiter(line).is_some())
}
