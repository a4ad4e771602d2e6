//! What can be wrong with a file of measured data, said in one line with file, line and channel.

use crate::measurement::channel::ChannelError;
use crate::measurement::record::RecordError;
use std::fmt;

/// A file of measured data that cannot be used. Its message is one line: file, line, column, what is wrong and how to
/// mend it.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordFileError {
    /// File as its reader was given it.
    pub file: String,
    /// Line of the file, from 1, where one is at fault.
    pub line: Option<u64>,
    /// Column of the file, where one is at fault.
    pub column: Option<String>,
    /// What is wrong.
    pub problem: RecordProblem,
}

impl fmt::Display for RecordFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        if let Some(column) = &self.column {
            write!(f, ", {}", column.replace(char::is_control, " "))?;
        }
        // A quoted cell may hold line breaks, and a message that repeats it stays on one line.
        let problem = self.problem.to_string();
        write!(f, ": {}", problem.replace(char::is_control, " "))
    }
}

impl std::error::Error for RecordFileError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        None
    }
}

/// What is wrong with a file of measured data.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum RecordProblem {
    #[error("cannot be read: {reason}; check the path and the permissions")]
    Unreadable { reason: String },
    #[error("cannot be written: {reason}; check the folder and the permissions")]
    Unwritable { reason: String },
    #[error("is empty; export the record again")]
    Empty,
    #[error("is UTF-16 text; save it as CSV in UTF-8")]
    Utf16,
    #[error("is not text; export it as CSV in UTF-8")]
    Binary,
    #[error("the header is not UTF-8; save the file as CSV in UTF-8")]
    HeaderNotUtf8,
    #[error("only the header is there; export the record with its samples")]
    HeaderOnly,
    #[error("there is no header row; write time [s] and one QUANTITY@DOF [UNIT] a channel above the numbers")]
    NoHeader,
    #[error("the first column is \"{found}\"; it must be the time in seconds, named time [s]")]
    NoTime { found: String },
    #[error(
        "the time has no unit; name it time [s] where it is in seconds, with the units of the other columns in their names too"
    )]
    NoTimeUnit,
    #[error("the time is in \"{unit}\"; give it in seconds and name it time [s]")]
    TimeUnit { unit: String },
    #[error("the only column is the time; separate the columns by commas and name one QUANTITY@DOF [UNIT] a channel")]
    OneColumn,
    #[error("{problem}")]
    Channel { problem: ChannelError },
    #[error("column {number} has no name; name it QUANTITY@DOF [UNIT], such as acc@7 [m/s^2]")]
    NoName { number: usize },
    #[error("the quotation mark of \"{name}\" is not closed on its line; close or remove it")]
    OpenQuote { name: String },
    #[error("the structure has no DOF \"{label}\"; it has {known}")]
    UnknownDof { label: String, known: String },
    #[error(
        "no DOF of the structure moves along \"{label}\"; name the base by a direction in which DOFs move ({known}), such as base@z [m/s^2]"
    )]
    NoBaseAxis { label: String, known: String },
    #[error("DOF {label} is a {kind} and cannot be measured in {unit}; use one of {units}")]
    UnitOfOtherKind { label: String, kind: &'static str, unit: &'static str, units: String },
    #[error("there are {found} cells and the header has {expected}; give each row one cell a column{hint}")]
    Ragged { found: usize, expected: usize, hint: &'static str },
    #[error("the cell is empty; write its number or remove the row")]
    EmptyCell,
    #[error("\"{text}\" is not a number; write one such as 1.25e-3")]
    NotANumber { text: String },
    #[error("{text} is not a finite number; remove the row or mend the number")]
    NotFinite { text: String },
    #[error("sample {row} is {value:e} (SI units), more than any sensor reads; mend the number or remove the row")]
    BeyondMeasure { row: usize, value: f64 },
    #[error("{value:e} (SI units) is more than any sensor reads; mend the number or remove the row")]
    TooLarge { value: f64 },
    #[error("time {time} s follows {before} s; sort the rows by time")]
    TimeGoesBack { time: f64, before: f64 },
    #[error("{problem}")]
    Record { problem: RecordError },
    #[error("{problem}")]
    DataFile { problem: String },
    #[error("reading was cancelled")]
    Cancelled,
    #[error(
        "there is no column \"{name}\"; the columns are run, frequency_hz, channel, harmonic, cos, sin and, if known, cos_std, sin_std"
    )]
    NoColumn { name: &'static str },
    #[error("column \"{name}\" stands twice; remove one")]
    ColumnTwice { name: String },
    #[error(
        "column \"{name}\" is unknown; the columns are run, frequency_hz, channel, harmonic, cos, sin and, if known, cos_std, sin_std"
    )]
    UnknownColumn { name: String },
    #[error("there is a cos_std or a sin_std alone; give both or none")]
    HalfOfDeviations,
    #[error("\"{text}\" is not the number of a harmonic; write 1, 2, 3 and so on, at most {most}")]
    BadHarmonic { text: String, most: usize },
    #[error("\"{text}\" is not a frequency; write a positive number of hertz")]
    BadFrequency { text: String },
    #[error("\"{text}\" is not a standard deviation; write zero or a positive number")]
    BadDeviation { text: String },
    #[error("run {run} is at {found} Hz here and at {expected} Hz above; give a run one frequency")]
    TwoFrequencies { run: String, found: f64, expected: f64 },
    #[error("harmonic {harmonic} of this channel in run {run} stands twice; remove one")]
    HarmonicTwice { run: String, harmonic: usize },
    #[error("run {run} has no harmonic {harmonic} of this channel, but has {highest}; add the row")]
    MissingHarmonic { run: String, harmonic: usize, highest: usize },
    #[error("which channel the column \"{column}\" is, is not said; give `{key}` at [[harmonics]], such as `{key} = \"{}\"`",
            if *key == "force" { "force@1 [N]" } else { "acc@1 [m/s^2]" })]
    WhichChannel { column: String, key: &'static str },
    #[error("a phase column fits no single channel (\"{of}\"); name its channel behind it, such as `phase_deg acc@7`")]
    WhosePhase { of: String },
    #[error("there is no force; add a column such as force@1 [N] with its amplitudes")]
    NoForceColumn,
    #[error("{channel} has no phase; add the column `phase_deg {channel}`")]
    NoPhase { channel: String },
    #[error("\"{text}\" is not the number of a level; write a whole number")]
    BadLevel { text: String },
}

/// Makes errors of one file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct At<'a> {
    /// Name of the file for messages.
    pub(crate) file: &'a str,
}

impl At<'_> {
    /// The file as a whole is at fault.
    pub(super) fn file(self, problem: RecordProblem) -> RecordFileError {
        RecordFileError { file: self.file.to_owned(), line: None, column: None, problem }
    }

    /// A line is at fault.
    pub(super) fn line(self, line: u64, problem: RecordProblem) -> RecordFileError {
        RecordFileError { file: self.file.to_owned(), line: Some(line), column: None, problem }
    }

    /// A cell is at fault.
    pub(super) fn cell(self, line: u64, column: &str, problem: RecordProblem) -> RecordFileError {
        RecordFileError { file: self.file.to_owned(), line: Some(line), column: Some(column.to_owned()), problem }
    }

    /// A channel of a laboratory file is at fault, or the file where none is named.
    pub(crate) fn channel(self, name: Option<&str>, problem: impl Into<String>) -> RecordFileError {
        let column = name.map(|name| format!("channel \"{name}\""));
        let problem = RecordProblem::DataFile { problem: problem.into() };
        RecordFileError { file: self.file.to_owned(), line: None, column, problem }
    }

    /// A laboratory file cannot be read.
    pub(crate) fn data(self, error: dashpot_datafiles::Error) -> RecordFileError {
        let problem = RecordProblem::DataFile { problem: error.problem };
        RecordFileError { file: self.file.to_owned(), line: None, column: error.place, problem }
    }
}
