//! Identified matrices and sources in the formats of other programs.

mod abaqus;
mod calculix;
mod csv;
mod dashpots;
mod json;
pub mod mat5;
mod mtx;
mod nastran;
mod outcome;

pub use outcome::write_outcome;

use super::atomic::write_atomically;
use crate::effects::{Effect, Source};
use crate::structure::Structure;
use faer::Mat;
use std::io;
use std::path::{Path, PathBuf};

/// A source with its identified (or known) values.
#[derive(Debug, Clone, PartialEq)]
pub struct IdentifiedSource {
    /// The source at its values.
    pub source: Source,
    /// Standard deviation of each parameter; 0 where it is known.
    pub deviation: Vec<f64>,
    /// Share of all dissipated energy, per cent.
    pub energy_percent: f64,
}

/// A damped mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IdentifiedMode {
    /// Frequency `|lambda| / 2 pi`, Hz.
    pub frequency_hz: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Its standard deviation.
    pub deviation: f64,
}

/// Everything that is exported; matrices are n x n in the order of [`Structure::dofs`].
#[derive(Debug, Clone, Copy)]
pub struct Identified<'a> {
    /// Title of the project.
    pub title: &'a str,
    /// Structure.
    pub structure: &'a Structure,
    /// Identified and known sources.
    pub sources: &'a [IdentifiedSource],
    /// Viscous damping matrix, N s/m.
    pub viscous: &'a Mat<f64>,
    /// One matrix of coefficients for each other law, in that law's unit.
    pub others: &'a [(Effect, Mat<f64>)],
    /// Viscous matrix of equal energy over all runs, N s/m.
    pub equivalent: &'a Mat<f64>,
    /// Share of each DOF in all dissipated energy, per cent.
    pub energy_percent: &'a [f64],
    /// Damped modes; empty without mass and stiffness.
    pub modes: &'a [IdentifiedMode],
}

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

/// One file of an export, not yet written.
struct File {
    path: PathBuf,
    bytes: Vec<u8>,
}

/// Files and what could not be said in the format.
#[derive(Default)]
struct Export {
    files: Vec<File>,
    warnings: Vec<String>,
}

impl Export {
    fn add(&mut self, path: PathBuf, bytes: impl Into<Vec<u8>>) {
        self.files.push(File { path, bytes: bytes.into() });
    }
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

/// `damping.csv` and `sources` give `damping-sources.csv`.
fn beside(path: &Path, suffix: &str) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let mut name = format!("{stem}-{suffix}");
    if let Some(extension) = path.extension() {
        name = format!("{name}.{}", extension.to_string_lossy());
    }
    path.with_file_name(name)
}

/// DOF labels joined for a table, such as `13-17`; `structure` for the whole, the name for a channel.
fn place_text(source: &Source, structure: &Structure) -> String {
    use crate::effects::Place;
    match &source.place {
        Place::Dofs(dofs) => dofs.iter().map(|&d| structure.label(d)).collect::<Vec<_>>().join("-"),
        Place::Whole(None) => "structure".to_owned(),
        Place::Whole(Some([first, last])) => format!("elements {}-{}", first + 1, last + 1),
        Place::Channel(name) => name.clone(),
    }
}
