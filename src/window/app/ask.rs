//! What panes ask the window for, and what it answers.

use crate::exchange::export::Format;
use crate::window::app::commands::Command;
use crate::window::app::leaving::Changes;
use crate::window::app::view::Stage;
use crate::window::document::edits::Edit;
use crate::window::files::Pick;
use crate::window::frame::panes::Pane;
use crate::window::frame::report_choice::ReportRequest;
use crate::window::importing::destination::ImportAction;
use crate::window::schematic::gesture::Intent;
use crate::window::stages::explain::request::Request;
use std::path::PathBuf;

/// A message that stays until it is closed.
#[derive(Debug, Clone, PartialEq)]
pub struct Message {
    /// What happened.
    pub text: String,
    /// Whether something failed.
    pub failed: bool,
    /// A project whose unsaved changes can be had back.
    pub restore: Option<PathBuf>,
}

/// What a pane may ask for.
#[derive(Debug, Clone, PartialEq)]
pub enum Ask {
    /// A command of the table.
    Command(Command),
    /// A change of the document.
    Edit(Edit),
    /// A project file.
    Open(PathBuf),
    /// A new project from a template, by its number.
    New(usize),
    /// Measurements, and files of a model, to import.
    Import(Vec<PathBuf>),
    /// Something on the page of an import.
    Importing(ImportAction),
    /// Another name for the project.
    SaveAs(PathBuf),
    /// What was identified in a format; where to, is asked.
    ExportAs(Format),
    /// What was identified, to a file.
    Export(Format, PathBuf),
    /// A stage.
    Stage(Stage),
    /// Something on the schematic.
    Schematic(Intent),
    /// What becomes of unsaved changes.
    Leave(Changes),
    /// Open or close a pane of the stage.
    Pane(Pane, bool),
    /// Something in the stage Explain.
    Explain(Request),
    /// A dialog for a file.
    Pick(Pick),
    /// Files that were chosen in a dialog of the window.
    Picked(Pick, Vec<PathBuf>),
    /// The report, as decided in its dialog; where to, is asked.
    Report(Box<ReportRequest>),
    /// Say why something cannot be done.
    Refuse(String),
    /// Close the message.
    Dismiss,
}

impl Ask {
    /// What is asked for, without the user's data.
    pub fn kind(&self) -> String {
        match self {
            Self::Command(command) => format!("{command:?}"),
            Self::Stage(stage) => format!("Stage {stage:?}"),
            Self::Pane(pane, open) => format!("Pane {pane:?} {open}"),
            Self::ExportAs(format) | Self::Export(format, _) => format!("Export {format:?}"),
            Self::Pick(pick) | Self::Picked(pick, _) => format!("Pick {pick:?}"),
            Self::Leave(changes) => format!("Leave {changes:?}"),
            Self::Edit(_) => "Edit".to_owned(),
            Self::Open(_) => "Open".to_owned(),
            Self::New(template) => format!("New {template}"),
            Self::Import(_) | Self::Importing(_) => "Import".to_owned(),
            Self::SaveAs(_) => "SaveAs".to_owned(),
            Self::Schematic(_) => "Schematic".to_owned(),
            Self::Explain(_) => "Explain".to_owned(),
            Self::Report(_) => "Report".to_owned(),
            Self::Refuse(_) => "Refuse".to_owned(),
            Self::Dismiss => "Dismiss".to_owned(),
        }
    }
}
