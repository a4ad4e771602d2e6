//! A line of a header.

/// The cells of a line above numbers.
#[derive(Debug, Clone)]
pub(crate) struct HeaderLine {
    pub cells: Vec<String>,
}

/// A cell without a comment sign in front.
pub(super) fn uncommented(cell: &str) -> &str {
    cell.trim_start_matches(['#', '%', '!', '/', '*']).trim()
}
