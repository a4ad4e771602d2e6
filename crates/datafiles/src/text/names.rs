//! Lists of the names of channels, one a line, as they lie beside tables without a header.

use super::decode;
use crate::units::is_unit;
use std::path::Path;

/// Largest file that may be a list, bytes.
const MOST: u64 = 1 << 16;
/// Longest name, characters: what is longer is prose.
const LONGEST: usize = 80;
/// First lines that say what the list is of.
const HEADERS: [&str; 12] = [
    "name",
    "names",
    "channel",
    "channels",
    "channel name",
    "channel names",
    "channel_name",
    "channel_names",
    "label",
    "labels",
    "signal",
    "kanal",
];

/// The names that the file at `path` lists, one a line; a unit behind a comma, a semicolon or a tab is put in brackets. None for a
/// file that holds numbers, or anything else.
pub fn listed_names(path: &Path) -> Option<Vec<String>> {
    // What is longer is left unread: measurements of gigabytes are asked as well.
    std::fs::metadata(path).ok().filter(|file| file.is_file() && file.len() <= MOST)?;
    let bytes = std::fs::read(path).ok()?;
    listed(&decode(&bytes).ok()?.0)
}

fn listed(text: &str) -> Option<Vec<String>> {
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let mut names = lines.map(name).collect::<Option<Vec<String>>>()?;
    if names.first().is_some_and(|first| HEADERS.contains(&first.to_lowercase().as_str())) {
        names.remove(0);
    }
    (names.len() > 1).then_some(names)
}

fn name(line: &str) -> Option<String> {
    let cells: Vec<&str> =
        line.split([',', ';', '\t']).map(|cell| cell.trim().trim_matches(['"', '\'']).trim()).collect();
    let is_word = |cell: &&str| cell.contains(char::is_alphabetic) && cell.parse::<f64>().is_err();
    let [first, rest @ ..] = &cells[..] else { return None };
    if !is_word(first) || line.chars().count() > LONGEST {
        return None;
    }
    match rest {
        [] | [""] => Some((*first).to_owned()),
        [unit] if HEADERS.contains(&first.to_lowercase().as_str()) && unit.to_lowercase().starts_with("unit") => {
            Some((*first).to_owned())
        }
        [unit] if is_unit(unit) => Some(format!("{first} [{unit}]")),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::disallowed_methods, reason = "tests")]
    use super::*;

    #[test]
    fn names_are_listed_one_a_line() {
        let names = |text: &str| listed(text).unwrap_or_default().join("|");
        assert_eq!(names("Force [N]\nAcc 1 [m/s^2]\n\nAcc 2\n"), "Force [N]|Acc 1 [m/s^2]|Acc 2");
        assert_eq!(names("name;unit\nForce;N\nAcc 1;g\n"), "Force [N]|Acc 1 [g]");
        assert_eq!(names("channel_name\n\"t\"\n\"Force\"\n"), "t|Force");
        assert_eq!(listed("Force,N\n1.0,2.0\n"), None);
        assert_eq!(listed("Point,Sensor\n3,Acc\n"), None);
        assert_eq!(listed("Force\n"), None);
    }

    /// A file that is nearly all a hole of a terabyte: reading it would take the memory of any machine.
    #[test]
    fn a_large_file_is_no_list_and_is_left_unread() -> std::io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("large.txt");
        std::fs::write(&path, "Force\nAcc 1\n")?;
        assert_eq!(listed_names(&path).map(|names| names.len()), Some(2));
        std::fs::File::options().write(true).open(&path)?.set_len(1 << 40)?;
        assert_eq!(listed_names(&path), None);
        Ok(())
    }
}
