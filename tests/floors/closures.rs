//! Closures are called by what they compute: `of`, `at` and `one` say nothing where they are used.

use std::fs;
use std::path::Path;

/// Names that say nothing, and folders whose closures are called by none of them.
const EMPTY: [&str; 3] = ["of", "at", "one"];
const FOLDERS: [&str; 2] = ["src", "crates"];

/// Line and name of every closure of a text with such a name, parameters included.
fn unnamed(text: &str) -> Vec<(usize, &'static str)> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    let mut found = Vec::new();
    for name in EMPTY {
        for (start, _) in text.match_indices(name) {
            if !text[..start].ends_with(is_word) && holds_closure(&text[start + name.len()..]) {
                found.push((text[..start].lines().count(), name));
            }
        }
    }
    found
}

/// Whether what stands behind a name makes it a closure: its type, or the value that it is given.
fn holds_closure(rest: &str) -> bool {
    if let Some(kind) = rest.strip_prefix(": ") {
        let kind = kind.trim_start_matches(['&', '(']).split('(').next().unwrap();
        return !kind.contains([',', ';', '=', ')', '}'])
            && ["Fn", "FnMut", "FnOnce"].iter().any(|f| kind.ends_with(f));
    }
    let Some(mut value) = rest.strip_prefix(" =").map(str::trim_start) else { return false };
    while let Some(inner) = ["&", "mut ", "move ", "Box::new("].iter().find_map(|word| value.strip_prefix(word)) {
        value = inner;
    }
    value.starts_with('|')
}

#[test]
fn closures_say_what_they_compute() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut wrong = Vec::new();
    for path in FOLDERS.iter().flat_map(|folder| super::rust_files(&root.join(folder))) {
        let told = path.strip_prefix(root).unwrap().display().to_string();
        for (line, name) in unnamed(&fs::read_to_string(&path).unwrap()) {
            wrong.push(format!(
                "{told}:{line}: call the closure `{name}` by what it computes, or write it where it is used"
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn closures_are_seen_in_every_form() {
    for text in
        ["let of = |x| x;", "let mut at =\n    move || 1;", "let one = Box::new(|x| x);", "let of = &mut |x| x;"]
    {
        assert_eq!(unnamed(text).len(), 1, "{text}");
    }
    assert_eq!(
        unnamed("\nfn f(n: usize, at: impl Fn(usize) -> f64) {}\nlet g = |of: &dyn Fn()| of();"),
        [(3, "of"), (2, "at")]
    );
    assert_eq!(unnamed("let one: Box<dyn FnMut(f64)> = made();"), [(1, "one")]);
    for text in
        ["let of_run = |x| x;", "let at = list.map(|x| x);", "self.at = |x| x;", "fn f(at: f64, g: impl Fn()) {}"]
    {
        assert!(unnamed(text).is_empty(), "{text}");
    }
}
