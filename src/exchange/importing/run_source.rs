//! What of the files becomes a run, and how that is said.

use super::looks::Looks;
use std::path::{Path, PathBuf};

/// What becomes a run: a file, and its set where it has several of that layout.
pub(super) struct RunSource {
    pub file: PathBuf,
    pub set: Option<String>,
    /// Its sets where every channel is one of its own.
    pub sets: Vec<String>,
    /// Name of the channel of a roving hammer and the label where it hit.
    pub force: Option<(String, String)>,
}

impl RunSource {
    pub(super) fn new(file: &Path, set: Option<String>, sets: Vec<String>) -> Self {
        Self { file: file.to_owned(), set, sets, force: None }
    }

    /// What tells it from other runs: its set, else its file.
    pub(super) fn own_name(&self) -> String {
        let stem = || self.file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        self.set.clone().unwrap_or_else(stem)
    }
}

/// Of what kind the runs are and why; runs that follow one another and are alike in one line.
pub(super) fn kinds(sources: &[RunSource], looks: &[Looks]) -> String {
    let name = |source: &RunSource| {
        let set = source.set.as_ref().or(source.sets.first());
        let set = set.map_or_else(String::new, |set| format!(", set \"{set}\""));
        format!("{}{set}", source.file.display())
    };
    let both: Vec<(&RunSource, &Looks)> = sources.iter().zip(looks).collect();
    let alike = both.chunk_by(|(_, a), (_, b)| (a.kind, &a.reason) == (b.kind, &b.reason));
    let line = |runs: &[(&RunSource, &Looks)]| {
        let ((first, looks), (last, _)) = (runs[0], runs[runs.len() - 1]);
        let names = match runs.len() {
            1 => name(first),
            n => format!("{} to {} ({n} runs)", name(first), name(last)),
        };
        format!("{names}: {}: {}\n", looks.kind.name(), looks.reason)
    };
    alike.map(line).collect()
}
