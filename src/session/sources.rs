//! Sources of a project file on its structure: found by law and place, families written out where one member changes.

use super::command::SourceAt;
use super::refusal::Refusal;
use crate::effects::Source;
use crate::exchange::project::file::{ProjectFile, SourceTable};
use crate::exchange::project::label::Label;
use crate::exchange::project::ruled_out::RuledOutTable;
use crate::exchange::project::sources::{at_place, members, single};
use crate::structure::Structure;
use std::collections::BTreeMap;

/// Index of a source in the file. A member of a family is not there: its family is first written out one by one.
pub(super) fn find(file: &mut ProjectFile, at: &SourceAt, structure: &Structure) -> Result<usize, Refusal> {
    if let Some(index) = drawn(file, at, structure)? {
        return Ok(index);
    }
    let sought = at_place(at.law, &labels(&at.dofs), at.elements, structure)?;
    let absent = || Refusal::NoSuchSource { source_name: Source::candidate(at.law, sought.clone()).phrase(structure) };
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
    let sought = at_place(at.law, &labels(&at.dofs), at.elements, structure)?;
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
        if !drawn.iter().any(|other| other.state.is_sought() && other.is_same(&member)) {
            file.source.push(written(&member, &table.parameters, structure));
        }
    }
    Ok(())
}

fn written(source: &Source, parameters: &BTreeMap<String, f64>, structure: &Structure) -> SourceTable {
    let SourceAt { law, dofs, elements, .. } = SourceAt::of(source, structure);
    SourceTable { law, dofs: labels(&dofs), elements, state: source.state, parameters: parameters.clone() }
}

/// The effect that is ruled out, or why it cannot act there.
pub(super) fn ruled_out(table: &RuledOutTable, structure: &Structure) -> Result<Source, Refusal> {
    table.source(structure).map_err(|problem| Refusal::NoSuchPlace { law: table.law, reason: problem.to_string() })
}

/// Labels as the file has them.
pub(super) fn labels(dofs: &[String]) -> Vec<Label> {
    dofs.iter().cloned().map(Label).collect()
}
