//! Writes one format, with the files that it needs beside it.

use super::format::{ExportError, Format, Written};
use super::identified::Identified;
use super::{abaqus, calculix, csv, json, mat5, mtx, nastran};
use crate::exchange::atomic::write_atomically;
use std::path::Path;

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
