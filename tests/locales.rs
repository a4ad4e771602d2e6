//! The catalogues of languages against the sources: what the window says is in them, and what is in them is said somewhere.
#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The table of sentences that are put together of several literals.
const COMPOSED: &str = "composed";

/// Calls of the window that show the literals behind them; words in brackets of `t!`, `tf!` and of the widgets of `window/appearance/widgets.rs`,
/// which translate what they are given.
const SHOWN: [&str; 13] = [
    "t!(",
    "tf!(",
    "ui.hint(",
    "ui.title(",
    "ui.empty(",
    "ui.pair(",
    "ui.quantity(",
    "ui.choice(",
    "ui.primary(",
    "ui.hint(format!(",
    "ui.pair(&format!(",
    "ui.title(&format!(",
    "StageStatus::empty(",
];

/// What is the same in every language, or no words.
const NAMES: [&str; 8] = ["Dashpot", "SVG…", "PNG…", "MATLAB…", "JSON…", "Matrix Market…", "MAC", "MIT or Apache-2.0."];

type Catalogue = BTreeMap<String, BTreeMap<String, String>>;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn catalogues() -> Vec<(String, Catalogue)> {
    let files = fs::read_dir(root().join("assets/locales")).unwrap();
    let read =
        |path: PathBuf| (path.display().to_string(), toml::from_str(&fs::read_to_string(&path).unwrap()).unwrap());
    files.map(|entry| read(entry.unwrap().path())).collect()
}

/// A literal of the sources: what stands before it, and its text with `{}` for every placeholder.
struct Literal {
    before: String,
    text: String,
}

/// The text of a literal as it is at run time, with `{}` for every placeholder of a format.
fn plain(raw: &str) -> String {
    let mut text = String::new();
    let mut letters = raw.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '\\' => match letters.next() {
                Some('n') => text.push('\n'),
                Some('t') => text.push('\t'),
                // A line that goes on: without the break and what indents the next one.
                Some('\n') => while letters.next_if(|c| c.is_whitespace()).is_some() {},
                Some('u') => {
                    let digits: String = letters.by_ref().skip(1).take_while(|c| *c != '}').collect();
                    text.extend(u32::from_str_radix(&digits, 16).ok().and_then(char::from_u32));
                }
                other => text.extend(other),
            },
            '{' if letters.next_if_eq(&'{').is_none() => {
                letters.by_ref().find(|c| *c == '}');
                text.push_str("{}");
            }
            other => text.push(other),
        }
    }
    text
}

/// The literals of a source without its comments and the tests at its end.
fn literals(source: &str) -> Vec<Literal> {
    let code = source.split("#[cfg(test)]\nmod tests {").next().unwrap();
    let bytes = code.as_bytes();
    let (mut found, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        let rest = &code[at..];
        if rest.starts_with("//") {
            at += rest.find('\n').unwrap_or(rest.len());
        } else if let Some(length) = character(rest) {
            at += length;
        } else if bytes[at] == b'"' {
            let mut end = at + 1;
            while bytes[end] != b'"' {
                end += if bytes[end] == b'\\' { 2 } else { 1 };
            }
            let start = code[..at].char_indices().rev().nth(60).map_or(0, |(k, _)| k);
            let before = code[start..at].split_whitespace().collect::<Vec<_>>().join(" ");
            found.push(Literal { before, text: plain(&code[at + 1..end]) });
            at = end + 1;
        } else {
            at += rest.chars().next().map_or(1, char::len_utf8);
        }
    }
    found
}

/// Bytes of a character in quotation marks at the start, so that no quotation mark within is taken for a literal.
fn character(rest: &str) -> Option<usize> {
    let inner = rest.strip_prefix('\'')?;
    let first = inner.chars().next()?;
    let length = if first == '\\' { 1 + inner[1..].chars().next()?.len_utf8() } else { first.len_utf8() };
    inner[length..].starts_with('\'').then_some(length + 2)
}

fn all_literals(folder: &Path) -> Vec<Literal> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(all_literals(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.extend(literals(&fs::read_to_string(&path).unwrap()));
        }
    }
    found
}

/// A key without its constraints and without what it is here, as a literal of the sources has it.
fn bare(key: &str) -> String {
    let word = |here: &str| here.chars().all(char::is_alphabetic);
    let plain = key.strip_suffix(']').and_then(|k| k.rsplit_once(" [")).filter(|(_, here)| word(here));
    plain.map_or(key, |(english, _)| english).replace("{#}", "{}")
}

fn words(text: &str) -> impl Iterator<Item = String> + '_ {
    text.split(|c: char| !c.is_alphabetic()).filter(|w| w.chars().count() > 2).map(str::to_lowercase)
}

#[test]
fn every_key_is_said_somewhere() {
    let said = all_literals(&root().join("src"));
    let whole: HashSet<&str> = said.iter().map(|l| l.text.trim()).collect();
    let vocabulary: HashSet<String> = said.iter().flat_map(|l| words(&l.text).collect::<Vec<_>>()).collect();
    // Plurals are made by adding a letter.
    let known = |w: &String| vocabulary.contains(w) || w.strip_suffix('s').is_some_and(|w| vocabulary.contains(w));
    let mut unused = Vec::new();
    for (file, tables) in catalogues() {
        for (table, pairs) in tables {
            let used = |key: &String| match table.as_str() {
                COMPOSED => words(key).all(|w| known(&w)),
                _ => whole.contains(bare(key).as_str()),
            };
            unused.extend(pairs.into_keys().filter(|key| !used(key)).map(|key| format!("{file}, [{table}]: {key}")));
        }
    }
    assert!(unused.is_empty(), "in no source: {unused:#?}");
}

#[test]
fn every_text_of_the_window_is_in_every_catalogue() {
    // `t!(`, not the end of `format!(`.
    let call = |before: &str, call: &str| {
        before.strip_suffix(call).is_some_and(|rest| !rest.ends_with(|c: char| c.is_alphanumeric() || c == '_'))
    };
    let shown = |l: &Literal| SHOWN.iter().any(|name| call(&l.before, name));
    let letters = |text: &str| words(&text.replace("{}", " ")).next().is_some();
    let texts: BTreeSet<String> = all_literals(&root().join("src/window"))
        .into_iter()
        .filter(|l| shown(l) && letters(&l.text) && !NAMES.contains(&l.text.as_str()))
        .map(|l| l.text.trim().to_owned())
        .collect();
    assert!(texts.len() > 300, "the scan finds texts: {}", texts.len());
    for (file, tables) in catalogues() {
        let keys: HashSet<String> = tables.values().flat_map(|pairs| pairs.keys().map(|k| bare(k))).collect();
        // What is put together of pieces stands in the catalogue as the whole sentence.
        let composed: Vec<&String> = tables[COMPOSED].keys().collect();
        let part = |text: &str| {
            let pieces: Vec<&str> = text.split("{}").map(str::trim).filter(|p| p.len() > 2).collect();
            composed.iter().any(|key| pieces.iter().all(|piece| key.contains(piece)))
        };
        let missing: Vec<&String> = texts.iter().filter(|t| !keys.contains(*t) && !part(t)).collect();
        assert!(missing.is_empty(), "{file} lacks {missing:#?}");
    }
}

/// The places of the values that a translation says, from 0.
fn places(text: &str) -> Vec<usize> {
    let names = text.split('{').skip(1).map(|rest| rest.split('}').next().unwrap());
    let mut found: Vec<usize> =
        names.enumerate().map(|(k, name)| name.parse::<usize>().map_or(k, |place| place - 1)).collect();
    found.sort_unstable();
    found
}

#[test]
fn every_translation_says_every_value_once() {
    for (file, tables) in catalogues() {
        let mut seen = HashSet::new();
        for (english, other) in tables.values().flatten() {
            assert!(seen.insert(english.clone()), "{file}: {english} stands twice");
            assert!(!other.trim().is_empty(), "{file}: {english} has no translation");
            assert_eq!(places(english), places(other), "{file}: {english} = {other}");
            assert!(!english.contains("}{"), "{file}: {english}: values that touch cannot be told apart");
        }
    }
}
