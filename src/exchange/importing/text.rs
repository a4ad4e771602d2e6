//! Pieces of text that projects out of files have in common.

use super::error::{ImportError, Result};
use crate::exchange::project::relocate::{canonical, renamed};
use std::path::Path;

/// `[structure]` of measured points.
pub(super) fn points(labels: &[String]) -> String {
    let quoted: Vec<String> = labels.iter().map(|label| toml::Value::from(label.as_str()).to_string()).collect();
    format!("[structure]\nkind = \"points\"\ndofs = [{}]\n", quoted.join(", "))
}

/// Lines of a comment.
pub(super) fn comment(text: &str) -> String {
    let mut out = String::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        if !line.is_empty() && line.chars().count() + word.chars().count() > 116 {
            out.push_str(&format!("# {line}\n"));
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    if !line.is_empty() {
        out.push_str(&format!("# {line}\n"));
    }
    out
}

/// Name of a file as the project at `out` refers to it.
///
/// # Errors
/// One line where the folder of the project or of the file is not there.
pub fn named(file: &Path, out: &Path) -> Result<String> {
    if file.is_absolute() && out.is_relative() {
        return Ok(file.display().to_string());
    }
    let folder = out.parent().unwrap_or(Path::new(""));
    let to = canonical(folder).map_err(|_| ImportError::of(folder, "the folder is not there"))?;
    let here = file.parent().unwrap_or(Path::new(""));
    let here = canonical(here).map_err(|_| ImportError::of(here, "the folder is not there"))?;
    let name = file.file_name().ok_or_else(|| ImportError::of(file, "names no file"))?.to_string_lossy();
    // A file in or below the folder of the project moves with it; one elsewhere stays where it is.
    if file.is_absolute() && !here.starts_with(&to) {
        return Ok(file.display().to_string());
    }
    Ok(renamed(&name, &here, &to))
}
