//! Lines of a file that may be larger than the memory: only their first bytes are kept.

use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};

/// Bytes that are kept of a line: records have 80 columns, a few programs write longer ones.
pub(crate) const KEPT: usize = 512;

/// One line of a file.
#[derive(Debug, Clone)]
pub(crate) struct FileLine {
    /// Its first bytes, without its end.
    pub bytes: Vec<u8>,
    /// First byte of the line.
    pub byte: u64,
    /// Number of the line, counted from 1; `None` after binary data.
    pub line: Option<u64>,
}

/// A file read line by line, with jumps.
pub(crate) struct Lines<R> {
    input: BufReader<R>,
    /// First byte of the next line.
    pub byte: u64,
    /// Number of the next line.
    pub line: Option<u64>,
    pub length: u64,
}

impl<R: Read + Seek> Lines<R> {
    pub(crate) fn new(mut input: R) -> std::io::Result<Self> {
        const BUFFER: usize = 1 << 17;
        let length = input.seek(SeekFrom::End(0))?;
        input.seek(SeekFrom::Start(0))?;
        Ok(Self { input: BufReader::with_capacity(BUFFER, input), byte: 0, line: Some(1), length })
    }

    /// The next line; `None` at the end of the file.
    pub(crate) fn next(&mut self) -> std::io::Result<Option<FileLine>> {
        let mut bytes = Vec::with_capacity(80);
        let kept = self.input.by_ref().take(KEPT as u64).read_until(b'\n', &mut bytes)?;
        if kept == 0 {
            return Ok(None);
        }
        let (byte, line) = (self.byte, self.line);
        self.byte += kept as u64;
        if bytes.last() != Some(&b'\n') {
            self.byte += self.input.skip_until(b'\n')? as u64;
        }
        self.line = line.map(|line| line + 1);
        while bytes.last().is_some_and(|b| matches!(b, b'\n' | b'\r')) {
            bytes.pop();
        }
        Ok(Some(FileLine { bytes, byte, line }))
    }

    /// Goes to a byte; `line` is the number of the line that begins there.
    pub(crate) fn go(&mut self, byte: u64, line: Option<u64>) -> std::io::Result<()> {
        let offset = i64::try_from(byte).ok().zip(i64::try_from(self.byte).ok());
        match offset {
            Some((to, from)) => self.input.seek_relative(to - from)?,
            None => drop(self.input.seek(SeekFrom::Start(byte))?),
        }
        (self.byte, self.line) = (byte, line);
        Ok(())
    }

    /// Reads up to `length` bytes from `byte` on and stays after them.
    pub(crate) fn bytes(&mut self, byte: u64, length: u64) -> std::io::Result<Vec<u8>> {
        self.go(byte, None)?;
        let mut bytes = Vec::new();
        let there = length.min(self.length.saturating_sub(byte));
        let there = usize::try_from(there).map_err(|_| std::io::ErrorKind::OutOfMemory)?;
        bytes.try_reserve_exact(there).map_err(|_| std::io::ErrorKind::OutOfMemory)?;
        self.input.by_ref().take(there as u64).read_to_end(&mut bytes)?;
        self.byte += bytes.len() as u64;
        Ok(bytes)
    }
}

/// Number of blanks before a delimiter, a line with only `-1`; `None` if the line is none. Numbers in columns of ten are
/// none.
pub(crate) fn delimiter(line: &[u8]) -> Option<usize> {
    const MOST_INDENT: usize = 6;
    let text = crate::number::trim(line);
    let indent = line.iter().position(|b| !b.is_ascii_whitespace())?;
    (text == b"-1" && indent <= MOST_INDENT).then_some(indent)
}
