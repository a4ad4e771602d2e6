//! Words of a TDMS file in its byte order.

use crate::bytes::take;
use crate::error::{Fault, Read};
use std::fs::File;
use std::io::{BufReader, Seek};

/// Longest text of the metadata, bytes.
const MOST_TEXT: u32 = 1 << 20;

/// Metadata of a segment.
pub(super) struct Input<'a> {
    pub file: &'a mut BufReader<File>,
    pub big: bool,
}

impl Input<'_> {
    pub(super) fn u8(&mut self) -> Read<u8> {
        Ok(self.array::<1>()?[0])
    }

    pub(super) fn u32(&mut self) -> Read<u32> {
        let bytes = self.array()?;
        Ok(if self.big { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
    }

    pub(super) fn u64(&mut self) -> Read<u64> {
        let bytes = self.array()?;
        Ok(if self.big { u64::from_be_bytes(bytes) } else { u64::from_le_bytes(bytes) })
    }

    pub(super) fn array<const N: usize>(&mut self) -> Read<[u8; N]> {
        let mut bytes = [0; N];
        std::io::Read::read_exact(self.file, &mut bytes)?;
        Ok(bytes)
    }

    pub(super) fn bytes(&mut self, count: u64) -> Read<Vec<u8>> {
        take(self.file, count)
    }

    pub(super) fn position(&mut self) -> Read<u64> {
        Ok(self.file.stream_position()?)
    }

    pub(super) fn text(&mut self) -> Read<String> {
        let length = self.u32()?;
        if length > MOST_TEXT {
            let at = self.position()? - 4;
            return Err(Fault::byte(
                at,
                format!("a text of {length} bytes is stated; the file is damaged: copy or export it again"),
            ));
        }
        Ok(String::from_utf8_lossy(&self.bytes(length.into())?).into_owned())
    }
}
