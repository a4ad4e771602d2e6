//! Sources and sensors of a project on its structure: labels found, families expanded, repetitions refused.

use super::error::{ProjectError, TableProblem};
use super::file::{CandidatesTable, ProjectFile, SensorTable, SourceTable};
use super::label::Label;
use super::lines::At;
use crate::effects::source::SourceError;
use crate::effects::{Effect, Kind, Place, Source, State};
use crate::measurement::Quantity;
use crate::structure::{Structure, StructureError};

fn structure_problem(error: StructureError) -> TableProblem {
    TableProblem::Structure(Box::new(error))
}

fn source_problem(error: SourceError) -> TableProblem {
    TableProblem::Source(Box::new(error))
}

/// All sources: those written one by one, then the families where nothing is written already. A place that is a candidate
/// already, or forced, is not offered twice.
///
/// # Errors
/// [`ProjectError`] for the first table that does not hold.
pub(crate) fn sources(file: &ProjectFile, structure: &Structure, at: At<'_>) -> Result<Vec<Source>, ProjectError> {
    const SOURCE: &str = "[[source]]";
    let wrong = |name, k, problem: TableProblem| at.error(name, k, key_at_fault(&problem), problem);
    let mut sources: Vec<Source> = Vec::new();
    for (k, table) in file.source.iter().enumerate() {
        let source = single(table, structure).map_err(|problem| wrong(SOURCE, k, problem))?;
        if let Some(first) = sources.iter().position(|other| clashes(other, &source)) {
            let (source_name, first) = (source.phrase(structure), at.lines.of(SOURCE, first, ""));
            return Err(wrong(SOURCE, k, TableProblem::SourceTwice { law: table.law, source_name, first }));
        }
        sources.push(source);
    }
    for (k, table) in file.candidates.iter().enumerate() {
        let members = members(table, structure).map_err(|problem| wrong("[[candidates]]", k, problem))?;
        for source in members {
            if !sources.iter().any(|other| other.state.is_sought() && other.is_same(&source)) {
                sources.push(source);
            }
        }
    }
    Ok(sources)
}

/// Whether two written sources cannot both be meant. What is known may have more of the same law found on top of it.
fn clashes(a: &Source, b: &Source) -> bool {
    let alike = a.state == b.state || (a.state.is_sought() && b.state.is_sought());
    alike && a.state != State::Off && a.is_same(b)
}

/// The key that a problem of a source is about; empty where it is about the whole table.
pub(super) fn key_at_fault(problem: &TableProblem) -> &'static str {
    match problem {
        TableProblem::Structure(_) => "dofs",
        TableProblem::EmptyFamily { .. } => "where",
        TableProblem::ChannelLaw { .. } => "law",
        TableProblem::Source(error) => match &**error {
            SourceError::OutOfRange { name, .. } => name,
            SourceError::NeedsWhole { .. } | SourceError::PairedWithItself { .. } => "dofs",
            SourceError::NoSuchElements { .. } => "elements",
            _ => "law",
        },
        _ => "",
    }
}

/// The place of a law on DOFs, or of one of the whole structure with its range of elements.
///
/// # Errors
/// [`TableProblem`] where there is no such place, or the law cannot act there.
pub(crate) fn at_place(
    effect: Effect,
    dofs: &[Label],
    range: Option<[i64; 2]>,
    structure: &Structure,
) -> Result<Place, TableProblem> {
    Ok(match effect.kind() {
        Kind::Channel(_) => return Err(TableProblem::ChannelLaw { law: effect.name() }),
        Kind::Relative(_) if range.is_some() => {
            let hint = "`elements` restricts laws of the whole structure only, so leave it out".to_owned();
            return Err(TableProblem::UnknownKey { table: format!("law `{effect}`"), key: "elements".into(), hint });
        }
        Kind::Relative(_) => {
            let rows = dofs.iter().map(|label| structure.require_dof(&label.0));
            Place::Dofs(rows.collect::<Result<_, _>>().map_err(structure_problem)?)
        }
        Kind::Whole(_) if !dofs.is_empty() => return Err(source_problem(SourceError::NeedsWhole { effect })),
        Kind::Whole(_) => Place::Whole(range.map(|range| elements(effect, range, structure)).transpose()?),
    })
}

/// The source of one table, checked.
///
/// # Errors
/// [`TableProblem`] where the law cannot act there or not with these parameters.
pub(crate) fn single(table: &SourceTable, structure: &Structure) -> Result<Source, TableProblem> {
    let effect = table.law;
    let place = at_place(effect, &table.dofs, table.elements, structure)?;
    let values: Vec<(&str, f64)> = table.parameters.iter().map(|(name, &value)| (name.as_str(), value)).collect();
    let source = Source::named(effect, place, table.state, &values).map_err(source_problem)?;
    source.check_on(structure).map_err(source_problem)?;
    Ok(source)
}

/// From elements counted from 1 to elements counted from 0.
fn elements(effect: Effect, range: [i64; 2], structure: &Structure) -> Result<[usize; 2], TableProblem> {
    let count = structure.elements().len();
    let number = |n: i64| usize::try_from(n).unwrap_or(0);
    let (first, last) = (number(range[0]), number(range[1]));
    if first == 0 || last == 0 {
        return Err(source_problem(SourceError::NoSuchElements { effect, first, last, count }));
    }
    Ok([first - 1, last - 1])
}

/// The candidates of one family, checked.
///
/// # Errors
/// [`TableProblem`] where one cannot act, or there is no place for any.
pub(crate) fn members(table: &CandidatesTable, structure: &Structure) -> Result<Vec<Source>, TableProblem> {
    if matches!(table.law.kind(), Kind::Channel(_)) {
        return Err(TableProblem::ChannelLaw { law: table.law.name() });
    }
    let values: Vec<(&str, f64)> = table.parameters.iter().map(|(name, &value)| (name.as_str(), value)).collect();
    let mut sources = Vec::new();
    for candidate in table.family.candidates(table.law, structure) {
        let source = Source::named(table.law, candidate.place, State::Candidate, &values).map_err(source_problem)?;
        source.check_on(structure).map_err(source_problem)?;
        sources.push(source);
    }
    if sources.is_empty() { Err(TableProblem::EmptyFamily { family: table.family.name() }) } else { Ok(sources) }
}

/// Known errors of the measuring chain, one source a value.
///
/// # Errors
/// [`ProjectError`] for the first table that does not hold.
pub(crate) fn sensors(tables: &[SensorTable], structure: &Structure, at: At<'_>) -> Result<Vec<Source>, ProjectError> {
    const SENSOR: &str = "[[sensor]]";
    let mut sensors: Vec<Source> = Vec::new();
    let mut first = Vec::new();
    for (k, table) in tables.iter().enumerate() {
        let wrong = |problem| at.error(SENSOR, k, "", problem);
        let name = channel(&table.channel, structure).map_err(wrong)?;
        for (effect, value) in table.errors() {
            let source = Source::known(effect, Place::Channel(name.clone()), &[value]);
            source.check().map_err(|error| wrong(source_problem(error)))?;
            if let Some(known) = sensors.iter().position(|other| other.is_same(&source)) {
                let what = format!("the {effect} of \"{name}\"");
                return Err(wrong(TableProblem::Twice { what, first: first[known] }));
            }
            sensors.push(source);
            first.push(at.lines.of(SENSOR, k, ""));
        }
    }
    Ok(sensors)
}

/// The channel's name as all channels are named, with a label of the structure.
pub(super) fn channel(name: &str, structure: &Structure) -> Result<String, TableProblem> {
    let wrong = || TableProblem::NotAllowed {
        key: "channel".into(),
        value: super::reader::one_line(name),
        allowed: "force@DOF, acc@DOF, vel@DOF, disp@DOF, without a unit".into(),
    };
    let (word, label) = name.trim().split_once('@').ok_or_else(wrong)?;
    let quantity = Quantity::from_word(&word.trim().to_lowercase()).ok_or_else(wrong)?;
    let label = label.trim();
    if label.ends_with(']') {
        return Err(wrong());
    }
    structure.require_dof(label).map_err(structure_problem)?;
    Ok(format!("{}@{label}", quantity.word()))
}
