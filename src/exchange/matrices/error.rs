//! What can be wrong with a file of a matrix or of nodes, DOFs and lines.

use std::fmt;
use std::path::Path;

/// A file that cannot be used; its message is one line: file, line, what is wrong, how to mend it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableError {
    /// File as its reader was given it.
    pub file: String,
    /// Line of the file, from 1, where one is at fault.
    pub line: Option<usize>,
    /// What is wrong.
    pub problem: TableProblem,
}

impl TableError {
    /// A problem of the whole file.
    pub(super) fn file(file: &str, problem: TableProblem) -> Self {
        Self { file: file.to_owned(), line: None, problem }
    }

    /// A problem of a line, from 1.
    pub(super) fn line(file: &str, line: usize, problem: TableProblem) -> Self {
        Self { file: file.to_owned(), line: Some(line), problem }
    }
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let TableProblem::Model(error) = &self.problem {
            return write!(f, "{error}");
        }
        match self.line {
            Some(line) => write!(f, "{}:{line}: {}", self.file, self.problem),
            None => write!(f, "{}: {}", self.file, self.problem),
        }
    }
}

impl std::error::Error for TableError {}

impl From<dashpot_fe_files::FileError> for TableError {
    fn from(error: dashpot_fe_files::FileError) -> Self {
        Self { file: error.file.clone(), line: None, problem: TableProblem::Model(error) }
    }
}

/// What is wrong with the file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum TableProblem {
    #[error("cannot be read: {reason}; check the path")]
    Unreadable { reason: String },
    #[error(
        "grid point {node} moves in coordinate system {system}, and rows of a table are in x, y and z; give the matrices as DMIG, whose rows are turned, or with displacements of that grid point (CD) in the basic system"
    )]
    TurnedNode { node: String, system: i64 },
    #[error("is not UTF-8 text; export it again as text")]
    NotText,
    #[error("the first line must be `%%MatrixMarket matrix coordinate real symmetric` or alike, not \"{found}\"")]
    NoBanner { found: String },
    #[error("\"{found}\" matrices are not read; use {allowed}")]
    NotRead { found: String, allowed: &'static str },
    #[error("the line of sizes must hold {expected}, not \"{found}\"")]
    BadSize { expected: &'static str, found: String },
    #[error("the matrix is {rows} x {columns}; it must be square")]
    NotSquare { rows: usize, columns: usize },
    #[error("the matrix has {rows} rows; at most {most} can be handled")]
    TooLarge { rows: usize, most: usize },
    #[error("an entry must be `{expected}`, not \"{found}\"")]
    BadEntry { expected: &'static str, found: String },
    #[error("entry ({row}, {column}) lies outside the {size} x {size} matrix; indices count from 1")]
    Outside { row: usize, column: usize, size: usize },
    #[error("entry ({row}, {column}) lies above the diagonal of a symmetric matrix; give the lower triangle only")]
    AboveDiagonal { row: usize, column: usize },
    #[error("entries ({row}, {column}) and ({column}, {row}) differ; mass and stiffness must be symmetric")]
    NotSymmetric { row: usize, column: usize },
    #[error("entry ({row}, {column}) is given twice; leave one out")]
    EntryTwice { row: usize, column: usize },
    #[error("\"{text}\" is not a finite number")]
    NotANumber { text: String },
    #[error("there are {found} entries but the sizes promise {expected}; export the file again")]
    Count { found: usize, expected: usize },
    #[error("the row has {found} values but {expected} are needed")]
    RowLength { found: usize, expected: usize },
    #[error("the file is empty")]
    Empty,
    #[error("the header must be `{expected}`, not \"{found}\"")]
    Header { expected: &'static str, found: String },
    #[error("\"{text}\" is not a direction; use x, y, z, rx, ry or rz, or q for a generalised coordinate")]
    Direction { text: String },
    #[error("{what} \"{label}\" is given twice, first in line {first}; leave one out")]
    Twice { what: &'static str, label: String, first: usize },
    #[error("node \"{label}\" is joined to itself; name two nodes")]
    JoinedToItself { label: String },
    #[error("a label is empty; name every node and DOF")]
    NoLabel,
    #[error("it is not clear which matrix is meant of: {names}; name it as `{key}` of [structure]")]
    WhichMatrix { key: &'static str, names: String },
    #[error("the stiffness has {stiffness} rows but the mass {mass}; take both from one run")]
    OtherSize { mass: usize, stiffness: usize },
    /// Names its own place.
    #[error("{0}")]
    Model(dashpot_fe_files::FileError),
}

/// The text of the file at `path`, without a byte order mark.
pub(super) fn read(path: &Path) -> Result<(String, String), TableError> {
    let file = path.display().to_string();
    let bytes = std::fs::read(path)
        .map_err(|error| TableError::file(&file, TableProblem::Unreadable { reason: error.to_string() }))?;
    let text = String::from_utf8(bytes).map_err(|_| TableError::file(&file, TableProblem::NotText))?;
    Ok((text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text), file))
}

/// The text of a deck; comments in Latin-1 are no fault.
pub(super) fn read_deck_text(path: &Path) -> Result<(String, String), TableError> {
    let file = path.display().to_string();
    let bytes = std::fs::read(path)
        .map_err(|error| TableError::file(&file, TableProblem::Unreadable { reason: error.to_string() }))?;
    let text = String::from_utf8(bytes)
        .unwrap_or_else(|error| error.as_bytes().iter().map(|&byte| char::from(byte)).collect());
    Ok((text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text), file))
}

/// A piece of a file for a message: one line, not too long.
pub(super) fn quote(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).take(60).collect::<String>().trim().to_owned()
}

/// A finite number, also with the `D` exponent of Fortran.
pub(super) fn number(text: &str) -> Result<f64, TableProblem> {
    let plain = text.trim().replace(['D', 'd'], "e");
    match plain.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(TableProblem::NotANumber { text: quote(text) }),
    }
}
