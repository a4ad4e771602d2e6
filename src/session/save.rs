//! Saving, autosaving and recovery: at any moment the disk holds the old file or the new one, never neither.

use crate::exchange::atomic::write_atomically;
use crate::exchange::project::file::ProjectFile;
use crate::exchange::project::rewrite::rewritten;
use std::ffi::OsString;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// A file that could not be written, read or removed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SaveError {
    /// The project is not one that TOML can hold.
    #[error("the project cannot be written as TOML: {reason}")]
    NotWritable {
        /// What is wrong.
        reason: String,
    },
    /// The document has never been saved.
    #[error("the project has no file yet; save it under a name")]
    NoPath,
    /// Somebody else has written the file since it was opened or saved here.
    #[error(
        "{} was changed by another window or program since it was opened here; save under another name, or open it again and \
         make the changes there",
        path.display()
    )]
    ChangedElsewhere {
        /// File.
        path: PathBuf,
    },
    /// The disk refused.
    #[error("cannot {action}: {reason}; check the folder and its free space: {}", path.display())]
    Disk {
        /// What was tried.
        action: &'static str,
        /// What the system says.
        reason: String,
        /// File.
        path: PathBuf,
    },
}

/// Where the unsaved state of the project at `path` is kept, beside it.
pub fn autosave_path(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(".autosave");
    path.with_file_name(name)
}

/// The text of the project as it is saved in place of the file at `from`: with its comments, where it holds a project.
pub fn text_after(file: &ProjectFile, from: Option<&Path>) -> Result<String, SaveError> {
    let kept = from.and_then(|from| {
        let text = std::fs::read_to_string(from).ok()?;
        let (old, _) = ProjectFile::parse(&text, "").ok()?;
        rewritten(&text, &old, file)
    });
    kept.map_or_else(|| text(file), Ok)
}

/// The text of the project, written out in full.
fn text(file: &ProjectFile) -> Result<String, SaveError> {
    file.to_toml().map_err(|error| SaveError::NotWritable { reason: error.to_string() })
}

/// Saves the project in the text of the file at `from`, then forgets its autosave.
///
/// # Errors
/// [`SaveError`]; then the file is as it was.
pub fn save(file: &ProjectFile, path: &Path, from: Option<&Path>) -> Result<(), SaveError> {
    write(path, &text_after(file, from)?, "save the project")?;
    forget_autosave(path)
}

/// Keeps the unsaved state beside the project's file, which stays as it is.
pub fn autosave(file: &ProjectFile, path: &Path) -> Result<(), SaveError> {
    write(&autosave_path(path), &text(file)?, "keep the unsaved changes")
}

/// Writes and syncs; the folder is synced too, so that the new name outlives a power cut.
pub(super) fn write(path: &Path, text: &str, action: &'static str) -> Result<(), SaveError> {
    let disk = |error: std::io::Error| SaveError::Disk { action, reason: error.to_string(), path: path.into() };
    write_atomically(path, text.as_bytes()).map_err(disk)?;
    sync_folder(path);
    Ok(())
}

/// Not every file system lets a folder be synced; the file itself is synced already.
fn sync_folder(path: &Path) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let _ = std::fs::File::open(folder).and_then(|folder| folder.sync_all());
}

/// Removes the autosave of the project at `path`, if there is one.
pub fn forget_autosave(path: &Path) -> Result<(), SaveError> {
    let path = autosave_path(path);
    match std::fs::remove_file(&path) {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        Err(error) => Err(SaveError::Disk { action: "remove the autosave", reason: error.to_string(), path }),
    }
}

/// The project that the file at `path` holds; nothing where it is absent or holds none.
pub fn on_disk(path: &Path) -> Option<ProjectFile> {
    let text = std::fs::read_to_string(path).ok()?;
    Some(ProjectFile::parse(&text, &path.display().to_string()).ok()?.0)
}

/// The unsaved project that a crash left beside `path`; nothing where the autosave is absent, unreadable or the same as
/// the file.
pub fn recoverable(path: &Path) -> Option<ProjectFile> {
    let kept = on_disk(&autosave_path(path))?;
    (on_disk(path).as_ref() != Some(&kept)).then_some(kept)
}
