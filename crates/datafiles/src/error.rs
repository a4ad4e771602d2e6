//! What can be wrong with a data file, in one line.

/// A data file that cannot be used: file, place in it, what is wrong and how to mend it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Error {
    /// File as it was given.
    pub file: String,
    /// Line, byte, set or channel, where one is at fault.
    pub place: Option<String>,
    /// What is wrong and how to mend it.
    pub problem: String,
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.file)?;
        if let Some(place) = &self.place {
            write!(f, ", {place}")?;
        }
        write!(f, ": {}", self.problem)
    }
}

impl std::error::Error for Error {}

/// An error of a reader, which does not know the file's name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Fault {
    pub place: Option<String>,
    pub problem: String,
}

impl Fault {
    /// The file as a whole is at fault.
    pub(crate) fn new(problem: impl Into<String>) -> Self {
        Self { place: None, problem: problem.into() }
    }

    /// A line, from 1, is at fault.
    pub(crate) fn line(line: u64, problem: impl Into<String>) -> Self {
        Self { place: Some(format!("line {line}")), problem: problem.into() }
    }

    /// A byte, from 0, is at fault.
    pub(crate) fn byte(byte: u64, problem: impl Into<String>) -> Self {
        Self { place: Some(format!("byte {byte}")), problem: problem.into() }
    }

    /// The same fault in a part of the file, such as `sheet "Run 1"`.
    pub(crate) fn within(self, part: impl std::fmt::Display) -> Self {
        let place = match self.place {
            Some(place) => format!("{part}, {place}"),
            None => part.to_string(),
        };
        Self { place: Some(place), problem: self.problem }
    }

    /// The error of a file.
    pub(crate) fn of(self, file: &str) -> Error {
        let problem = one_line(&self.problem, 400);
        Error { file: file.to_owned(), place: self.place.map(|place| one_line(&place, 200)), problem }
    }
}

impl From<std::io::Error> for Fault {
    fn from(error: std::io::Error) -> Self {
        if error.kind() == std::io::ErrorKind::UnexpectedEof {
            return Self::new("ends before its data do; it was cut short: copy or export it again");
        }
        if error.kind() == std::io::ErrorKind::InvalidData {
            return Self::new("its compressed data are damaged; save the file again");
        }
        Self::new(format!("cannot be read: {error}; check the path and the permissions"))
    }
}

/// What readers return.
pub(crate) type Read<T> = Result<T, Fault>;

/// A text on one line of at most `most` characters.
pub(crate) fn one_line(text: &str, most: usize) -> String {
    let plain: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let plain = plain.split_whitespace().collect::<Vec<_>>().join(" ");
    match plain.char_indices().nth(most) {
        Some((end, _)) => format!("{}…", &plain[..end]),
        None => plain,
    }
}
