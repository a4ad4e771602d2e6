//! What stops a file or a set from being read or written: one line, with the place and how to mend it.

use crate::Place;
use thiserror::Error;

/// An error with its place in the file.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{place}: {problem}")]
pub struct Error {
    /// Where.
    pub place: Place,
    /// What, and how to mend it.
    pub problem: Problem,
}

/// What is wrong.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Problem {
    /// The operating system says no.
    #[error("cannot be read: {reason}")]
    Io {
        /// In the words of the system.
        reason: String,
    },
    /// No delimiter anywhere.
    #[error(
        "no data set begins here (a line with only -1, then a line with the number of the set): is this a Universal File?"
    )]
    NoSets,
    /// There is no set of that number.
    #[error("there is no such set, the file has {sets}: count them from 0")]
    NoSuchSet {
        /// How many there are.
        sets: usize,
    },
    /// The line after the delimiter is no number.
    #[error("\"{text}\" is not the number of a data set: write for example \"    58\" after the line with -1")]
    NotASetNumber {
        /// What stands there.
        text: String,
    },
    /// The set ends before the record.
    #[error("the set ends before {record}: it was cut off, export it again")]
    Ends {
        /// The record that should follow.
        record: &'static str,
    },
    /// A field that is not what it must be.
    #[error("{field}: \"{text}\" is not {expected}: correct this field (columns {first} to {last})")]
    Field {
        /// Name of the field.
        field: &'static str,
        /// What stands there.
        text: String,
        /// What should stand there.
        expected: &'static str,
        /// First column, counted from 1.
        first: usize,
        /// Last column.
        last: usize,
    },
    /// A record with too few numbers.
    #[error("{record} needs {needed} numbers, {found} are here: fill the missing columns, 0 where nothing is known")]
    Short {
        /// Name of the record.
        record: &'static str,
        /// Numbers needed.
        needed: usize,
        /// Numbers found.
        found: usize,
    },
    /// Something among the values is no number.
    #[error("\"{text}\" among the values is not a number: correct it, or write NaN where nothing was measured")]
    Value {
        /// What stands there.
        text: String,
    },
    /// An ordinate type that does not exist.
    #[error("data type {found} does not exist: 2 (real) and 5 (complex) are single, 4 and 6 double precision")]
    DataType {
        /// What stands there.
        found: i64,
    },
    /// Binary floats that are not IEEE 754.
    #[error("floating format {found} ({name}) is not read: export with IEEE 754 (format 2)")]
    FloatingFormat {
        /// The number of the format.
        found: i64,
        /// Its name.
        name: &'static str,
    },
    /// A number that must not be negative.
    #[error("{field} is {found}: it must not be negative")]
    Negative {
        /// Name of the field.
        field: &'static str,
        /// What stands there.
        found: i64,
    },
    /// More values in a row than its record says.
    #[error(
        "{found} values stand here where the record says {expected}: correct the number of values or the data type"
    )]
    TooMany {
        /// Values expected.
        expected: usize,
        /// Values found.
        found: usize,
    },
    /// A set larger than the memory.
    #[error("the set has {bytes} bytes, more than the memory holds: export it in parts")]
    TooLarge {
        /// Size of the set.
        bytes: u64,
    },
    /// A number does not fit its columns.
    #[error("{field}: {text} does not fit the {width} columns of the format: choose a shorter one")]
    TooWide {
        /// Name of the field.
        field: &'static str,
        /// What was to be written.
        text: String,
        /// Columns there are.
        width: usize,
    },
    /// A character that Universal Files do not have.
    #[error(
        "{field}: \"{text}\" has a character outside latin-1, or a line break: Universal Files have neither, choose another"
    )]
    Character {
        /// Name of the field.
        field: &'static str,
        /// What was to be written.
        text: String,
    },
    /// Parts of a set that do not belong together.
    #[error("{what}: {found}, not {expected}")]
    Inconsistent {
        /// What was counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
}

/// An error of the system at a byte.
pub(crate) fn io_at(byte: u64) -> impl Fn(std::io::Error) -> Error {
    move |error| {
        let place = Place { byte, ..Place::default() };
        Error { place, problem: Problem::Io { reason: error.to_string() } }
    }
}
