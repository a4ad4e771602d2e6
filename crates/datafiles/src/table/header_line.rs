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

/// A label without what stands behind it: `Unit:` is `unit`.
pub(super) fn label(cell: &str) -> String {
    uncommented(cell).trim_end_matches([':', '=']).trim().to_lowercase()
}

/// Words in front of what the channels are for, below their names.
pub(super) const COMMENT_WORDS: [&str; 6] =
    ["comment", "comments", "kommentar", "description", "beschreibung", "remark"];
