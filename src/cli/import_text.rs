//! The texts of a project that `dashpot import` writes, and its file.

use super::arguments_import::Import;
use crate::exchange::atomic::write_atomically;
use crate::exchange::project::relocate::{canonical, renamed};
use anyhow::{Context, ensure};
use std::path::{Path, PathBuf};

/// The project to write: `--out`, else the name of the first file in this folder, where nothing may be yet.
pub(super) fn project_file(arguments: &Import) -> anyhow::Result<PathBuf> {
    if let Some(out) = &arguments.out {
        return Ok(out.clone());
    }
    let stem = arguments.files[0].file_stem().unwrap_or_default();
    let out = Path::new(stem).with_extension("toml");
    ensure!(
        arguments.propose || !out.exists(),
        "{}: is there already; name the project to write by --out",
        out.display()
    );
    Ok(out)
}

/// Writes the project.
pub(super) fn write(out: &Path, text: &str) -> anyhow::Result<()> {
    write_atomically(out, text.as_bytes()).with_context(|| format!("{}: the project cannot be written", out.display()))
}

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
pub(super) fn named(file: &Path, out: &Path) -> anyhow::Result<String> {
    if file.is_absolute() {
        return Ok(file.display().to_string());
    }
    let folder = out.parent().unwrap_or(Path::new(""));
    let to = canonical(folder).with_context(|| format!("{}: the folder is not there", folder.display()))?;
    let here = canonical(file.parent().unwrap_or(Path::new("")))?;
    let name = file.file_name().with_context(|| format!("{}: names no file", file.display()))?.to_string_lossy();
    Ok(renamed(&name, &here, &to))
}
