//! Files that the user is asked for, in the desktop's own dialogs.

pub(crate) mod chosen_files;
pub(crate) mod import;

use crate::exchange::Project;
use crate::exchange::export::{Format, write_outcome};
use crate::identify::Outcome;
use crate::window::plots::export::Kind;
use rfd::AsyncFileDialog;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Name of the work that waits for a dialog.
pub(crate) const ASKING: &str = "Choosing a file";

/// Endings of measurement files.
const MEASUREMENTS: &[&str] =
    &["uff", "unv", "uf", "mat", "h5", "hdf5", "tdms", "lvm", "csv", "txt", "tsv", "dat", "xlsx", "wav", "npy", "npz"];

/// Endings of projects and of measurement files.
const OPENED: &[&str] = &[
    "toml", "uff", "unv", "uf", "mat", "h5", "hdf5", "tdms", "lvm", "csv", "txt", "tsv", "dat", "xlsx", "wav", "npy",
    "npz",
];

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
    /// The project of an earlier state, to compare with.
    EarlierState,
    /// The logo of a report.
    Logo,
    /// Where to write a plot or a table.
    Plot(Kind),
}

impl Pick {
    /// Whether the file is to be written.
    pub fn writes(self) -> bool {
        matches!(self, Self::SaveAs | Self::Export(_) | Self::Report | Self::Plot(_))
    }
}

/// What a dialog asks for, in words.
pub(crate) fn title(pick: Pick) -> &'static str {
    match pick {
        Pick::Open => "Open a project or measurements",
        Pick::EarlierState => "Project of the earlier state",
        Pick::Import => "Import measurements",
        Pick::Model => "Mass, stiffness and nodes of the model",
        Pick::SaveAs => "Save the project as",
        Pick::Report => "Report",
        Pick::Export(_) => "Export",
        Pick::Logo => "Logo of the report",
        Pick::Plot(_) => "Export plot",
    }
}

/// Endings of the files that may be meant; empty for any.
pub(crate) fn endings(pick: Pick) -> &'static [&'static str] {
    match pick {
        Pick::EarlierState | Pick::SaveAs => &["toml"],
        Pick::Open => OPENED,
        Pick::Import => MEASUREMENTS,
        Pick::Model => &["bdf", "dat", "nas", "pch", "op4", "mtx", "sti", "mas", "inp"],
        Pick::Report => &["pdf", "html"],
        Pick::Logo => &["png"],
        Pick::Plot(kind) => kind.endings(),
        Pick::Export(_) => &[],
    }
}

/// Name of a file that is to be written, proposed.
pub(crate) fn proposal(pick: Pick) -> String {
    match pick {
        Pick::SaveAs => "project.toml".to_owned(),
        Pick::Report => "report.pdf".to_owned(),
        Pick::Export(format) => format!("damping.{}", extension(format)),
        Pick::Plot(kind) => format!("plot.{}", kind.endings()[0]),
        Pick::Open | Pick::EarlierState | Pick::Import | Pick::Model | Pick::Logo => String::new(),
    }
}

/// A dialog of the desktop that has ended sooner was never shown: nobody closes one so fast.
pub(crate) const SHOWN: Duration = Duration::from_millis(250);

/// Whether the desktop may show dialogs for files: through its portal, which needs a session bus, or through zenity. Other
/// systems always do. A bus without a portal is found out by the first dialog, which ends at once ([`SHOWN`]).
pub(crate) fn desktop_has_dialogs() -> bool {
    if !cfg!(target_os = "linux") {
        return true;
    }
    let bus = std::env::var_os("DBUS_SESSION_BUS_ADDRESS").is_some()
        || std::env::var_os("XDG_RUNTIME_DIR").is_some_and(|folder| Path::new(&folder).join("bus").exists());
    let zenity = || {
        let paths = std::env::var_os("PATH").unwrap_or_default();
        std::env::split_paths(&paths).any(|folder| folder.join("zenity").is_file())
    };
    bus || zenity()
}

/// Shows the dialog; what was chosen, empty where it was closed.
pub(crate) fn ask(pick: Pick, name: &str) -> impl Future<Output = Vec<PathBuf>> + Send + use<> {
    let dialog = AsyncFileDialog::new().set_title(title(pick));
    let dialog = if pick.writes() { dialog.set_file_name(name) } else { dialog };
    let endings = endings(pick);
    let dialog = if endings.is_empty() { dialog } else { dialog.add_filter(endings.join(", "), endings) };
    async move {
        let paths = |files: Vec<rfd::FileHandle>| files.iter().map(|f| f.path().to_path_buf()).collect();
        match pick {
            Pick::Open | Pick::EarlierState | Pick::Logo => paths(dialog.pick_file().await.into_iter().collect()),
            Pick::Import | Pick::Model => paths(dialog.pick_files().await.unwrap_or_default()),
            Pick::SaveAs | Pick::Export(_) | Pick::Report | Pick::Plot(_) => {
                paths(dialog.save_file().await.into_iter().collect())
            }
        }
    }
}

/// Writes what was identified in a format of another program, and says what was written.
///
/// # Errors
/// One line.
pub(crate) fn export(project: &Project, outcome: &Outcome, format: Format, path: &Path) -> Result<String, String> {
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
pub(crate) fn extension(format: Format) -> &'static str {
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
pub(crate) fn words(format: Format) -> &'static str {
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
