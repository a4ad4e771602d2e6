//! Where a channel of a laboratory file cannot be read as its table says.

use crate::exchange::records::{RecordFileError, RecordProblem};

/// The file that is being read.
pub(super) struct At<'a> {
    pub file: &'a str,
}

impl At<'_> {
    /// What is wrong with one of its channels, or with the file.
    pub(super) fn error(&self, column: Option<&str>, problem: impl Into<String>) -> RecordFileError {
        let problem = RecordProblem::DataFile { problem: problem.into() };
        RecordFileError {
            file: self.file.to_owned(),
            line: None,
            column: column.map(|name| format!("channel \"{name}\"")),
            problem,
        }
    }
}

/// The error of the file itself.
pub(super) fn data(at: &At<'_>, error: dashpot_datafiles::Error) -> RecordFileError {
    let problem = RecordProblem::DataFile { problem: error.problem };
    RecordFileError { file: at.file.to_owned(), line: None, column: error.place, problem }
}
