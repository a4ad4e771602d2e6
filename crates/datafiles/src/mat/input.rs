//! Bytes of an element of a MAT file, plain or compressed.

use crate::bytes::take;
use crate::error::{Fault, Read};
use crate::tree::Cut;
use flate2::read::ZlibDecoder;
use std::fs::File;
use std::io::{self, BufReader, Read as _};

/// A word of four bytes.
pub(super) fn word(bytes: &[u8], big: bool) -> u32 {
    let bytes = bytes.get(..4).and_then(|bytes| bytes.try_into().ok()).unwrap_or_default();
    if big { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }
}

/// Bytes of an element.
pub(super) enum Input {
    Plain(io::Take<BufReader<File>>),
    Packed(Box<ZlibDecoder<io::Take<BufReader<File>>>>),
}

impl io::Read for Input {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Plain(file) => file.read(buffer),
            Self::Packed(stream) => stream.read(buffer).map_err(|error| match error.kind() {
                io::ErrorKind::UnexpectedEof => error,
                _ => io::Error::new(io::ErrorKind::InvalidData, error.to_string()),
            }),
        }
    }
}

impl Input {
    /// Exactly `count` bytes.
    pub(super) fn some(&mut self, count: u64) -> Read<Vec<u8>> {
        take(self, count)
    }

    /// Passes over `count` bytes.
    pub(super) fn skip(&mut self, count: u64) -> Read<()> {
        if let Self::Plain(file) = self {
            // Within the element: a jump in place of reading.
            if count > file.limit() {
                return Err(io::Error::from(io::ErrorKind::UnexpectedEof).into());
            }
            let left = file.limit() - count;
            file.get_mut().seek_relative(i64::try_from(count).unwrap_or(i64::MAX))?;
            file.set_limit(left);
            return Ok(());
        }
        let passed = io::copy(&mut self.take(count), &mut io::sink()).map_err(Fault::from)?;
        if passed < count { Err(io::Error::from(io::ErrorKind::UnexpectedEof).into()) } else { Ok(()) }
    }
}

/// A channel of an array.
#[derive(Debug, Clone)]
pub(super) struct Part {
    pub cut: Cut,
    pub channel: u64,
}
