//! Files that the user is asked for, in the desktop's own dialogs.

use crate::exchange::Project;
use crate::exchange::export::{Format, write_outcome};
use crate::identify::Outcome;
use rfd::AsyncFileDialog;
use std::path::{Path, PathBuf};

/// Name of the work that waits for a dialog.
pub const ASKING: &str = "Choosing a file";

/// Endings of measurement files.
const MEASUREMENTS: [&str; 16] =
    ["uff", "unv", "uf", "mat", "h5", "hdf5", "tdms", "lvm", "csv", "txt", "tsv", "dat", "xlsx", "wav", "npy", "npz"];

/// What a file is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pick {
    /// A project to open.
    Open,
    /// Measurements to import.
    Import,
    /// Files of the model that is laid under an import.
    Model,
    /// Where to save the project.
    SaveAs,
    /// Where to write what was identified.
    Export(Format),
    /// Where to write the report.
    Report,
}

/// Shows the dialog; what was chosen, empty where it was closed.
pub fn ask(pick: Pick) -> impl Future<Output = Vec<PathBuf>> + Send {
    let dialog = AsyncFileDialog::new();
    let dialog = match pick {
        Pick::Open => dialog
            .set_title("Open a project or measurements")
            .add_filter("Dashpot project", &["toml"])
            .add_filter("Measurements", &MEASUREMENTS)
            .add_filter("All files", &["*"]),
        Pick::Import => dialog
            .set_title("Import measurements")
            .add_filter("Measurements", &MEASUREMENTS)
            .add_filter("All files", &["*"]),
        Pick::Model => dialog
            .set_title("Mass, stiffness and nodes of the model")
            .add_filter("Finite-element model", &["bdf", "dat", "nas", "pch", "op4", "mtx", "sti", "mas", "inp"])
            .add_filter("All files", &["*"]),
        Pick::SaveAs => dialog.set_title("Save the project as").set_file_name("project.toml"),
        Pick::Report => dialog.set_title("Report").set_file_name("report.html").add_filter("HTML", &["html"]),
        Pick::Export(format) => dialog.set_title("Export").set_file_name(format!("damping.{}", extension(format))),
    };
    async move {
        let paths = |files: Vec<rfd::FileHandle>| files.iter().map(|f| f.path().to_path_buf()).collect();
        match pick {
            Pick::Open => paths(dialog.pick_file().await.into_iter().collect()),
            Pick::Import | Pick::Model => paths(dialog.pick_files().await.unwrap_or_default()),
            Pick::SaveAs | Pick::Export(_) | Pick::Report => paths(dialog.save_file().await.into_iter().collect()),
        }
    }
}

/// Writes what was identified in a format of another program, and says what was written.
///
/// # Errors
/// One line.
pub fn export(project: &Project, outcome: &Outcome, format: Format, path: &Path) -> Result<String, String> {
    let written = write_outcome(project, outcome, format, path).map_err(|e| e.to_string())?;
    let names: Vec<String> = written.paths.iter().map(|p| p.display().to_string()).collect();
    let mut text = format!("Written: {}.", names.join(", "));
    for warning in written.warnings {
        text.push(' ');
        text.push_str(&warning);
    }
    Ok(text)
}

/// Usual extension of a format.
pub fn extension(format: Format) -> &'static str {
    match format {
        Format::Csv => "csv",
        Format::Mtx => "mtx",
        Format::Mat => "mat",
        Format::Json => "json",
        Format::Nastran => "bdf",
        Format::Abaqus | Format::Calculix => "inp",
    }
}

/// A format in words, for the menu.
pub fn words(format: Format) -> &'static str {
    match format {
        Format::Csv => "CSV table…",
        Format::Mtx => "Matrix Market…",
        Format::Mat => "MATLAB…",
        Format::Json => "JSON…",
        Format::Nastran => "NASTRAN DMIG and CDAMP2…",
        Format::Abaqus => "Abaqus dashpots…",
        Format::Calculix => "CalculiX dashpots…",
    }
}
