//! The files of an export, not yet written.

use std::path::{Path, PathBuf};

/// One file of an export, not yet written.
pub(super) struct File {
    pub path: PathBuf,
    pub bytes: Vec<u8>,
}

/// Files and what could not be said in the format.
#[derive(Default)]
pub(super) struct Export {
    pub files: Vec<File>,
    pub warnings: Vec<String>,
}

impl Export {
    pub(super) fn add(&mut self, path: PathBuf, bytes: impl Into<Vec<u8>>) {
        self.files.push(File { path, bytes: bytes.into() });
    }
}

/// `damping.csv` and `sources` give `damping-sources.csv`.
pub(super) fn beside(path: &Path, suffix: &str) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let mut name = format!("{stem}-{suffix}");
    if let Some(extension) = path.extension() {
        name = format!("{name}.{}", extension.to_string_lossy());
    }
    path.with_file_name(name)
}
