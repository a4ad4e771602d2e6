//! The DOF labels that a project uses beside its structure: those of its sensors, exciters and sources, in the order of the file.
//! A reduced structure keeps them.

use super::file::{ProjectFile, Shape};
use super::frf::FrfTable;
use super::label::Label;
use crate::exchange::frf::labels_in;
use crate::exchange::records::places::contents;
use crate::measurement::channel::{ChannelName, parse_name};
use crate::structure::{Direction, Structure};
use std::path::Path;

/// All labels, also those that turn out to name nothing; a record that cannot be read is passed over, as its reader says
/// what is wrong with it.
pub(super) fn labels(file: &ProjectFile, folder: &Path) -> Vec<String> {
    if !matches!(&file.structure.shape, Shape::Matrices(files) if files.reduce.is_some()) {
        return Vec::new();
    }
    let mut labels: Vec<String> = Vec::new();
    let sources = file.source.iter().flat_map(|source| &source.dofs);
    labels.extend(sources.chain(file.ruled_out.iter().flat_map(|effect| &effect.dofs)).map(|label| label.0.clone()));
    labels.extend(file.run.iter().filter_map(|run| run.force_dof.as_ref()).map(|label| label.0.clone()));
    labels.extend(file.simulate.channels.iter().filter_map(|text| Some(ChannelName::parse(text).ok()?.label)));
    labels.extend(file.sensor.iter().filter_map(|sensor| Some(parse_name(&sensor.channel).ok()?.1)));
    labels.extend(file.channel.iter().map(|channel| channel.dof.clone()));
    labels.extend(file.frf.iter().flat_map(|table| of_responses(table, folder)));
    let records = file.run.iter().map(|run| &run.file).chain(file.harmonics.iter().map(|table| &table.file));
    for name in records {
        if let Ok((_, points)) = contents(&folder.join(name)) {
            labels.extend(points.dofs().iter().map(|dof| dof.label.clone()));
        }
    }
    labels
}

/// Labels that a table of frequency responses and its file name.
fn of_responses(table: &FrfTable, folder: &Path) -> Vec<String> {
    let named = table.dofs.values().chain(&table.responses).chain(&table.references);
    let named = named.flat_map(|label| [label.0.clone(), label.0.trim_start_matches('-').to_owned()]);
    named.chain(labels_in(&folder.join(&table.file))).collect()
}

/// Notes in the project which DOFs were kept, so that what is built anew from its structure alone is the same.
pub(super) fn write_down(file: &mut ProjectFile, structure: &Structure) {
    if let Shape::Matrices(files) = &mut file.structure.shape
        && let Some(reduce) = &mut files.reduce
    {
        let kept =
            structure.dofs().iter().filter(|dof| dof.direction != Direction::Q || !dof.label.starts_with("mode"));
        reduce.dofs = kept.map(|dof| Label(dof.label.clone())).collect();
    }
}
