//! Leaving a project with unsaved changes: where to, and what becomes of them.

use std::path::PathBuf;

/// Where the user wants to go.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Leave {
    /// Out of the program.
    Quit,
    /// Back to the start screen.
    Close,
    /// To another project.
    Open(PathBuf),
    /// To a new project, by the number of its template.
    New(usize),
}

/// What the user wants to become of the changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Changes {
    /// Save them, then go.
    Save,
    /// Forget them and go.
    Discard,
    /// Stay.
    Keep,
}
