//! The modes and operating shapes of other programs that a project names, read from their files.

use super::error::{Problem, ProjectError};
use super::file::ProjectFile;
use super::lines::Lines;
use crate::classical::reference_shapes::ReferenceShape;
use crate::exchange::frf::{FrfError, read_shapes};
use crate::structure::Structure;
use std::collections::BTreeMap;
use std::path::Path;

impl ProjectFile {
    /// The modes and operating shapes of other programs, read from their files in `folder`.
    ///
    /// # Errors
    /// The number of the table and what is wrong with its file.
    pub fn reference_shapes(
        &self,
        structure: &Structure,
        folder: &Path,
    ) -> Result<Vec<ReferenceShape>, (usize, FrfError)> {
        let responses = self.frf.iter().flat_map(|table| &table.dofs);
        let of_responses: BTreeMap<String, String> =
            responses.map(|(name, label)| (name.clone(), label.0.clone())).collect();
        let mut shapes = Vec::new();
        for (i, table) in self.modes.iter().enumerate() {
            let mut dofs = of_responses.clone();
            dofs.extend(table.dofs.iter().map(|(name, label)| (name.clone(), label.0.clone())));
            let read = read_shapes(&folder.join(&table.file), &table.file, &dofs, structure);
            shapes.extend(read.map_err(|error| (i, error))?);
        }
        Ok(shapes)
    }
}

/// The shapes with the problem at the line of their table.
pub(super) fn shapes(
    file: &ProjectFile,
    lines: &Lines,
    structure: &Structure,
    path: &Path,
) -> Result<Vec<ReferenceShape>, ProjectError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let missing = file.modes.iter().position(|table| !folder.join(&table.file).is_file());
    if let Some(i) = missing {
        let problem = Problem::NoRecord { file: file.modes[i].file.clone() };
        return Err(ProjectError::new(&path.display().to_string(), lines.modes.get(i).copied(), problem));
    }
    file.reference_shapes(structure, folder).map_err(|(i, error)| {
        let line = lines.modes.get(i).copied();
        ProjectError::new(&path.display().to_string(), line, Problem::Frf(Box::new(error)))
    })
}
