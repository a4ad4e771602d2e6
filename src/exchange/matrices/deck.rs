//! A NASTRAN deck with the files that it includes.

use super::error::{TableError, TableProblem, read_deck_text};
use dashpot_fe_files::nastran::{Bulk, includes, read_parts};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Most files of a deck.
const MOST_FILES: usize = 1000;

/// Reads the deck at `path` and what it includes; names are relative to the file that says them.
///
/// # Errors
/// [`TableError`] with file and line of what is wrong, or of the `INCLUDE` whose file is not there.
pub(super) fn read_deck(path: &Path) -> Result<Bulk, TableError> {
    let (text, file) = read_deck_text(path)?;
    let mut parts = vec![(text, file)];
    let mut seen: HashSet<PathBuf> = path.canonicalize().into_iter().collect();
    let mut folders = vec![path.parent().unwrap_or(Path::new("")).to_owned()];
    let mut at = 0;
    while at < parts.len() {
        for (line, name) in includes(&parts[at].0) {
            // Decks of other systems name their folders with backslashes.
            let included = folders[at].join(name.replace('\\', "/"));
            let wrong = |reason: String| {
                let problem =
                    TableProblem::Unreadable { reason: format!("its INCLUDE '{name}' cannot be read: {reason}") };
                TableError::line(&parts[at].1, line, problem)
            };
            let own = included.canonicalize().map_err(|error| wrong(error.to_string()))?;
            if !seen.insert(own) {
                continue;
            }
            if parts.len() >= MOST_FILES {
                return Err(wrong(format!("the deck has more than {MOST_FILES} files")));
            }
            let part = read_deck_text(&included)?;
            folders.push(included.parent().unwrap_or(Path::new("")).to_owned());
            parts.push(part);
        }
        at += 1;
    }
    let parts: Vec<(&str, &str)> = parts.iter().map(|(text, file)| (text.as_str(), file.as_str())).collect();
    Ok(read_parts(&parts)?)
}
