//! The house rules that a compiler does not hold: dependence runs downwards only, the engine knows no files, clock,
//! printing or threads, and every room is small and says what it is for.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::path::{Path, PathBuf};

#[path = "floors/closures.rs"]
mod closures;
#[path = "floors/functions.rs"]
mod functions;
#[path = "floors/rings.rs"]
mod rings;

/// Floor of each folder or file of `src`. Neighbours on one floor see each other only where it is said below.
const FLOORS: [(&str, u32); 17] = [
    ("control", 0),
    ("math", 0),
    ("structure", 1),
    ("effects", 1),
    ("measurement", 1),
    ("response", 2),
    ("balance", 2),
    ("identify", 3),
    ("classical", 3),
    ("diagnosis", 3),
    ("exchange", 4),
    ("session", 4),
    ("display", 4),
    ("plots", 5),
    ("report", 6),
    ("cli", 7),
    ("window", 7),
];

/// Who may see a neighbour on the same floor.
const NEIGHBOURS: [(&str, &str); 4] =
    [("math", "control"), ("effects", "structure"), ("balance", "response"), ("session", "exchange")];

/// Names that the engine must not say below the floor given, and why.
const FORBIDDEN: [(&str, u32, &str); 14] = [
    ("std::fs", 4, "files are read and written in exchange"),
    ("std::path", 4, "paths belong to exchange"),
    ("std::env", 7, "the environment belongs to the command line"),
    ("std::time", 4, "results do not depend on the clock; only a session waits"),
    ("SystemTime", 7, "results do not depend on the clock"),
    ("std::thread", 4, "threads belong to session"),
    ("static mut", 8, "there is no global state"),
    ("thread_local!", 7, "there is no global state"),
    ("println!", 7, "printing belongs to the command line"),
    ("eprint", 7, "printing belongs to the command line"),
    ("egui", 7, "graphics belong to window"),
    ("eframe", 7, "graphics belong to window"),
    ("wgpu", 7, "graphics belong to window"),
    ("anyhow", 7, "the engine's errors are enums"),
];

/// Most lines of a source file.
const MOST_LINES: usize = 400;

struct Source {
    path: PathBuf,
    /// Folder directly below `src`, or the file's own name there.
    room: String,
    /// Text without comments and without the tests at its end.
    code: String,
    text: String,
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut sources = Vec::new();
    for path in rust_files(&root) {
        let text = fs::read_to_string(&path).unwrap();
        let path = path.strip_prefix(&root).unwrap().to_owned();
        let room = path.iter().next().unwrap().to_string_lossy().trim_end_matches(".rs").to_owned();
        sources.push(Source { room, code: code(&text), text, path });
    }
    assert!(sources.len() > 50, "the sources were not found");
    sources
}

/// All files of Rust below a folder.
fn rust_files(root: &Path) -> Vec<PathBuf> {
    let (mut folders, mut files) = (vec![root.to_owned()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    files
}

/// The text without comments, strings' contents left as they are, and without a test module at the end.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
    text.lines().map(|line| line.split("//").next().unwrap()).collect::<Vec<_>>().join("\n")
}

fn floor(room: &str) -> Option<u32> {
    FLOORS.iter().find(|(name, _)| *name == room).map(|&(_, floor)| floor)
}

/// Rooms that a text names as `crate::room` or within `crate::{...}`.
fn named(code: &str) -> Vec<String> {
    let mut rooms = Vec::new();
    for rest in code.split("crate::").skip(1) {
        let list = match rest.strip_prefix('{') {
            Some(group) => top_level(group),
            None => vec![rest],
        };
        let word = |item: &str| item.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        rooms.extend(list.into_iter().map(word));
    }
    rooms
}

/// Items of a braced list, those of inner braces left out.
fn top_level(group: &str) -> Vec<&str> {
    let (mut depth, mut start, mut items) = (0, 0, Vec::new());
    for (at, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth > 0 => depth -= 1,
            ',' | '}' if depth == 0 => {
                items.push(&group[start..at]);
                start = at + 1;
                if c == '}' {
                    break;
                }
            }
            _ => {}
        }
    }
    items
}

/// Whether `room` may use `other`.
fn allowed(room: &str, other: &str) -> bool {
    let (Some(mine), Some(its)) = (floor(room), floor(other)) else { return false };
    room == other || its < mine || NEIGHBOURS.contains(&(room, other))
}

#[test]
fn dependence_runs_downwards() {
    let mut wrong = Vec::new();
    for source in sources() {
        if ["lib", "main"].contains(&source.room.as_str()) {
            continue;
        }
        assert!(floor(&source.room).is_some(), "src/{} stands on no floor: add it to FLOORS", source.room);
        for other in named(&source.code) {
            if floor(&other).is_some() && !allowed(&source.room, &other) {
                wrong.push(format!("{} uses {other}", source.path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "forbidden directions:\n{}", wrong.join("\n"));
}

#[test]
fn the_engine_stays_pure() {
    let mut wrong = Vec::new();
    for source in sources() {
        let Some(mine) = floor(&source.room) else { continue };
        for (name, least, why) in FORBIDDEN {
            // The units of display are a choice of the user for all that is shown; the engine does not know them.
            let units = *name == *"thread_local!" && source.path.ends_with("display/units.rs");
            if mine < least && source.code.contains(name) && !units {
                wrong.push(format!("{} says {name}: {why}", source.path.display()));
            }
        }
        let graphics = ["egui", "eframe", "wgpu"].iter().any(|name| source.code.contains(name));
        if graphics && source.room != "window" {
            wrong.push(format!("{} draws outside of window", source.path.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn rooms_are_small_and_say_what_they_are_for() {
    let mut wrong = Vec::new();
    for source in sources() {
        let lines = source.text.lines().count();
        if lines > MOST_LINES {
            wrong.push(format!("{} has {lines} lines; at most {MOST_LINES}", source.path.display()));
        }
        if !source.text.starts_with("//! ") {
            wrong.push(format!("{} does not begin with its purpose (//! ...)", source.path.display()));
        }
        for word in ["todo!(", "unimplemented!(", "Under construction", "//! Placeholder"] {
            if source.text.contains(word) {
                wrong.push(format!("{} is not finished ({word})", source.path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The scan itself: what it must find, and what it must let pass.
#[test]
fn the_scan_sees_what_it_should() {
    let text = "//! Says crate::window.\nuse crate::effects::{Law, source::Source};\nuse crate::{balance::{a, b}, cli};\n\
        let x = crate::identify::Settings; // crate::session\n#[cfg(test)]\nmod tests {\nuse crate::exchange;\n}\n";
    assert_eq!(named(&code(text)), ["effects", "balance", "cli", "identify"]);
    assert!(allowed("identify", "balance") && allowed("effects", "structure") && allowed("cli", "cli"));
    assert!(!allowed("balance", "identify") && !allowed("structure", "effects") && !allowed("cli", "window"));
    assert!(!code("a(); // println!(\"x\")").contains("println!"));
}
