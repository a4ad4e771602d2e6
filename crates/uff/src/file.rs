//! A file: the list of its sets, made without parsing their numbers, and each set when it is asked for.

use crate::body::Body;
use crate::entry::{Entry, Summary};
use crate::error::{Error, Problem, io_at};
use crate::lines::Lines;
use crate::place::Place;
use crate::scan;
use crate::sets::Set;
use crate::values::Values;
use crate::warning::Warning;
use std::io::{Cursor, Read, Seek};
use std::path::Path;

/// A set with its numbers and what was read over.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// The set.
    pub set: Set,
    /// Faults that were tolerated.
    pub warnings: Vec<Warning>,
}

/// An open Universal File.
///
/// ```
/// # fn main() -> Result<(), uff::Error> {
/// let text = "    -1\n   164\n         1SI: Meter (newton)           2\n  1.0D+00  1.0D+00  1.0D+00\n  2.7315D+02\n    -1\n";
/// let mut file = uff::File::from_bytes(text)?;
/// assert_eq!(file.sets()[0].number, 164);
/// let uff::Set::Units(units) = file.read(0)?.set else { unreachable!() };
/// assert_eq!(units.temperature_offset, 273.15);
/// # Ok(())
/// # }
/// ```
pub struct File<R> {
    lines: Lines<R>,
    sets: Vec<Entry>,
    warnings: Vec<Warning>,
}

impl File<std::fs::File> {
    /// Opens a file and lists its sets; their numbers are read when they are asked for.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        Self::scan(std::fs::File::open(path).map_err(io_at(0))?)
    }
}

impl<B: AsRef<[u8]>> File<Cursor<B>> {
    /// Lists the sets of a file in memory.
    pub fn from_bytes(bytes: B) -> Result<Self, Error> {
        Self::scan(Cursor::new(bytes))
    }
}

impl<R: Read + Seek> File<R> {
    /// Lists the sets of anything that can be read and searched. Long functions are passed over by a jump.
    pub fn scan(input: R) -> Result<Self, Error> {
        let mut lines = Lines::new(input).map_err(io_at(0))?;
        let found = scan::scan(&mut lines)?;
        Ok(Self { lines, sets: found.sets, warnings: found.warnings })
    }

    /// The sets in the order of the file.
    pub fn sets(&self) -> &[Entry] {
        &self.sets
    }

    /// Faults between the sets; those within a set come with [`Self::read`].
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// Size of the file in bytes.
    pub fn length(&self) -> u64 {
        self.lines.length
    }

    /// Reads set `i`, counted from 0.
    pub fn read(&mut self, i: usize) -> Result<Reading, Error> {
        let Some(entry) = self.sets.get(i) else {
            let place = Place { set: Some(i), ..Place::default() };
            return Err(Error { place, problem: Problem::NoSuchSet { sets: self.sets.len() } });
        };
        if let (0, Summary::Unreadable(error)) = (entry.number, &entry.summary) {
            return Err(error.clone());
        }
        let length = entry.bytes.end - entry.bytes.start;
        let (place, number, from) = (entry.place, entry.number, entry.bytes.start);
        self.read_bytes(place, number, from, length)
    }

    /// Reads the first values of set `i` alone, where it is a binary function in even steps that is longer than `most`
    /// bytes and is all there. None of any other set.
    pub fn first_values(&mut self, i: usize, most: u64) -> Option<Result<Values, Error>> {
        let entry = self.sets.get(i)?;
        let length = entry.bytes.end - entry.bytes.start;
        let Summary::Function(header) = &entry.summary else { return None };
        let whole = header.binary_sizes()[0] < length;
        if !entry.binary || !header.even || !whole || length <= most {
            return None;
        }
        let (place, number, from) = (entry.place, entry.number, entry.bytes.start);
        match self.read_bytes(place, number, from, most) {
            Ok(Reading { set: Set::Function(function), .. }) => Some(Ok(function.values)),
            Ok(_) => None,
            Err(error) => Some(Err(error)),
        }
    }

    fn read_bytes(&mut self, place: Place, number: u32, from: u64, length: u64) -> Result<Reading, Error> {
        let bytes = self.lines.bytes(from, length).map_err(|error| match error.kind() {
            std::io::ErrorKind::OutOfMemory => Error { place, problem: Problem::TooLarge { bytes: length } },
            _ => Error { place, problem: Problem::Io { reason: error.to_string() } },
        })?;
        let mut body = Body::new(&bytes, place);
        let set = Set::read(number, &mut body)?;
        Ok(Reading { set, warnings: body.warnings })
    }

    /// Reads all sets in turn; a set that cannot be read is an error in its place.
    pub fn read_all(&mut self) -> Vec<Result<Reading, Error>> {
        (0..self.sets.len()).map(|i| self.read(i)).collect()
    }
}
