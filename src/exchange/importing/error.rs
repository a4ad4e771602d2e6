//! Why files cannot be imported.

use crate::exchange::matrices::TableError;
use crate::exchange::project::{ProjectError, TableProblem};
use std::path::Path;

/// What an import gives, or why it cannot.
pub(super) type Result<T, E = ImportError> = std::result::Result<T, E>;

/// A fault of a measurement without the line of the project that names it: there is no such file for the user to look into.
fn unwritten(error: &ProjectError) -> String {
    match *error.problem {
        TableProblem::Table(_)
        | TableProblem::Record(_)
        | TableProblem::Frf(_)
        | TableProblem::Fit { .. }
        | TableProblem::NotSteady { .. }
        | TableProblem::Part { .. }
        | TableProblem::Transient { .. } => error.problem.to_string(),
        _ => format!("{}, which is not written: {}", error.file, error.problem),
    }
}

/// One line: the file, what is wrong and how to mend it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum ImportError {
    #[error(transparent)]
    File(#[from] dashpot_datafiles::Error),
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// What is wrong with the project that the files would make, which is not written.
    #[error("{}", unwritten(.0))]
    Unwritten(ProjectError),
    #[error(transparent)]
    Model(#[from] TableError),
    #[error("{file}: {problem}")]
    Of { file: String, problem: String },
    #[error("{0}")]
    Said(String),
}

impl ImportError {
    /// What is wrong with a file.
    pub(super) fn of(file: &Path, problem: impl Into<String>) -> Self {
        Self::Of { file: file.display().to_string(), problem: problem.into() }
    }
}
