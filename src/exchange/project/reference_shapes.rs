//! The modes and operating shapes of other programs that a project names, read from their files.

use super::error::{ProjectError, TableProblem};
use super::file::ProjectFile;
use super::lines::At;
use crate::classical::reference_shapes::ReferenceShape;
use crate::exchange::frf::read_shapes;
use crate::structure::Structure;
use std::collections::BTreeMap;
use std::path::Path;

/// The modes and operating shapes of other programs, read from their files in `folder`.
///
/// # Errors
/// [`ProjectError`] at the table whose file is missing or wrong.
pub(crate) fn reference_shapes(
    file: &ProjectFile,
    structure: &Structure,
    folder: &Path,
    at: At<'_>,
) -> Result<Vec<ReferenceShape>, ProjectError> {
    let wrong = |k: usize, problem| at.error("[[modes]]", k, "", problem);
    if let Some(k) = file.modes.iter().position(|table| !folder.join(&table.file).is_file()) {
        return Err(wrong(k, TableProblem::NoRecord { file: file.modes[k].file.clone() }));
    }
    let responses = file.frf.iter().flat_map(|table| &table.dofs);
    let of_responses: BTreeMap<String, String> =
        responses.map(|(name, label)| (name.clone(), label.0.clone())).collect();
    let mut shapes = Vec::new();
    for (k, table) in file.modes.iter().enumerate() {
        let mut dofs = of_responses.clone();
        dofs.extend(table.dofs.iter().map(|(name, label)| (name.clone(), label.0.clone())));
        let read = read_shapes(&folder.join(&table.file), &table.file, &dofs, structure);
        shapes.extend(read.map_err(|error| wrong(k, TableProblem::Frf(Box::new(error))))?);
    }
    Ok(shapes)
}
