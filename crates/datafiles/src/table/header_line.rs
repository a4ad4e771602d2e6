//! A line of a header.

/// The cells of a line above numbers.
#[derive(Debug, Clone)]
pub(crate) struct HeaderLine {
    pub cells: Vec<String>,
}
