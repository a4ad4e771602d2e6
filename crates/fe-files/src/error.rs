//! What can be wrong with a file.

use std::fmt;

/// Where in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Nowhere in particular.
    File,
    /// A line, from 1.
    Line(usize),
    /// A byte, from 0.
    Byte(usize),
}

/// A file that cannot be used; its message is one line: file, place, what is wrong, how to mend it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileError {
    /// File as its reader was given it.
    pub file: String,
    /// Where.
    pub place: Place,
    /// What is wrong.
    pub problem: Problem,
}

impl FileError {
    pub(crate) fn new(file: &str, place: Place, problem: Problem) -> Self {
        Self { file: file.to_owned(), place, problem }
    }

    pub(crate) fn line(file: &str, line: usize, problem: Problem) -> Self {
        Self::new(file, Place::Line(line), problem)
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Names of matrices are bytes of the file: one with a line end in it must not break the line.
        let problem: String = self.problem.to_string().chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        match self.place {
            Place::File => write!(f, "{}: {problem}", self.file),
            Place::Line(line) => write!(f, "{}:{line}: {problem}", self.file),
            Place::Byte(byte) => write!(f, "{}: byte {byte}: {problem}", self.file),
        }
    }
}

impl std::error::Error for FileError {}

/// What is wrong.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum Problem {
    #[error(
        "grid point {node} moves in coordinate system {system}, and its components {components} alone cannot be turned to x, y and z; export the matrix with all three of them, or with displacements of that grid point (CD) in the basic system"
    )]
    Turned { node: i64, system: i64, components: String },
    #[error("coordinate system {id} lies on grid point {grid}, which is not given; export its GRID too")]
    SystemGrid { id: i64, grid: i64 },
    #[error("\"{text}\" is not a finite number; export the file again")]
    Number { text: String },
    #[error("\"{text}\" is not a whole number where {what} must stand; export the file again")]
    Whole { what: &'static str, text: String },
    #[error("{what} is missing; export the file again")]
    Missing { what: &'static str },
    #[error("the file ends in the middle of {what}; copy or export it again")]
    EndsEarly { what: &'static str },
    #[error(
        "no ENDDATA follows BEGIN BULK, so the file may have been cut short; copy or export it again, or, where it is whole, add a last line ENDDATA"
    )]
    NoEnd,
    #[error("there is no matrix in the file; it must hold {expected}")]
    NoMatrix { expected: &'static str },
    #[error("matrix {name} is complex; export the real mass or stiffness matrix")]
    Complex { name: String },
    #[error("matrix {name} is {rows} x {columns}; mass and stiffness must be square")]
    NotSquare { name: String, rows: u64, columns: u64 },
    #[error("matrix {name} is said to have {rows} rows, more than the file could hold; export it again")]
    TooLarge { name: String, rows: u64 },
    #[error("matrix {name} has form {form}; use 1 (square) or 6 (symmetric)")]
    Form { name: String, form: i64 },
    #[error("matrix {name} has no header card before its columns; add `DMIG,{name},0,6,2,0`")]
    NoHeader { name: String },
    #[error("entry ({row}, {column}) of matrix {name} lies outside its {size} rows; export it again")]
    Outside { name: String, row: i64, column: i64, size: usize },
    #[error(
        "matrix {name} is not symmetric: row {row}, column {column} has {first:?} but its mirror {second:?}; leave out gyroscopic and follower terms"
    )]
    Asymmetric { name: String, row: String, column: String, first: Float, second: Float },
    #[error("\"{text}\" is not `{expected}`; export the file again")]
    Row { expected: &'static str, text: String },
    #[error("component {text} is not a degree of freedom; use 1 to 6, or 0 at scalar points")]
    Component { text: String },
    #[error("coordinate system {id} is not given by CORD2R, CORD2C or CORD2S; write the positions in the basic system")]
    System { id: i64 },
    #[error("coordinate system {id} is given by points that lie on one line; correct it")]
    FlatSystem { id: i64 },
    #[error("the record length {found} is neither 24 nor 48; this is not a binary OUTPUT4 file")]
    NotOutput4 { found: u32 },
    #[error("{found} degrees of freedom are listed but the matrix has {expected} rows; take both from one run")]
    DofCount { found: usize, expected: usize },
    #[error("node {id} is given twice at different places; leave one out")]
    NodeTwice { id: i64 },
}

/// A number in a message, compared by its bits.
#[derive(Clone, Copy)]
pub struct Float(pub f64);

impl PartialEq for Float {
    fn eq(&self, other: &Self) -> bool {
        self.0.to_bits() == other.0.to_bits()
    }
}

impl Eq for Float {}

impl fmt::Debug for Float {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:e}", self.0)
    }
}

/// A piece of a file for a message: one line, not too long.
pub(crate) fn quote(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).take(60).collect::<String>().trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_with_a_line_end_leaves_the_message_on_one_line() {
        let problem = Problem::TooLarge { name: "K\nA".to_owned(), rows: 11_522 };
        let text = FileError::new("a.op4", Place::Byte(0), problem).to_string();
        assert!(text.starts_with("a.op4: byte 0: matrix K A is said to have 11522 rows"), "{text}");
    }
}
