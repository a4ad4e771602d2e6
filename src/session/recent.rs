//! The files opened last, newest first, in a file of the user's configuration folder.

use super::save::{SaveError, write};
use std::path::{Path, PathBuf};

/// Most files that are remembered.
pub const MOST_RECENT: usize = 12;

/// The list and where it is kept.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recent {
    store: PathBuf,
    files: Vec<PathBuf>,
}

impl Recent {
    /// Reads the list from `store`; one that is absent or damaged is empty, since it is only a convenience.
    pub fn load(store: &Path) -> Self {
        let text = std::fs::read_to_string(store).unwrap_or_default();
        let files = serde_json::from_str(&text).unwrap_or_default();
        Self { store: store.to_owned(), files }
    }

    /// Files, newest first.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Puts `file` first and saves the list.
    ///
    /// # Errors
    /// [`SaveError`] if the list cannot be written; it holds in memory all the same.
    pub fn add(&mut self, file: &Path) -> Result<(), SaveError> {
        self.files.retain(|other| other != file);
        self.files.insert(0, file.to_owned());
        self.files.truncate(MOST_RECENT);
        self.save()
    }

    fn save(&self) -> Result<(), SaveError> {
        let disk = |reason: String| SaveError::Disk {
            action: "keep the list of recent files",
            reason,
            path: self.store.clone(),
        };
        if let Some(folder) = self.store.parent() {
            std::fs::create_dir_all(folder).map_err(|error| disk(error.to_string()))?;
        }
        let text = serde_json::to_string_pretty(&self.files).map_err(|error| disk(error.to_string()))?;
        write(&self.store, &text, "keep the list of recent files")
    }
}
