//! The formats of other programs, and what comes of writing one.

use std::io;
use std::path::PathBuf;

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
