//! `contents` and `import` of what laboratories have: every file ends in a project that opens, or in one clear line.
#![allow(clippy::unwrap_used, clippy::disallowed_methods, missing_docs, reason = "tests")]

#[path = "import/bad.rs"]
mod bad;
#[path = "import/benchmarks.rs"]
mod benchmarks;
#[path = "import/dialects.rs"]
mod dialects;
#[path = "import/faults.rs"]
mod faults;
#[path = "import/files.rs"]
mod files;
#[path = "import/laboratories.rs"]
mod laboratories;
#[path = "import/mapped.rs"]
mod mapped;
#[path = "import/onto_model.rs"]
mod onto_model;
#[path = "import/results.rs"]
mod results;
#[path = "import/said.rs"]
mod said;
#[path = "import/sets.rs"]
mod sets;

use serde_json::Value;
use std::path::Path;

/// What the program answers: its output, or the one line of its error.
fn dashpot(words: &[&str]) -> Result<String, String> {
    dashpot::cli::answer(["dashpot"].iter().chain(words).map(Into::into))
}

fn json(words: &[&str]) -> Value {
    serde_json::from_str(&dashpot(words).unwrap()).unwrap()
}

/// Writes a file into a folder and imports it: what was said, and the project.
fn imported(folder: &Path, name: &str, text: &str, more: &[&str]) -> (String, String) {
    let file = folder.join(name);
    std::fs::write(&file, text).unwrap();
    let out = folder.join("project.toml");
    let (file, out) = (file.display().to_string(), out.display().to_string());
    let said = dashpot(&[&["import", file.as_str(), "--out", out.as_str()], more].concat()).unwrap();
    (said, std::fs::read_to_string(out).unwrap())
}

#[path = "import/walk.rs"]
mod walk;
