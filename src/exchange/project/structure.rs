//! Builds the structure of a project, its matrices read from their files.

use super::correction::corrected;
use super::error::{ProjectError, TableProblem};
use super::file::{MatricesTable, Shape, StructureTable};
use super::lines::At;
use super::model;
use crate::exchange::matrices::{read_dofs, read_lines, read_matrix, read_nodes};
use crate::structure::imported::ImportedParameters;
use crate::structure::points::PointParameters;
use crate::structure::{Structure, StructureError};
use std::path::Path;

const STRUCTURE: &str = "[structure]";
const LUMPED_MASS: &str = "[[structure.lumped_mass]]";

/// The structure; `folder` is that of the project.
///
/// `named` are the DOF labels that the rest of the project uses; a reduced structure keeps them.
///
/// # Errors
/// [`ProjectError`] at the key or the table that is wrong, also where a file of its matrices cannot be read.
pub(crate) fn structure(
    table: &StructureTable,
    folder: &Path,
    named: &[String],
    at: At<'_>,
) -> Result<Structure, ProjectError> {
    let lumped = &table.lumped_mass;
    let of_structure = |error: StructureError| TableProblem::Structure(Box::new(error));
    let built = match &table.shape {
        Shape::Beam(parameters) => parameters.build(lumped).map_err(of_structure),
        Shape::Chain(parameters) => parameters.build(lumped).map_err(of_structure),
        Shape::Matrices(files) if model::is_needed(files, folder) => model::structure(files, folder, lumped, named),
        Shape::Matrices(files) => {
            imported(files, folder).and_then(|parameters| parameters.build(lumped).map_err(of_structure))
        }
        Shape::Points(_) | Shape::Component(_) if !lumped.is_empty() => {
            return Err(at.error(LUMPED_MASS, 0, "", TableProblem::MassOnPoints));
        }
        Shape::Points(points) => {
            let dofs = points.dofs.iter().map(|label| label.0.clone()).collect();
            PointParameters { dofs, positions: points.positions.clone() }.build().map_err(of_structure)
        }
        Shape::Component(parameters) => parameters.build().map_err(of_structure),
    };
    let built = built.map_err(|problem| located(problem, table, at))?;
    corrected(built, &table.correction).map_err(|(k, problem)| at.error("[[structure.correction]]", k, "", problem))
}

fn imported(files: &MatricesTable, folder: &Path) -> Result<ImportedParameters, TableProblem> {
    let beside = |name: &String| folder.join(name);
    let optional = |name: &Option<String>| name.as_ref().map(beside);
    Ok(ImportedParameters {
        mass: read_matrix(&beside(&files.mass)).map_err(TableProblem::Table)?,
        stiffness: read_matrix(&beside(&files.stiffness)).map_err(TableProblem::Table)?,
        nodes: optional(&files.nodes).map(|path| read_nodes(&path)).transpose().map_err(TableProblem::Table)?,
        dofs: optional(&files.dofs).map(|path| read_dofs(&path)).transpose().map_err(TableProblem::Table)?,
        lines: optional(&files.lines)
            .map(|path| read_lines(&path))
            .transpose()
            .map_err(TableProblem::Table)?
            .unwrap_or_default(),
    })
}

/// The problem at the key that it is about, as far as it says so.
fn located(problem: TableProblem, table: &StructureTable, at: At<'_>) -> ProjectError {
    let TableProblem::Structure(error) = &problem else { return at.error(STRUCTURE, 0, "", problem) };
    if let StructureError::UnknownDof { label, .. } = &**error
        && let Some(k) = table.lumped_mass.iter().position(|mass| mass.dof == *label)
    {
        return at.error(LUMPED_MASS, k, "", problem);
    }
    if matches!(**error, StructureError::DuplicateDof { .. } | StructureError::EmptyLabel) {
        return at.error(STRUCTURE, 0, "dofs", problem);
    }
    let said = error.to_string();
    // Messages begin with the key, or with its singular and a number: "mass 2 is ..." is about `masses`.
    let word = said.split(' ').next().unwrap_or_default();
    let plural = format!("{word}es");
    let key = if at.lines.of(STRUCTURE, 0, &plural) == at.lines.of(STRUCTURE, 0, "") { word } else { &plural };
    at.error(STRUCTURE, 0, key, problem)
}
