//! A project out of laboratory files where they lie. What a file holds says what is made of it: time records become runs by a
//! mapping of their channels, frequency responses `[[frf]]`, stepped-sine tables `[[harmonics]]`. The command line and the
//! window ask for it with the same [`Request`] and write the same text.

mod amplitude_tables;
mod driven;
mod driving_point;
mod error;
pub mod files;
mod functions;
mod kept;
mod looks;
mod model;
mod names;
mod numbers;
pub mod plain;
mod records;
mod refusal;
mod request;
mod responses;
mod roving;
mod run_source;
mod shapes;
mod single_mode;
mod stepped;
mod text;

pub use error::ImportError;
pub use kept::Kept;
pub use request::{Imported, Request};
pub use responses::Functions;
pub use text::named;

use crate::control::Control;
use crate::exchange::mapping::{Proposal, Stepped};
use dashpot_datafiles::open;
use error::Result;
use std::path::Path;

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
    let request = &names::taken(request);
    let request = &shapes::without(request);
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
    let request = &names::taken(request);
    let shapes = shapes::files(request);
    shapes::add(measurements(&shapes::without(request), out, control)?, &shapes, out)
}

/// The project of the measurements alone.
fn measurements(request: &Request, out: &Path, control: &Control) -> Result<Imported> {
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
    let request = &names::taken(request);
    let request = &shapes::without(request);
    if has_responses(request)? || stepped_table(request)?.is_some() {
        return import(request, out, control).map(|imported| imported.text());
    }
    records::template(request, records::mapping(request)?, out)
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
