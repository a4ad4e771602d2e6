//! Files and folders that are given together: which are measurements, which belong to a finite-element model.

use super::error::{ImportError, Result};
use super::request::Request;
use dashpot_datafiles::listed_names;
use std::path::{Path, PathBuf};

/// Deepest folders that are looked into.
const DEEPEST: usize = 8;

/// The files, and those in the folders among them, in the order of their names.
///
/// # Errors
/// One line for a folder that cannot be read.
pub fn listed(paths: &[PathBuf]) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    paths.iter().try_for_each(|path| collect(path, &mut files, 0))?;
    Ok(files)
}

fn collect(path: &Path, files: &mut Vec<PathBuf>, depth: usize) -> Result<()> {
    if !path.is_dir() {
        files.push(path.to_owned());
        return Ok(());
    }
    if depth > DEEPEST {
        return Ok(());
    }
    let failed = |error| ImportError::of(path, format!("the folder cannot be read: {error}"));
    let listing = std::fs::read_dir(path).map_err(failed)?;
    let mut inside: Vec<PathBuf> = listing.filter_map(std::result::Result::ok).map(|entry| entry.path()).collect();
    inside.sort();
    let hidden = |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
    inside
        .iter()
        .filter(|path| !hidden(path) && !path.is_symlink())
        .try_for_each(|path| collect(path, files, depth + 1))
}

/// Endings of files that lie among measurements and are none: pictures, documents, programs, what programs keep for themselves.
const OTHERS: [&str; 32] = [
    "toml",
    "md",
    "pdf",
    "png",
    "jpg",
    "jpeg",
    "gif",
    "bmp",
    "tif",
    "tiff",
    "svg",
    "heic",
    "mp4",
    "mov",
    "avi",
    "doc",
    "docx",
    "ppt",
    "pptx",
    "rtf",
    "json",
    "ini",
    "db",
    "lnk",
    "html",
    "htm",
    "m",
    "py",
    "vi",
    "ipynb",
    "tdms_index",
    "log",
];

/// Whether a file of a folder may hold measurements: it is neither a project nor a picture nor notes, of texts those with a row
/// of numbers, or with names of channels.
pub fn may_be_measurement(file: &Path) -> bool {
    let end = file.extension().map(|end| end.to_string_lossy().to_lowercase());
    match end.as_deref() {
        None => false,
        Some("txt") => listed_names(file).is_some() || !is_prose(file),
        Some(end) => !OTHERS.contains(&end),
    }
}

/// Whether a text has no line that begins with a number; only the beginning of a long one is looked at.
fn is_prose(file: &Path) -> bool {
    use std::io::Read;
    let mut beginning = Vec::new();
    let read = std::fs::File::open(file).and_then(|file| file.take(1 << 16).read_to_end(&mut beginning));
    let text: String = String::from_utf8_lossy(&beginning).replace('\0', "");
    let is_number =
        |line: &str| line.trim_start().starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '+' | '.'));
    read.is_ok() && beginning.len() < 1 << 16 && !text.lines().any(is_number)
}

/// The part of a finite-element model that a file is, by its ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelPart {
    /// Mass and stiffness, or one of the two.
    Matrices,
    /// Mass.
    Mass,
    /// Stiffness.
    Stiffness,
    /// Nodes and lines.
    Nodes,
    /// Read beside another: the DOFs of CalculiX.
    Beside,
}

impl ModelPart {
    /// What a file is, where it belongs to a model.
    pub fn of(path: &Path) -> Option<Self> {
        let end = path.extension()?.to_string_lossy().to_lowercase();
        let stem = path.file_stem()?.to_string_lossy().to_lowercase();
        let matrix = if stem.contains("mass") || stem == "m" {
            Self::Mass
        } else if stem.contains("stif") || stem == "k" {
            Self::Stiffness
        } else {
            Self::Matrices
        };
        match end.as_str() {
            "bdf" | "nas" | "pch" | "op4" | "mtx" => Some(matrix),
            "mas" => Some(Self::Mass),
            "sti" => Some(Self::Stiffness),
            "inp" => Some(Self::Nodes),
            "dof" => Some(Self::Beside),
            _ => None,
        }
    }
}

impl Request {
    /// Files given together: those of a finite-element model are taken as the model, all others as measurements.
    pub fn of(files: Vec<PathBuf>) -> Self {
        let mut request = Self::default();
        let mut matrices: Vec<PathBuf> = Vec::new();
        for file in files {
            match ModelPart::of(&file) {
                Some(ModelPart::Mass) => request.mass = Some(file),
                Some(ModelPart::Stiffness) => request.stiffness = Some(file),
                Some(ModelPart::Nodes) => request.nodes = Some(file),
                Some(ModelPart::Matrices) => matrices.push(file),
                Some(ModelPart::Beside) => {}
                None => request.files.push(file),
            }
        }
        for file in matrices {
            match (&request.mass, &request.stiffness) {
                (None, _) => request.mass = Some(file),
                (Some(_), None) => request.stiffness = Some(file),
                _ => {}
            }
        }
        request
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::disallowed_methods, reason = "tests")]
    use super::*;

    /// What lies beside measurements in the folders of laboratories is passed over, measurements are not.
    #[test]
    fn files_of_a_folder_that_are_no_measurements_are_told() -> std::io::Result<()> {
        let folder = tempfile::tempdir()?;
        let kept = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).map(|()| may_be_measurement(&path))
        };
        assert!(kept("run.TDMS", "TDSm")? && kept("run.txt", "t F\n0.1 2\n")? && kept("names.txt", "Force\nAcc 1\n")?);
        assert!(
            !kept("notes.txt", "Sensor 3 is loose; ask again\n")?
                && !kept("run.tdms_index", "TDSh")?
                && !kept("rig.JPG", "")?
        );
        Ok(())
    }

    #[test]
    fn a_model_among_the_files_is_told_from_measurements() {
        let request =
            Request::of(["a.uff", "wing.sti", "wing.mas", "wing.dof", "wing.inp", "b.uff"].map(PathBuf::from).into());
        assert_eq!(request.files, ["a.uff", "b.uff"].map(PathBuf::from));
        assert_eq!(request.mass, Some("wing.mas".into()));
        assert_eq!((request.stiffness, request.nodes), (Some("wing.sti".into()), Some("wing.inp".into())));
        let one = Request::of(["model.bdf", "a.tdms"].map(PathBuf::from).into());
        assert_eq!((one.mass, one.stiffness), (Some("model.bdf".into()), None));
        let two = Request::of(["wing-k.mtx", "wing_mass.mtx"].map(PathBuf::from).into());
        assert_eq!((two.mass, two.stiffness), (Some("wing_mass.mtx".into()), Some("wing-k.mtx".into())));
    }
}
