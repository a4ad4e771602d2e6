//! What can be wrong with a project, said in one line: file, line, what, and how to mend it.

use crate::effects::Effect;
use crate::effects::source::SourceError;
use crate::exchange::frf::FrfError;
use crate::exchange::matrices::TableError;
use crate::exchange::records::RecordFileError;
use crate::measurement::channel::ChannelError;
use crate::measurement::{FitError, RecordError, TransientRunError};
use crate::structure::StructureError;
use std::fmt;

/// A project that cannot be used.
#[derive(Debug, Clone, PartialEq)]
pub struct ProjectError {
    /// File as its reader was given it; empty where the project was not read from one.
    pub file: String,
    /// Line of the file, from 1, where one is at fault.
    pub line: Option<usize>,
    /// What is wrong.
    pub problem: Box<TableProblem>,
}

impl ProjectError {
    pub(super) fn new(file: &str, line: Option<usize>, problem: TableProblem) -> Self {
        Self { file: file.to_owned(), line, problem: Box::new(problem) }
    }
}

impl fmt::Display for ProjectError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Tables and records name their own file and line, which is where the user must look.
        if matches!(*self.problem, TableProblem::Table(_) | TableProblem::Record(_)) {
            return write!(f, "{}", self.problem);
        }
        match self.line {
            Some(line) => write!(f, "{}:{line}: {}", self.file, self.problem),
            None if self.file.is_empty() => write!(f, "{}", self.problem),
            None => write!(f, "{}: {}", self.file, self.problem),
        }
    }
}

impl std::error::Error for ProjectError {}

/// What is wrong with a project.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum TableProblem {
    #[error("cannot be read: {reason}; check the path")]
    Unreadable { reason: String },
    #[error("byte {position} is not UTF-8; save the project as UTF-8 text")]
    NotText { position: usize },
    #[error("not valid TOML: {message}")]
    Syntax { message: String },
    #[error("{table} has no key `{key}`; {hint}")]
    UnknownKey { table: String, key: String, hint: String },
    #[error("{table} lacks `{key}`; add `{example}`")]
    MissingKey { table: String, key: &'static str, example: String },
    #[error("`{key}` must be {expected}, not {found}")]
    WrongType { key: String, expected: &'static str, found: &'static str },
    #[error("`{key} = {value}` is not a usable number; it must be {range}")]
    OutOfRange { key: String, value: String, range: &'static str },
    #[error("`{key} = \"{value}\"` is not understood; use one of {allowed}")]
    NotAllowed { key: String, value: String, allowed: String },
    #[error("format {found} was written by a newer version of dashpot; this one reads format 1, so update dashpot")]
    Newer { found: u64 },
    #[error("{what} is given twice{}; leave one out", first_in(*first))]
    Twice { what: String, first: Option<usize> },
    #[error("{}", source_twice(*law, source_name, *first))]
    SourceTwice { law: Effect, source_name: String, first: Option<usize> },
    #[error("{table} has no {what}; add {example}")]
    Empty { table: String, what: &'static str, example: &'static str },
    #[error("`{key}` is there without `{other}`; give both or none")]
    HalfAForce { key: &'static str, other: &'static str },
    #[error("`set` and `sets` both say where the channels are; leave `set` out")]
    SetAndSets,
    #[error("a `points` structure has no mass matrix to add a lumped mass to; leave it out or give the matrices")]
    MassOnPoints,
    #[error("law `{law}` is an error of a measuring channel; write it under [[sensor]] with `channel`")]
    ChannelLaw { law: &'static str },
    #[error("the family `{family}` finds no place on this structure; choose another `where`")]
    EmptyFamily { family: &'static str },
    #[error("no record has the channel \"{channel}\"; correct its name or leave the [[sensor]] out")]
    NoSuchChannel { channel: String },
    #[error("there is nothing measured; add [[run]] with `file`, or [[harmonics]]")]
    NothingMeasured,
    #[error("the record {file} is not there yet; run `dashpot simulate` on this project first, or correct `file`")]
    NotSimulated { file: String },
    #[error("the record {file} is not there; correct `file`, which is relative to the project")]
    NoRecord { file: String },
    #[error(
        "the record {file} would be written outside the folder of the records; name a file inside it, without `..`"
    )]
    OutsideFolder { file: String },
    #[error(
        "the base moves in {file}, but the structure has no mass that its motion could load; give mass and stiffness"
    )]
    BaseWithoutMass { file: String },
    #[error(
        "{channel} in {file} shows the moving base too; in time it can be taken out of accelerations only: measure them, or give response = \"relative\""
    )]
    RidesOnBase { file: String, channel: String },
    #[error("record {file}: {error}")]
    Fit { file: String, error: FitError },
    #[error("record {file}: {error}; it looks like kind = \"{kind}\": {reason}")]
    NotSteady { file: String, error: FitError, kind: &'static str, reason: String },
    #[error("record {file} between start_s and end_s: {error}")]
    Part { file: String, error: RecordError },
    #[error("record {file}: {error}")]
    Transient { file: String, error: TransientRunError },
    #[error("cancelled")]
    Cancelled,
    #[error("{0}")]
    Structure(Box<StructureError>),
    #[error("{0}")]
    Source(Box<SourceError>),
    #[error("{0}")]
    Channel(Box<ChannelError>),
    #[error("{0}")]
    Table(TableError),
    #[error("{0}")]
    Record(Box<RecordFileError>),
    #[error("{0}")]
    Frf(Box<FrfError>),
    #[error("{file} has no usable line in the band; correct `band`")]
    NoLines { file: String },
}

fn first_in(line: Option<usize>) -> String {
    line.map_or_else(String::new, |line| format!(", first in line {line}"))
}

/// Of a text the lines, of what is drawn the place.
fn source_twice(law: Effect, source_name: &str, first: Option<usize>) -> String {
    match first {
        Some(_) => format!("law `{law}` at the same place is given twice{}; leave one out", first_in(first)),
        None => format!("already drawn: {source_name}; change that one instead"),
    }
}
