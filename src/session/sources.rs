//! Sources of a project file on its structure: found by law and place, families expanded, repetitions refused.

use super::command::SourceAt;
use super::refusal::Refusal;
use crate::effects::Kind;
use crate::effects::source::SourceError;
use crate::effects::{Effect, Place, Source, State};
use crate::exchange::project::file::{CandidatesTable, ProjectFile, SourceTable};
use crate::exchange::project::label::Label;
use crate::exchange::project::ruled_out::RuledOutTable;
use crate::structure::Structure;
use std::collections::BTreeMap;

/// All sources: those drawn one by one, then the members of the families that are not drawn already.
pub(super) fn expand(file: &ProjectFile, structure: &Structure) -> Result<Vec<Source>, Refusal> {
    let mut all: Vec<Source> = Vec::new();
    for table in &file.source {
        let source = single(table, structure)?;
        if all.iter().any(|other| clashes(other, &source)) {
            return Err(Refusal::DrawnTwice { law: table.law, place: place_words(&table.dofs, table.elements) });
        }
        all.push(source);
    }
    for table in &file.candidates {
        for source in members(table, structure)? {
            if !all.iter().any(|other| is_sought(other.state) && other.is_same(&source)) {
                all.push(source);
            }
        }
    }
    Ok(all)
}

/// Whether identification may select it.
fn is_sought(state: State) -> bool {
    matches!(state, State::Candidate | State::Forced)
}

/// Whether two drawn sources cannot both be meant. What is known may have more of the same law found on top of it.
fn clashes(a: &Source, b: &Source) -> bool {
    let alike = a.state == b.state || (is_sought(a.state) && is_sought(b.state));
    alike && a.state != State::Off && a.is_same(b)
}

fn named(law: Effect, place: Place, state: State, values: &BTreeMap<String, f64>) -> Result<Source, SourceError> {
    let values: Vec<(&str, f64)> = values.iter().map(|(name, &value)| (name.as_str(), value)).collect();
    Source::named(law, place, state, &values)
}

/// The source of one table, checked.
fn single(table: &SourceTable, structure: &Structure) -> Result<Source, Refusal> {
    let place = place(table.law, &table.dofs, table.elements, structure)?;
    let source = named(table.law, place, table.state, &table.parameters)?;
    source.check_on(structure)?;
    Ok(source)
}

fn place(law: Effect, dofs: &[Label], range: Option<[i64; 2]>, structure: &Structure) -> Result<Place, Refusal> {
    match law.kind() {
        Kind::Channel(_) => Err(Refusal::ChannelLaw { law }),
        Kind::Relative(_) if range.is_some() => Err(SourceError::NeedsDofs { effect: law }.into()),
        Kind::Relative(_) => {
            let rows: Result<Vec<usize>, _> = dofs.iter().map(|label| structure.require_dof(&label.0)).collect();
            Ok(Place::Dofs(rows?))
        }
        Kind::Whole(_) if !dofs.is_empty() => Err(SourceError::NeedsWhole { effect: law }.into()),
        Kind::Whole(_) => Ok(Place::Whole(range.map(|range| elements(law, range, structure)).transpose()?)),
    }
}

/// From elements counted from 1 to elements counted from 0.
fn elements(effect: Effect, range: [i64; 2], structure: &Structure) -> Result<[usize; 2], SourceError> {
    let [first, last] = range.map(|n| usize::try_from(n).unwrap_or(0));
    let count = structure.elements().len();
    let wrong = SourceError::NoSuchElements { effect, first, last, count };
    if first == 0 || last == 0 { Err(wrong) } else { Ok([first - 1, last - 1]) }
}

/// Candidates of one family, checked.
fn members(table: &CandidatesTable, structure: &Structure) -> Result<Vec<Source>, Refusal> {
    if matches!(table.law.kind(), Kind::Channel(_)) {
        return Err(Refusal::ChannelLaw { law: table.law });
    }
    let places = table.family.candidates(table.law, structure).into_iter().map(|candidate| candidate.place);
    let sources: Result<Vec<Source>, Refusal> = places
        .map(|place| {
            let source = named(table.law, place, State::Candidate, &table.parameters)?;
            source.check_on(structure)?;
            Ok(source)
        })
        .collect();
    match sources {
        Ok(none) if none.is_empty() => Err(Refusal::EmptyFamily { family: table.family.name() }),
        sources => sources,
    }
}

/// Index of a source in the file. A member of a family is not there: its family is first written out one by one.
pub(super) fn find(file: &mut ProjectFile, at: &SourceAt, structure: &Structure) -> Result<usize, Refusal> {
    if let Some(index) = drawn(file, at, structure)? {
        return Ok(index);
    }
    let absent = || Refusal::NoSuchSource { law: at.law, place: words(&at.dofs, at.elements) };
    let sought = place(at.law, &labels(&at.dofs), at.elements, structure)?;
    let mut family = None;
    for (index, table) in file.candidates.iter().enumerate() {
        if table.law == at.law && members(table, structure)?.iter().any(|member| member.place.is_same(&sought)) {
            family = Some(index);
            break;
        }
    }
    write_out(file, family.ok_or_else(absent)?, structure)?;
    drawn(file, at, structure)?.ok_or_else(absent)
}

fn drawn(file: &ProjectFile, at: &SourceAt, structure: &Structure) -> Result<Option<usize>, Refusal> {
    let sought = place(at.law, &labels(&at.dofs), at.elements, structure)?;
    for (index, table) in file.source.iter().enumerate() {
        let state_fits = at.state.is_none_or(|state| state == table.state);
        if table.law == at.law && state_fits && single(table, structure)?.place.is_same(&sought) {
            return Ok(Some(index));
        }
    }
    Ok(None)
}

/// Replaces a family by its members that are not drawn already.
fn write_out(file: &mut ProjectFile, family: usize, structure: &Structure) -> Result<(), Refusal> {
    let drawn: Vec<Source> = file.source.iter().map(|table| single(table, structure)).collect::<Result<_, _>>()?;
    let table = file.candidates.remove(family);
    for member in members(&table, structure)? {
        if !drawn.iter().any(|other| is_sought(other.state) && other.is_same(&member)) {
            file.source.push(written(&member, &table.parameters, structure));
        }
    }
    Ok(())
}

fn written(source: &Source, parameters: &BTreeMap<String, f64>, structure: &Structure) -> SourceTable {
    let dofs = match &source.place {
        Place::Dofs(dofs) => dofs.iter().map(|&dof| Label(structure.label(dof).to_owned())).collect(),
        Place::Whole(_) | Place::Channel(_) => Vec::new(),
    };
    let elements = match source.place {
        Place::Whole(Some([first, last])) => Some([first as i64 + 1, last as i64 + 1]),
        _ => None,
    };
    SourceTable { law: source.effect, dofs, elements, state: source.state, parameters: parameters.clone() }
}

/// The effect that is ruled out, or why it cannot act there.
pub(super) fn ruled_out(table: &RuledOutTable, structure: &Structure) -> Result<Source, Refusal> {
    table.source(structure).map_err(|problem| Refusal::NoSuchPlace { law: table.law, reason: problem.to_string() })
}

/// Labels as the file has them.
pub(super) fn labels(dofs: &[String]) -> Vec<Label> {
    dofs.iter().cloned().map(Label).collect()
}

fn place_words(dofs: &[Label], elements: Option<[i64; 2]>) -> String {
    let dofs: Vec<String> = dofs.iter().map(|label| label.0.clone()).collect();
    words(&dofs, elements)
}

fn words(dofs: &[String], elements: Option<[i64; 2]>) -> String {
    match (dofs, elements) {
        ([], Some([first, last])) => format!("elements {first} to {last}"),
        ([], None) => "the whole structure".into(),
        ([one], _) => format!("DOF {one} to the ground"),
        (many, _) => format!("DOFs {}", many.join(", ")),
    }
}
