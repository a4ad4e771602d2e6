//! Bytes to text: UTF-8 with or without a byte order mark, UTF-16, else Latin-1.

use crate::error::{Fault, Read};
use std::borrow::Cow;

/// The text of a file, and a note where its coding was assumed.
pub(crate) fn decode(bytes: &[u8]) -> Read<(Cow<'_, str>, Option<&'static str>)> {
    if let Some(wide) = bytes.strip_prefix(&[0xFF, 0xFE]) {
        return Ok((Cow::Owned(utf16(wide, u16::from_le_bytes)), None));
    }
    if let Some(wide) = bytes.strip_prefix(&[0xFE, 0xFF]) {
        return Ok((Cow::Owned(utf16(wide, u16::from_be_bytes)), None));
    }
    if let Some(number) = bare_utf16(bytes) {
        return Ok((Cow::Owned(utf16(bytes, number)), Some("read as UTF-16 text without a byte order mark")));
    }
    let bytes = bytes.strip_prefix(&[0xEF, 0xBB, 0xBF]).unwrap_or(bytes);
    // Files that were made longer than their text end in zeros, those of old systems in the mark of their end.
    let end = bytes.iter().rposition(|byte| !matches!(byte, 0 | 0x1A)).map_or(0, |last| last + 1);
    let bytes = &bytes[..end];
    if let Some(zero) = bytes.iter().take(1 << 16).position(|&byte| byte == 0) {
        let problem = "is no text and of no known format; export it as CSV, UFF, MAT, HDF5 or TDMS";
        return Err(Fault::byte(zero as u64, problem));
    }
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok((Cow::Borrowed(text), None)),
        Err(_) => Ok((
            Cow::Owned(bytes.iter().map(|&byte| latin(byte)).collect()),
            Some("read as Latin-1 text: it is not UTF-8"),
        )),
    }
}

/// The byte order of UTF-16 without its mark: of ASCII letters every other byte is zero, and no other.
fn bare_utf16(bytes: &[u8]) -> Option<fn([u8; 2]) -> u16> {
    let start = &bytes[..bytes.len().min(1 << 12) & !1];
    let zeros = |from: usize| start.iter().skip(from).step_by(2).filter(|&&byte| byte == 0).count();
    let [even, odd] = [zeros(0), zeros(1)];
    let most = start.len() / 2 - start.len() / 20;
    match (even, odd) {
        (0, odd) if odd > most && start.len() > 8 => Some(u16::from_le_bytes),
        (even, 0) if even > most && start.len() > 8 => Some(u16::from_be_bytes),
        _ => None,
    }
}

fn utf16(bytes: &[u8], number: fn([u8; 2]) -> u16) -> String {
    let units = bytes.chunks_exact(2).map(|pair| number([pair[0], pair[1]]));
    char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}

/// A letter of Latin-1; the few of Windows-1252 that stand in units and names.
fn latin(byte: u8) -> char {
    match byte {
        0x80 => '€',
        0x91 | 0x92 => '\'',
        0x93 | 0x94 => '"',
        0x96 | 0x97 => '-',
        other => char::from(other),
    }
}

/// Lines of a header in which cells in quotes may go on over several.
const HEAD: usize = 200;
/// Most further lines of one row.
const MOST_LINES: usize = 16;

/// Lines with their numbers from 1.
pub(super) fn numbered(text: &str) -> impl Iterator<Item = (u64, &str)> {
    text.lines().enumerate().map(|(i, line)| (i as u64 + 1, line))
}

/// Rows with the numbers of their lines from 1. Cells in quotes that go on over several lines, as spreadsheets write their heads, stand in one.
pub(super) fn rows(text: &str) -> impl Iterator<Item = (u64, Cow<'_, str>)> {
    let mut lines = text.lines().enumerate();
    std::iter::from_fn(move || {
        let (i, line) = lines.next()?;
        let more = if i < HEAD && opens(line) { further(line, lines.clone()) } else { 0 };
        let row = match more {
            0 => line.into(),
            more => [line]
                .into_iter()
                .chain(lines.by_ref().take(more).map(|(_, line)| line))
                .collect::<Vec<_>>()
                .join(" ")
                .into(),
        };
        Some((i as u64 + 1, row))
    })
}

/// Whether the last quote of a line opens a cell and is not closed.
fn opens(line: &str) -> bool {
    let begins = |at: usize| at == 0 || line[..at].ends_with([',', ';', '\t']);
    line.matches('"').count() % 2 == 1 && line.rfind('"').is_some_and(begins)
}

/// How many further lines a row has, until its quotes are closed; 0 where they are not.
fn further<'a>(line: &str, behind: impl Iterator<Item = (usize, &'a str)>) -> usize {
    let mut quotes = line.matches('"').count();
    let closed = behind.take(MOST_LINES).position(|(_, line)| {
        quotes += line.matches('"').count();
        quotes.is_multiple_of(2)
    });
    closed.map_or(0, |at| at + 1)
}
