//! The measurements of one file for a table of their own: what `import` would write a project of, without the project. Time records
//! become SI units by the mapping that `import` proposes, rows of a stepped-sine table harmonics.

use super::error::{ImportError, Result};
use super::records::{channels, labels, mapping, run_table, sources, usable};
use super::refusal::unsampled;
use super::request::Request;
use super::run_source::RunSource;
use super::text::points;
use super::{has_responses, names, stepped, stepped_table};
use crate::control::Control;
use crate::exchange::mapping::Proposal;
use crate::exchange::mapping::units::LabUnit;
use crate::exchange::project::{Fitted, Plan, plan};
use crate::measurement::Record;
use crate::structure::{Direction, Structure};
use dashpot_datafiles::{Channel, open};
use std::path::Path;

/// Most runs that a message names.
const MOST_NAMED: usize = 12;

/// What a file holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Measurements {
    /// Records, each with the name of its run.
    Records(Vec<(String, Record)>),
    /// Rows of a stepped-sine table.
    Harmonics(Vec<Fitted>),
}

/// The measurements of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Plain {
    /// Records or harmonics.
    pub measurements: Measurements,
    /// The measured points; those measured in angles are rotations.
    pub structure: Structure,
    /// What was assumed and what was left out, a line each.
    pub remarks: Vec<String>,
}

/// Which runs of a file are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wanted<'a> {
    /// Set of the run, where one alone is wanted.
    pub set: Option<&'a str>,
    /// Whether what is made of them has room for one run only.
    pub one: bool,
}

/// Reads the first file of the request.
///
/// # Errors
/// As [`super::import`]; also a file of several runs where one alone is wanted.
pub fn plain(request: &Request, wanted: Wanted<'_>, control: &Control) -> Result<Plain> {
    let request = &names::taken(request);
    let file = request.files.first().ok_or_else(|| ImportError::Said("no measurement file is given".to_owned()))?;
    if has_responses(request)? || is_complex(file)? {
        let problem = "holds frequency responses, which are neither records over time nor harmonics of runs; `dashpot import` makes a \
                       project of them where they lie";
        return Err(ImportError::of(file, problem));
    }
    // No project is written: its place is that of the file, so that names in it are those of the folder.
    let out = file.with_extension("toml");
    match stepped_table(request)? {
        Some(table) => {
            let imported = stepped::import(request, &table, &out, control)?;
            let planned = plan(&imported.text(), &out).map_err(ImportError::Unwritten)?;
            let runs = planned.harmonics().map_err(ImportError::Unwritten)?;
            let said = |line: &&str| line.starts_with("assumed:") || line.starts_with("not mapped:");
            let mut remarks: Vec<String> = imported.summary.lines().filter(said).map(str::to_owned).collect();
            if runs.iter().any(|run| run.level.is_some() || run.session.is_some()) {
                remarks.push(
                    "not written: levels and sessions of the rows, which harmonics have no columns for".to_owned(),
                );
            }
            Ok(Plain { measurements: Measurements::Harmonics(runs), structure: planned.structure, remarks })
        }
        None => records(request, file, wanted, &out, control),
    }
}

/// Whether a file has nothing but complex values.
fn is_complex(file: &Path) -> Result<bool> {
    let file = open(file)?;
    let channels: Vec<&Channel> = file.contents().sets.iter().flat_map(|set| &set.channels).collect();
    Ok(!channels.is_empty() && channels.iter().all(|channel| channel.complex))
}

/// The records of a file by the mapping that is given or proposed.
fn records(request: &Request, file: &Path, wanted: Wanted<'_>, out: &Path, control: &Control) -> Result<Plain> {
    let mapping = usable(request, mapping(request)?)?;
    if mapping.needs_sampling && request.sampling_hz.is_none() {
        return Err(ImportError::of(file, unsampled(open(file)?.contents())));
    }
    let sources = chosen(sources(request, &mapping)?, &mapping, file, wanted)?;
    let planned = planned(request, &mapping, &sources, out)?;
    let read = |(index, source): (usize, &RunSource)| {
        let record = planned.record(index, control).map_err(ImportError::Unwritten)?;
        Ok((run_name(source, &mapping), record))
    };
    let records = sources.iter().enumerate().map(read).collect::<Result<Vec<_>>>()?;
    let assumed = mapping.assumed.iter().map(|(name, what)| format!("assumed: {name}: {what}"));
    let left = mapping.left.iter().map(|(name, why)| format!("not mapped: \"{name}\" ({why})"));
    let remarks = assumed.chain(left).collect();
    let structure = with_rotations(planned.structure, &mapping, file)?;
    Ok(Plain { measurements: Measurements::Records(records), structure, remarks })
}

/// The project that the runs would make, on measured points.
fn planned(request: &Request, mapping: &Proposal, sources: &[RunSource], out: &Path) -> Result<Plan> {
    let mut text =
        format!("[project]\nformat = 1\ntitle = \"\"\n\n{}\n{}", points(&labels(mapping)), channels(mapping));
    for source in sources {
        text.push_str(&run_table(request, source, out)?);
    }
    plan(&text, out).map_err(ImportError::Unwritten)
}

/// What a run is called by: its set, or that of its first channel, else its file.
fn run_name(source: &RunSource, mapping: &Proposal) -> String {
    let first = || mapping.channels.first().and_then(|table| table.set.clone());
    source.sets.first().cloned().or_else(|| source.set.clone()).or_else(first).unwrap_or_else(|| source.own_name())
}

/// The runs that are wanted.
fn chosen(sources: Vec<RunSource>, mapping: &Proposal, file: &Path, wanted: Wanted<'_>) -> Result<Vec<RunSource>> {
    if let Some(set) = wanted.set {
        let named = sources.into_iter().find(|source| run_name(source, mapping) == set);
        return Ok(vec![named.unwrap_or_else(|| RunSource::new(file, Some(set.to_owned()), Vec::new()))]);
    }
    if !wanted.one || sources.len() < 2 {
        return Ok(sources);
    }
    let names: Vec<String> =
        sources.iter().take(MOST_NAMED).map(|source| format!("\"{}\"", run_name(source, mapping))).collect();
    let more = sources.len().saturating_sub(MOST_NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let problem = format!(
        "holds {} runs, and a table of samples one; name it by --set ({}{more}), or write all of them --as harmonics",
        sources.len(),
        names.join(", ")
    );
    Err(ImportError::of(file, problem))
}

/// The points with those as rotations that are measured in angles: a table of them must say so.
fn with_rotations(mut structure: Structure, mapping: &Proposal, file: &Path) -> Result<Structure> {
    let file = open(file)?;
    for table in &mapping.channels {
        let mut own = file.contents().sets.iter().flat_map(|set| &set.channels);
        let own = own.find(|channel| channel.name == table.name).map(|channel| channel.unit.clone());
        let unit = table.unit.clone().or(own).unwrap_or_default();
        let rotates = LabUnit::from_name(&unit).is_some_and(|unit| unit.rotation);
        if let Some(dof) = structure.dofs.iter_mut().find(|dof| rotates && dof.label == table.dof) {
            dof.direction = Direction::Rx;
        }
    }
    Ok(structure)
}
