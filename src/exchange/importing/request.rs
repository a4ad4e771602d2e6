//! What is asked of an import, and what it gives.

use super::kept::Kept;
use crate::exchange::frf::Form;
use crate::exchange::mapping::ChannelTable;
use crate::exchange::project::frf::FrfTable;
use dashpot_datafiles::Pairing;
use std::path::PathBuf;

/// What is to be imported, and what the user says of it; what is left out is proposed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Request {
    /// Measurement files of one layout.
    pub files: Vec<PathBuf>,
    /// Names of the columns of files that have none, of a file that lists them.
    pub names: Vec<String>,
    /// What the channels of time records are.
    pub channels: Option<Vec<ChannelTable>>,
    /// A project that has a model already: all of it but its measurements is kept. `mass` goes before it.
    pub kept: Option<Kept>,
    /// Sampling rate of files that do not say it, Hz.
    pub sampling_hz: Option<f64>,
    /// Mass matrix of a finite-element model, or a file with mass and stiffness.
    pub mass: Option<PathBuf>,
    /// Stiffness matrix of the model, where it is not in the file of the mass.
    pub stiffness: Option<PathBuf>,
    /// Nodes of the model, where the matrices have none.
    pub nodes: Option<PathBuf>,
    /// What frequency responses relate, where their unit does not say it.
    pub form: Option<Form>,
    /// Step of the frequencies, Hz, where the file does not say them.
    pub step_hz: Option<f64>,
    /// How columns are parts of complex numbers two by two, where their names do not say it.
    pub columns: Option<Pairing>,
    /// Factor on frequency responses.
    pub scale: Option<f64>,
    /// Averages of frequency responses.
    pub averages: Option<usize>,
    /// Labels of responses in the order of the functions.
    pub responses: Vec<String>,
    /// Labels of references in the order of the functions.
    pub references: Vec<String>,
    /// Table `[[frf]]` of a template.
    pub frf: Option<Box<FrfTable>>,
}

impl Request {
    /// Whether there is mass and stiffness beside the measurements.
    pub(super) fn has_model(&self) -> bool {
        self.mass.is_some() || self.kept.is_some()
    }
}

/// A project that was made of files.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Imported {
    /// Title, structure and candidates.
    pub head: String,
    /// Tables of the measurements.
    pub tables: String,
    /// What was made and what was assumed, for the user.
    pub summary: String,
    /// What should be known of the measurements.
    pub remarks: Vec<String>,
}

impl Imported {
    /// Text of the project file.
    pub fn text(&self) -> String {
        format!("{}{}", self.head, self.tables)
    }
}
