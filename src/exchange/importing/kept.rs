//! What an import keeps of a project that is given as a template: all but its measurements.

use super::error::{ImportError, Result};
use crate::exchange::project::plan;
use crate::exchange::project::relocate::{canonical, renamed};
use crate::structure::Structure;
use std::path::{Path, PathBuf};
use toml_edit::{DocumentMut, Item, Table, value};

/// Tables of measurements and of the mapping of their channels, which an import writes anew.
const MEASURED: [&str; 6] = ["run", "channel", "frf", "harmonics", "modes", "simulate"];
/// Keys of `[structure]` that name files.
const FILES: [&str; 5] = ["mass", "stiffness", "nodes", "dofs", "lines"];
/// Where a project says nothing of what may damp it.
const CANDIDATES: &str = "[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-translation\"\n\n";

/// A project with a model of its structure: its text and the folder that its files are named from.
#[derive(Debug, Clone, PartialEq)]
pub struct Kept {
    text: String,
    folder: PathBuf,
}

impl Kept {
    /// The text of a template at `file`, if it has a structure that is more than measured points.
    pub fn of(text: &str, file: &Path) -> Option<Self> {
        let document: DocumentMut = text.parse().ok()?;
        let kind = document.get("structure")?.get("kind")?.as_str()?;
        let folder = file.parent().unwrap_or(Path::new("")).to_owned();
        (kind != "points").then(|| Self { text: text.to_owned(), folder })
    }

    /// Everything but the measurements, for a project at `out`.
    ///
    /// # Errors
    /// One line where the folder of the template or of the project is not there, or where the template is no project.
    pub(super) fn head(&self, out: &Path, title: &str) -> Result<String> {
        let mut document: DocumentMut =
            self.text.parse().map_err(|error| ImportError::Said(format!("the template is no TOML: {error}")))?;
        MEASURED.iter().for_each(|table| drop(document.remove(table)));
        self.rename_files(&mut document, out)?;
        let candidates =
            if ["source", "candidates"].iter().any(|table| document.contains_key(table)) { "" } else { CANDIDATES };
        let project = if document.contains_key("project") { String::new() } else { own_project(title) };
        let text = document.to_string();
        Ok(format!("{project}{}\n\n{candidates}", text.trim()))
    }

    /// The structure of the template.
    ///
    /// # Errors
    /// As [`Self::head`], and what is wrong with the structure.
    pub(super) fn structure(&self) -> Result<Structure> {
        let out = self.folder.join("import.toml");
        Ok(plan(&self.head(&out, "")?, &out).map_err(ImportError::Unwritten)?.structure)
    }

    fn rename_files(&self, document: &mut DocumentMut, out: &Path) -> Result<()> {
        let folder = |folder: &Path| canonical(folder).map_err(|_| ImportError::of(folder, "the folder is not there"));
        let (from, to) = (folder(&self.folder)?, folder(out.parent().unwrap_or(Path::new("")))?);
        let Some(structure) = document.get_mut("structure").and_then(Item::as_table_like_mut) else { return Ok(()) };
        for key in FILES {
            if let Some(name) = structure.get(key).and_then(Item::as_str).map(|name| renamed(name, &from, &to)) {
                structure.insert(key, value(name));
            }
        }
        Ok(())
    }
}

/// Table `[project]` of a template without one.
fn own_project(title: &str) -> String {
    let mut table = Table::new();
    table.insert("format", value(1));
    table.insert("title", value(title));
    let mut document = DocumentMut::new();
    document.insert("project", Item::Table(table));
    format!("{document}\n")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]
    use super::*;

    #[test]
    fn all_but_the_measurements_is_kept() {
        let text = "# beam 3\n[project]\nformat = 1\n\n[structure] # as drawn\nkind = \"chain\"\nmasses = [1.0]\n\n\
                    [[run]]\nfile = \"old.csv\"\n\n[[channel]]\nname = \"a\"\nquantity = \"acc\"\ndof = 1\n\n[analysis]\nharmonics = 3\n";
        let kept = Kept::of(text, Path::new("p.toml")).unwrap().head(Path::new("q.toml"), "q").unwrap();
        assert_eq!(
            kept,
            "# beam 3\n[project]\nformat = 1\n\n[structure] # as drawn\nkind = \"chain\"\nmasses = [1.0]\n\n\
             [analysis]\nharmonics = 3\n\n[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-translation\"\n\n"
        );
        let bare = Kept::of("[structure]\nkind = \"chain\"\n", Path::new("p.toml")).unwrap();
        assert!(
            bare.head(Path::new("q.toml"), "q")
                .unwrap()
                .starts_with("[project]\nformat = 1\ntitle = \"q\"\n\n[structure]")
        );
        assert_eq!(Kept::of("[structure]\nkind = \"points\"\ndofs = [1]\n", Path::new("p.toml")), None);
    }

    #[test]
    fn files_of_the_model_are_named_from_the_new_folder() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("model")).unwrap();
        let text = "[structure]\nkind = \"matrices\"\nmass = \"m.mtx\"\nstiffness = \"k.mtx\"\n";
        let kept = Kept::of(text, &folder.path().join("model/beam.toml")).unwrap();
        let head = kept.head(&folder.path().join("out.toml"), "out").unwrap();
        assert!(head.contains("mass = \"model/m.mtx\"\nstiffness = \"model/k.mtx\"\n"), "{head}");
    }
}
