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
    let bytes = bytes.strip_prefix(&[0xEF, 0xBB, 0xBF]).unwrap_or(bytes);
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
