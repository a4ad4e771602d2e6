//! Places in a file.

use std::fmt;

/// Where something stands: the set, the line as long as everything before it is text, and the byte.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Place {
    /// Set, counted from 0 as in [`crate::File::sets`]; shown counted from 1.
    pub set: Option<usize>,
    /// Number of the data set, such as 58.
    pub kind: Option<u32>,
    /// Line, counted from 1; `None` after binary data, where lines have no meaning.
    pub line: Option<u64>,
    /// Byte, counted from 0.
    pub byte: u64,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(set) = self.set {
            write!(f, "set {}", set + 1)?;
            if let Some(kind) = self.kind {
                write!(f, " ({kind})")?;
            }
            write!(f, ", ")?;
        }
        match self.line {
            Some(line) => write!(f, "line {line}"),
            None => write!(f, "byte {}", self.byte),
        }
    }
}
