//! What can be wrong with a file of frequency responses.

use dashpot_datafiles::DataFile;

/// A file of frequency responses that cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{file}: {problem}")]
pub struct FrfError {
    /// The file.
    pub file: String,
    /// What is wrong.
    pub problem: FrfProblem,
}

/// What is wrong, where, and how to mend it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FrfProblem {
    #[error("{0}")]
    File(uff::Error),
    #[error("{0}")]
    Data(String),
    #[error("{set}: {what}")]
    Set { set: String, what: String },
    #[error(
        "has no frequency response: complex values over a frequency, or functions of type 4 (data set 58); name a file with them"
    )]
    NoResponses,
    #[error(
        "has no modes or operating shapes at nodes with a frequency (data sets 55 and 2414); name a file with them"
    )]
    NoShapes,
    #[error(
        "has no shape at a DOF of the structure; say under [modes.dofs] which they are, such as `\"12:+Z\" = LABEL`"
    )]
    ShapesElsewhere,
    #[error("cannot be written: {reason}; check the folder")]
    Unwritable { reason: String },
    #[error("node \"{node}\" has no number, as Universal Files need; number the nodes")]
    NodeName { node: String },
}

impl FrfProblem {
    /// The problem of a set, counted from 0.
    pub(super) fn set(index: usize, what: impl Into<String>) -> Self {
        Self::Set { set: format!("set {}", index + 1), what: what.into() }
    }

    /// The problem of a channel of a file of sets and channels.
    pub(super) fn channel(file: &DataFile, (set, channel): (usize, usize), what: &str) -> Self {
        let name = &file.contents().sets[set].channels[channel].name;
        Self::Set { set: format!("channel \"{name}\""), what: what.to_owned() }
    }
}
