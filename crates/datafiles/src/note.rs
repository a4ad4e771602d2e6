//! What the user should know of a file: what was skipped and why, what was assumed, and what is wrong with the file.

use std::fmt;

/// What is wrong or uncertain in a file and decides what can be read of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Defect {
    /// The last row of a table ends early: the file was cut off.
    CutOff,
    /// The recording ended before its last segment was complete.
    BrokenOff,
    /// Times are not in order.
    TimeGoesBack,
    /// Times without a unit rise by whole numbers: they may be no seconds.
    TimesCount,
    /// A part of the file is not read.
    NotRead,
}

/// A sentence about a file or a set.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// The sentence.
    pub text: String,
    /// The defect that it tells; `None` where it tells something else.
    pub defect: Option<Defect>,
}

impl Note {
    pub(crate) fn new(defect: Defect, text: String) -> Self {
        Self { text, defect: Some(defect) }
    }

    /// Whether it tells a defect.
    pub fn tells(&self, defect: Defect) -> bool {
        self.defect == Some(defect)
    }
}

/// That a part called `name` is not read, and why.
pub(crate) fn not_read(name: &str, why: &str) -> Note {
    Note::new(Defect::NotRead, format!("\"{name}\" is not read: {why}"))
}

impl From<String> for Note {
    fn from(text: String) -> Self {
        Self { text, defect: None }
    }
}

impl From<&str> for Note {
    fn from(text: &str) -> Self {
        Self::from(text.to_owned())
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
