//! Identified matrices and sources in the formats of other programs.

mod abaqus;
mod calculix;
mod csv;
mod dashpots;
mod files;
mod identified;
mod json;
pub mod mat5;
mod mtx;
mod nastran;
mod outcome;

pub use identified::{Identified, IdentifiedMode, IdentifiedSource};
pub use outcome::write_outcome;

use super::atomic::write_atomically;
use std::io;
use std::path::{Path, PathBuf};

/// A format of another program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Comma-separated values with DOF labels.
    Csv,
    /// Matrix Market, symmetric coordinate.
    Mtx,
    /// MATLAB level 5.
    Mat,
    /// One JSON document.
    Json,
    /// NASTRAN bulk data: DMIG, CDAMP2.
    Nastran,
    /// Abaqus dashpot elements.
    Abaqus,
    /// CalculiX dashpot elements.
    Calculix,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 7] =
        [Self::Csv, Self::Mtx, Self::Mat, Self::Json, Self::Nastran, Self::Abaqus, Self::Calculix];

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Mtx => "mtx",
            Self::Mat => "mat",
            Self::Json => "json",
            Self::Nastran => "nastran",
            Self::Abaqus => "abaqus",
            Self::Calculix => "calculix",
        }
    }

    /// The format of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.name() == name)
    }
}

/// Why an export failed.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The file system refused.
    #[error("{}: cannot be written ({error}); choose a folder that exists and may be written to", path.display())]
    Write {
        /// File.
        path: PathBuf,
        /// What the file system said.
        error: io::Error,
    },
}

/// What was written, and what the format could not hold.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// Files, the one asked for first.
    pub paths: Vec<PathBuf>,
    /// What the format could not hold, a sentence each.
    pub warnings: Vec<String>,
}

/// Writes the identified matrices and sources to `path`; formats that need several files put the others beside it.
pub fn write(identified: &Identified, format: Format, path: &Path) -> Result<Written, ExportError> {
    let export = match format {
        Format::Csv => csv::export(identified, path),
        Format::Mtx => mtx::export(identified, path),
        Format::Mat => mat5::export(identified, path),
        Format::Json => json::export(identified, path),
        Format::Nastran => nastran::export(identified, path),
        Format::Abaqus => abaqus::export(identified, path),
        Format::Calculix => calculix::export(identified, path),
    };
    for file in &export.files {
        write_atomically(&file.path, &file.bytes)
            .map_err(|error| ExportError::Write { path: file.path.clone(), error })?;
    }
    Ok(Written { paths: export.files.into_iter().map(|file| file.path).collect(), warnings: export.warnings })
}
