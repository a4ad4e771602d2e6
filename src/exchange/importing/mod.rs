//! A project out of laboratory files where they lie. What a file holds says what is made of it: time records become runs by a
//! mapping of their channels, frequency responses `[[frf]]`, stepped-sine tables `[[harmonics]]`. The command line and the
//! window ask for it with the same [`Request`] and write the same text.

mod error;
pub mod files;
mod model;
mod records;
mod refusal;
mod responses;
mod single_mode;
mod stepped;
mod text;

pub use error::ImportError;
pub use responses::Functions;
pub use text::named;

use crate::control::Control;
use crate::exchange::frf::Form;
use crate::exchange::mapping::{ChannelTable, Proposal, Stepped};
use crate::exchange::project::frf::FrfTable;
use dashpot_datafiles::{Pairing, open};
use std::path::{Path, PathBuf};

type Result<T, E = ImportError> = std::result::Result<T, E>;

/// What is to be imported, and what the user says of it; what is left out is proposed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Request {
    /// Measurement files of one layout.
    pub files: Vec<PathBuf>,
    /// What the channels of time records are.
    pub channels: Option<Vec<ChannelTable>>,
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

/// What files hold that can be imported.
#[derive(Debug, Clone, PartialEq)]
pub enum Holds {
    /// Records over time, and the mapping of their channels.
    Records(Proposal),
    /// Frequency responses.
    Responses(Functions),
    /// A table of a stepped-sine test.
    Stepped(Stepped),
}

/// Looks what the files hold and how their channels would be mapped.
///
/// # Errors
/// One line for a file that cannot be read.
pub fn look(request: &Request) -> Result<Holds> {
    if has_responses(request)? {
        return responses::look(request).map(Holds::Responses);
    }
    match stepped_table(request)? {
        Some(table) => Ok(Holds::Stepped(table)),
        None => records::mapping(request).map(Holds::Records),
    }
}

/// Makes the project at `out` of the files. Nothing is written; the project was opened once.
///
/// # Errors
/// One line: what cannot be read, or what is missing and how to give it.
pub fn import(request: &Request, out: &Path, control: &Control) -> Result<Imported> {
    if has_responses(request)? {
        return responses::import(request, out, control);
    }
    match stepped_table(request)? {
        Some(table) => stepped::import(request, &table, out, control),
        None => records::import(request, records::mapping(request)?, out, control),
    }
}

/// The mapping as a template; of files without one the project.
///
/// # Errors
/// As [`import`].
pub fn proposal(request: &Request, out: &Path, control: &Control) -> Result<String> {
    if has_responses(request)? || stepped_table(request)?.is_some() {
        return import(request, out, control).map(|imported| imported.text());
    }
    records::template(request, records::mapping(request)?)
}

fn has_responses(request: &Request) -> Result<bool> {
    Ok(request.frf.is_some() || request.channels.is_none() && responses::has_responses(request)?)
}

fn stepped_table(request: &Request) -> Result<Option<Stepped>> {
    if request.channels.is_some() {
        return Ok(None);
    }
    let first = request.files.first().ok_or_else(|| ImportError::Said("no measurement file is given".to_owned()))?;
    Ok(crate::exchange::mapping::stepped(&open(first)?))
}
