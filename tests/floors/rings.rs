//! Rings of imports: files that need one another in a circle cannot be read one after the other. A file needs the file in
//! which a name that it uses is defined; a name that is only handed on (`pub use`) ties nothing.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Crates whose files are scanned: their folders of sources.
const CRATES: [&str; 5] =
    ["src", "crates/numerics/src", "crates/uff/src", "crates/datafiles/src", "crates/fe-files/src"];

/// A module of a crate as its path: `["effects", "laws", "coulomb"]`; the root is empty.
type Module = Vec<String>;

/// One file and what it says of names.
struct File {
    path: PathBuf,
    module: Module,
    /// Names that the file defines.
    defined: BTreeSet<String>,
    /// Names that it hands on, by the path they come from.
    handed_on: BTreeMap<String, Vec<String>>,
    /// Names that it imports, by the path they come from.
    imported: BTreeMap<String, Vec<String>>,
    /// Paths of two names or more in its code.
    paths: Vec<Vec<String>>,
    /// Single names in its code.
    words: BTreeSet<String>,
}

/// The files of one crate by their module.
type Crate = BTreeMap<Module, File>;

fn read(root: &Path) -> Crate {
    let (mut folders, mut files) = (vec![root.to_owned()], Crate::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let module = module(path.strip_prefix(root).unwrap());
                if !module.iter().any(|name| name == "tests") {
                    let text = fs::read_to_string(&path).unwrap();
                    files.insert(module.clone(), File::new(path, module, &super::code(&text)));
                }
            }
        }
    }
    files
}

/// `effects/laws/mod.rs` is the module `effects::laws`; `lib.rs` and `main.rs` are roots.
fn module(path: &Path) -> Module {
    let mut names: Module = path.with_extension("").iter().map(|name| name.to_string_lossy().into_owned()).collect();
    if names.last().is_some_and(|name| ["mod", "lib"].contains(&name.as_str())) {
        names.pop();
    }
    names
}

impl File {
    fn new(path: PathBuf, module: Module, code: &str) -> Self {
        let tokens = tokens(code);
        let mut file = Self {
            path,
            module,
            defined: BTreeSet::new(),
            handed_on: BTreeMap::new(),
            imported: BTreeMap::new(),
            paths: Vec::new(),
            words: BTreeSet::new(),
        };
        let mut place = 0;
        while place < tokens.len() {
            place = file.take(&tokens, place);
        }
        file
    }

    /// Reads what stands at `place`; the place behind it.
    fn take(&mut self, tokens: &[&str], place: usize) -> usize {
        const DEFINING: [&str; 9] = ["struct", "enum", "trait", "fn", "type", "const", "static", "union", "mod"];
        let word = tokens[place];
        if word == "use" {
            let end = place + tokens[place..].iter().position(|&token| token == ";").unwrap_or(1);
            let public = place > 0 && (tokens[place - 1] == "pub" || tokens[place - 1] == ")");
            let names = if public { &mut self.handed_on } else { &mut self.imported };
            let mut rest = &tokens[place + 1..end];
            leaves(&mut rest, &mut Vec::new(), names);
            return end + 1;
        }
        if DEFINING.contains(&word) && tokens.get(place + 1).is_some_and(|next| is_word(next)) {
            self.defined.insert(tokens[place + 1].to_owned());
            return place + 2;
        }
        let mut end = place + 1;
        if is_word(word) {
            while tokens.get(end) == Some(&"::") && tokens.get(end + 1).is_some_and(|next| is_word(next)) {
                end += 2;
            }
            if end > place + 1 {
                self.paths.push(tokens[place..end].iter().step_by(2).map(|&name| name.to_owned()).collect());
            } else {
                self.words.insert(word.to_owned());
            }
        }
        end
    }
}

fn is_word(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Words, `::` and single signs; strings and blanks are left out.
fn tokens(code: &str) -> Vec<&str> {
    let (mut tokens, mut rest) = (Vec::new(), code);
    while let Some(first) = rest.chars().next() {
        let length = if first.is_alphanumeric() || first == '_' {
            rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len())
        } else if rest.starts_with("::") {
            2
        } else {
            first.len_utf8()
        };
        if first == '"' {
            rest = &rest[string(rest)..];
            continue;
        }
        if !first.is_whitespace() {
            tokens.push(&rest[..length]);
        }
        rest = &rest[length..];
    }
    tokens
}

/// Length of the string that the text begins with.
fn string(text: &str) -> usize {
    let mut escaped = false;
    for (place, c) in text.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return place + 1,
            _ => {}
        }
    }
    text.len()
}

/// Names at the ends of a tree of imports, each with its whole path.
fn leaves(rest: &mut &[&str], before: &mut Vec<String>, names: &mut BTreeMap<String, Vec<String>>) {
    let start = before.len();
    while let [first, after @ ..] = *rest {
        *rest = after;
        match *first {
            "{" => leaves(rest, before, names),
            "}" | "," => {
                leaf(start, before, names, None);
                if *first == "}" {
                    return;
                }
            }
            "as" => {
                let name = rest[0];
                *rest = &rest[1..];
                leaf(start, before, names, Some(name));
            }
            "::" => {}
            name => before.push(name.to_owned()),
        }
    }
    leaf(start, before, names, None);
}

fn leaf(start: usize, before: &mut Vec<String>, names: &mut BTreeMap<String, Vec<String>>, called: Option<&str>) {
    if before.len() == start {
        return;
    }
    let mut path = before.clone();
    if path.len() > 1 && path.last().is_some_and(|name| name == "self") {
        path.pop();
    }
    let name = called.map_or_else(|| path[path.len() - 1].clone(), str::to_owned);
    names.insert(name, path);
    before.truncate(start);
}

/// The file that defines what `path`, said in `from`, means; `None` outside the crate and for methods of types.
fn defining<'c>(files: &'c Crate, from: &File, path: &[String], depth: usize) -> Option<&'c File> {
    let first = path.first()?.as_str();
    let (mut module, mut rest) = match first {
        "crate" => (Module::new(), &path[1..]),
        "self" => (from.module.clone(), &path[1..]),
        "super" => (from.module.split_last()?.1.to_vec(), &path[1..]),
        _ if depth > 8 => return None,
        _ => {
            let mut child = from.module.clone();
            child.push(first.to_owned());
            if files.contains_key(&child) {
                (child, &path[1..])
            } else {
                let start = from.imported.get(first).or_else(|| from.handed_on.get(first))?;
                if start.first().is_some_and(|name| name == first) {
                    return None;
                }
                let whole: Vec<String> = start.iter().chain(&path[1..]).cloned().collect();
                return defining(files, from, &whole, depth + 1);
            }
        }
    };
    while let Some(name) = rest.first() {
        if name == "super" {
            module.pop();
        } else {
            module.push(name.clone());
            if !files.contains_key(&module) {
                module.pop();
                break;
            }
        }
        rest = &rest[1..];
    }
    let file = files.get(&module)?;
    match rest.first() {
        // A module alone ties nothing: what is said of it does.
        None => None,
        Some(name) if !file.defined.contains(name) && file.handed_on.contains_key(name) => {
            let whole: Vec<String> = file.handed_on[name].iter().chain(&rest[1..]).cloned().collect();
            defining(files, file, &whole, depth + 1)
        }
        Some(_) => Some(file),
    }
}

/// The modules that a file needs, each with the names that it takes from it.
fn needs(files: &Crate, file: &File) -> BTreeMap<Module, BTreeSet<String>> {
    let used = file.handed_on.iter().filter(|(name, _)| file.words.contains(*name));
    let whole = file.imported.iter().chain(used).map(|(_, path)| path).chain(&file.paths);
    let mut needs: BTreeMap<Module, BTreeSet<String>> = BTreeMap::new();
    for path in whole {
        if let Some(other) = defining(files, file, path, 0)
            && other.module != file.module
        {
            needs.entry(other.module.clone()).or_default().insert(path[path.len() - 1].clone());
        }
    }
    needs
}

/// Modules that `start` reaches.
fn reached(arrows: &BTreeMap<Module, BTreeMap<Module, BTreeSet<String>>>, start: &Module) -> BTreeSet<Module> {
    let (mut reached, mut open) = (BTreeSet::new(), vec![start]);
    while let Some(module) = open.pop() {
        for next in arrows[module].keys() {
            if reached.insert(next.clone()) {
                open.push(next);
            }
        }
    }
    reached
}

/// Each ring as its files with what ties them.
fn rings(files: &Crate) -> Vec<BTreeMap<Module, Vec<String>>> {
    let arrows: BTreeMap<_, _> = files.iter().map(|(module, file)| (module.clone(), needs(files, file))).collect();
    let reaches: BTreeMap<_, _> = files.keys().map(|module| (module.clone(), reached(&arrows, module))).collect();
    let mut seen = BTreeSet::new();
    let mut rings = Vec::new();
    for module in files.keys() {
        if !reaches[module].contains(module) || seen.contains(module) {
            continue;
        }
        let ring: BTreeSet<_> =
            reaches[module].iter().filter(|&other| reaches[other].contains(module)).cloned().collect();
        let ties = |file: &Module| {
            let inside = arrows[file].iter().filter(|(other, _)| ring.contains(*other));
            inside.map(|(other, names)| format!("{} ({})", other.join("::"), list(names))).collect()
        };
        rings.push(ring.iter().map(|file| (file.clone(), ties(file))).collect());
        seen.extend(ring);
    }
    rings
}

fn list(names: &BTreeSet<String>) -> String {
    names.iter().map(String::as_str).collect::<Vec<_>>().join(", ")
}

#[test]
fn no_files_need_one_another_in_a_ring() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut wrong = String::new();
    for folder in CRATES {
        let files = read(&root.join(folder));
        for ring in rings(&files) {
            for (module, ties) in &ring {
                let path = files[module].path.strip_prefix(root).unwrap();
                wrong += &format!("{} needs {}\n", path.display(), ties.join(", "));
            }
            wrong += "\n";
        }
    }
    assert!(wrong.is_empty(), "files that need one another in a ring:\n{wrong}");
}
