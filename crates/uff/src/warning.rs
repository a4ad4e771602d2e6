//! Faults that were read over: each is told with its place.

use crate::Place;
use std::fmt;

/// A fault that was tolerated.
#[derive(Debug, Clone, PartialEq)]
pub struct Warning {
    /// Where.
    pub place: Place,
    /// What it was, and what was made of it.
    pub fault: Fault,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.fault)
    }
}

/// What a laboratory's file may have wrong and can still be read.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Fault {
    /// Text that belongs to no set.
    TextOutside,
    /// A delimiter too many.
    StrayDelimiter,
    /// Two sets share one delimiter.
    MissingDelimiter,
    /// The file ends inside a set.
    NotClosed,
    /// A set without a number.
    NumberMissing,
    /// A delimiter that does not stand in columns 5 and 6.
    Indented,
    /// The byte count of a binary set is wrong.
    ByteCount {
        /// What the header says.
        declared: u64,
        /// What is there.
        found: u64,
    },
    /// Bytes between the values and the end of the set.
    StrayBytes {
        /// How many.
        bytes: u64,
    },
    /// Fewer values than the header says.
    Truncated {
        /// Values (or pairs) in the header.
        declared: u64,
        /// Values that are there.
        found: u64,
    },
    /// More values than the header says; the rest was left out.
    Surplus {
        /// Values in the header.
        declared: u64,
        /// Numbers left out.
        left_out: u64,
    },
    /// Values that are not finite.
    NotFinite {
        /// How many.
        values: u64,
    },
    /// Values that overflowed their columns (`*****`), read as NaN.
    Overflowed {
        /// How many.
        values: u64,
    },
    /// Characters outside ASCII.
    NotAscii,
    /// A record whose columns are shifted, read as separated by blanks.
    Columns {
        /// Name of the record.
        record: &'static str,
    },
    /// A blank line among the records.
    BlankLine,
    /// Byte order not said; taken from the values.
    ByteOrder {
        /// What stands there.
        found: i64,
    },
    /// Something other than 11 lines of header.
    HeaderLines {
        /// What the header says.
        declared: i64,
    },
    /// Abscissa spacing neither 0 nor 1, taken as even.
    Spacing {
        /// What stands there.
        found: i64,
    },
    /// An even abscissa without a step.
    ZeroStep,
    /// The count of entries is not the number of entries.
    Entries {
        /// What the header says.
        declared: u64,
        /// What is there.
        found: u64,
    },
    /// The record of orientation and sections of a beam element is missing.
    BeamRecord,
    /// A row with fewer values than its record says, filled with 0.
    ShortRow {
        /// Values expected.
        expected: usize,
        /// Values found.
        found: usize,
    },
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TextOutside => write!(f, "text between the sets was left out"),
            Self::StrayDelimiter => write!(f, "a -1 too many was left out"),
            Self::MissingDelimiter => write!(f, "the -1 between two sets is missing once"),
            Self::NotClosed => write!(f, "the file ends without the -1 that closes the set: it may have been cut off"),
            Self::NumberMissing => write!(f, "a -1 without a set after it was left out"),
            Self::Indented => write!(f, "the -1 does not stand in columns 5 and 6"),
            Self::ByteCount { declared, found } => {
                write!(f, "the header says {declared} bytes of data, {found} are there and were read")
            }
            Self::StrayBytes { bytes } => write!(f, "{bytes} stray bytes after the values were left out"),
            Self::Truncated { declared, found } => {
                write!(f, "cut off: the header says {declared} values, {found} are there and were read")
            }
            Self::Surplus { declared, left_out } => {
                write!(f, "the header says {declared} values; {left_out} numbers beyond them were left out")
            }
            Self::NotFinite { values } => write!(f, "{values} values are not finite"),
            Self::Overflowed { values } => write!(f, "{values} values overflowed their columns (*****), read as NaN"),
            Self::NotAscii => write!(f, "characters outside ASCII, read as UTF-8 or latin-1"),
            Self::Columns { record } => write!(f, "{record} is not in its columns, read as separated by blanks"),
            Self::BlankLine => write!(f, "a blank line was left out"),
            Self::ByteOrder { found } => write!(f, "byte order {found} is neither 1 nor 2, taken from the values"),
            Self::HeaderLines { declared } => write!(f, "the header says {declared} lines of text, 11 were read"),
            Self::Spacing { found } => write!(f, "abscissa spacing {found} is neither 0 nor 1, taken as even"),
            Self::ZeroStep => write!(f, "the abscissa has no step"),
            Self::Entries { declared, found } => {
                write!(f, "{declared} entries were announced, {found} are there and were read")
            }
            Self::BeamRecord => write!(f, "the record of orientation and sections of a beam is missing"),
            Self::ShortRow { expected, found } => {
                write!(f, "{found} of {expected} values in the row, the others were taken as 0")
            }
        }
    }
}
