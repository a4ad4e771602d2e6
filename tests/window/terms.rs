//! Every term of the window is explained: names of values, heads of columns, titles of panes and stages.

use dashpot::display::glossary::{TERMS, meaning, page};
use dashpot::window::app::view::Stage;
use dashpot::window::frame::panes::Pane;
use std::path::Path;

/// Calls that put the name of something on the screen.
const NAMED: [&str; 7] = [
    "ui.pair(\"",
    "ui.quantity(\"",
    "ui.choice(\"",
    "head_right(ui, \"",
    "order.head(ui, \"",
    "drop(ui.hint(\"",
    "row.col(|ui| ui.hint(\"",
];
/// What says itself, or stands on a page with its own explanation (laws of damping, files of an import).
const PLAIN: [&str; 6] = ["Structure", "Points", "None.", "Test", "File name", "Ready"];

fn sources(folder: &Path, all: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, all);
        } else if path.extension().is_some_and(|e| e == "rs") {
            all.push(std::fs::read_to_string(&path).unwrap());
        }
    }
}

#[test]
fn every_name_of_a_value_and_every_head_has_a_meaning() {
    let mut all = Vec::new();
    for folder in ["src/window/stages", "src/window/frame", "src/window/importing"] {
        sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut all);
    }
    let mut names = Vec::new();
    for text in &all {
        for call in NAMED {
            let found = text.match_indices(call).filter_map(|(at, _)| text[at + call.len()..].split('"').next());
            names.extend(found.map(|name| name.trim().to_owned()));
        }
    }
    assert!(names.len() > 40, "the scan finds names: {}", names.len());
    // Sentences are no terms.
    names.retain(|n| n.len() > 1 && n.len() < 34 && !n.contains(". ") && !n.ends_with('.') && !n.contains('{'));
    names.retain(|n| n.chars().next().is_some_and(char::is_uppercase) && !PLAIN.contains(&n.as_str()));
    names.retain(|n| meaning(n).is_none());
    names.sort();
    names.dedup();
    assert!(names.is_empty(), "without a meaning: {names:?}");
}

#[test]
fn every_pane_and_every_stage_has_a_meaning() {
    for pane in Pane::ALL {
        assert!(meaning(pane.title()).is_some(), "{}", pane.title());
    }
    for stage in Stage::ALL {
        assert!(meaning(stage.label()).is_some(), "{}", stage.label());
    }
}

#[test]
fn every_term_stands_once_and_says_something() {
    let mut names: Vec<&str> = TERMS.iter().flat_map(|t| t.also.iter().copied().chain([t.name])).collect();
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count, "a name stands twice");
    for term in TERMS {
        assert!(term.meaning.ends_with('.') && term.meaning.len() > 20, "{}", term.name);
    }
    assert!(meaning(" Angle ").is_some_and(|m| m.contains("energies")));
    assert_eq!(meaning("no such term"), None);
}

/// `UPDATE_DOCS=1` writes the page anew.
#[test]
fn the_documentation_is_this_vocabulary() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/glossary.md");
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, page()).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
    assert!(written == page(), "docs/glossary.md is not what src/display/glossary says: UPDATE_DOCS=1 writes it anew");
    assert!(written.contains("| viscous dashpot | `"));
}
