//! A structure from the files of a finite-element program, whole or reduced.

use super::error::TableProblem;
use super::file::MatricesTable;
use super::reduce::ReduceTable;
use crate::exchange::matrices::model::{Model, ModelFiles, full, is_model, read_model};
use crate::structure::imported::{ImportedDof, ImportedParameters};
use crate::structure::reduction::{Reduction, ReductionMethod, Wanted, reduce};
use crate::structure::{Direction, LumpedMass, MOST_DOFS, Node, Structure, StructureError};
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// Whether the table needs more than plain matrices.
pub(super) fn is_needed(files: &MatricesTable, folder: &Path) -> bool {
    files.reduce.is_some() || [&files.mass, &files.stiffness].into_iter().any(|name| is_model(&folder.join(name)))
}

/// Reads the files, reduces the model where that is asked, and builds the structure. `named` are the labels that the project
/// uses beside those of its lumped masses: those among the model's are kept.
pub(super) fn structure(
    files: &MatricesTable,
    folder: &Path,
    lumped: &[LumpedMass],
    named: &[String],
) -> Result<Structure, TableProblem> {
    let beside = |name: &String| folder.join(name);
    let (mass, stiffness) = (beside(&files.mass), beside(&files.stiffness));
    let [nodes, dofs, lines] = [&files.nodes, &files.dofs, &files.lines].map(|name| name.as_ref().map(beside));
    let mut model = read_model(ModelFiles {
        matrices: [&mass, &stiffness],
        names: [files.mass_name.as_deref(), files.stiffness_name.as_deref()],
        nodes: nodes.as_deref(),
        dofs: dofs.as_deref(),
        lines: lines.as_deref(),
    })
    .map_err(TableProblem::Table)?;
    let (mut notes, turned) = (std::mem::take(&mut model.notes), std::mem::take(&mut model.turned));
    let wrong = |error: StructureError| TableProblem::Structure(Box::new(error));
    let (parameters, reduction) = match &files.reduce {
        None => (whole(model).map_err(wrong)?, None),
        Some(table) => {
            let loaded = lumped.iter().map(|mass| mass.dof.as_str());
            let kept: Vec<&str> = named.iter().map(String::as_str).chain(loaded).collect();
            let (parameters, reduction) = reduced(model, table, &kept).map_err(wrong)?;
            (parameters, Some(reduction))
        }
    };
    let parameters = with_all_nodes(parameters, &mut notes);
    let mut structure = parameters.build(lumped).map_err(wrong)?;
    structure.set_origin(notes, turned, reduction, lumped);
    Ok(structure)
}

/// Nodes of degrees of freedom that no file gives a position, such as CalculiX's of incompatible modes, at the origin.
fn with_all_nodes(mut parameters: ImportedParameters, notes: &mut Vec<String>) -> ImportedParameters {
    let (Some(nodes), Some(dofs)) = (&mut parameters.nodes, &parameters.dofs) else { return parameters };
    let mut known: HashSet<String> = nodes.iter().map(|node| node.label.clone()).collect();
    let before = nodes.len();
    for dof in dofs {
        if known.insert(dof.node.clone()) {
            nodes.push(Node { label: dof.node.clone(), position: [0.0; 3] });
        }
    }
    let missing = nodes.len() - before;
    if missing > 0 {
        notes.push(format!("{missing} nodes of the matrices have no position in the files and are put at the origin"));
    }
    parameters
}

fn whole(model: Model) -> Result<ImportedParameters, StructureError> {
    let degrees = model.system.mass.size();
    if degrees > MOST_DOFS {
        return Err(StructureError::TooLarge { degrees, limit: MOST_DOFS });
    }
    let [mass, stiffness] = [full(&model.system.mass), full(&model.system.stiffness)];
    Ok(ImportedParameters { mass, stiffness, nodes: model.nodes, dofs: model.dofs, lines: model.lines })
}

fn reduced(
    model: Model,
    table: &ReduceTable,
    named: &[&str],
) -> Result<(ImportedParameters, Reduction), StructureError> {
    let n = model.system.mass.size();
    let numbered =
        |row: usize| ImportedDof { label: (row + 1).to_string(), node: (row + 1).to_string(), direction: Direction::Z };
    let dofs = model.dofs.unwrap_or_else(|| (0..n).map(numbered).collect());
    if dofs.len() != n {
        let (what, hint) = ("the table of DOFs", " (one a matrix row)");
        return Err(StructureError::Count { what, found: dofs.len(), expected: n, hint });
    }
    let rows: HashMap<&str, usize> = dofs.iter().enumerate().map(|(row, dof)| (dof.label.as_str(), row)).collect();
    let mut kept = Vec::new();
    for label in &table.dofs {
        let near = || crate::structure::nearest(&label.0, dofs.iter().map(|dof| dof.label.as_str()));
        let unknown = || StructureError::UnknownDof { label: label.0.clone(), near: near() };
        kept.push(*rows.get(label.0.as_str()).ok_or_else(unknown)?);
    }
    kept.extend(named.iter().filter_map(|label| rows.get(label).copied()));
    kept.sort_unstable();
    kept.dedup();
    let method = ReductionMethod::from_name(&table.method).unwrap_or(ReductionMethod::CraigBampton);
    let band_hz = table.band_hz.unwrap_or(0.5 * table.up_to_hz);
    let wanted = Wanted { method, up_to_hz: table.up_to_hz, band_hz, error: table.error.unwrap_or(USUAL_ERROR) };
    let directions: Vec<Direction> = dofs.iter().map(|dof| dof.direction).collect();
    let (matrices, reduction) = reduce(&model.system, &directions, &kept, wanted)?;
    let mut own: Vec<ImportedDof> = kept.iter().map(|&row| dofs[row].clone()).collect();
    // An amplitude of a mode belongs to no node; it is listed at the first that is kept.
    let node = own.first().map_or_else(String::new, |dof| dof.node.clone());
    let mode = |k: usize| ImportedDof { label: format!("mode{}", k + 1), node: node.clone(), direction: Direction::Q };
    own.extend((0..reduction.fixed_interface_modes).map(mode));
    let parameters = ImportedParameters {
        mass: matrices.mass,
        stiffness: matrices.stiffness,
        nodes: model.nodes,
        dofs: Some(own),
        lines: model.lines,
    };
    Ok((parameters, reduction))
}

/// Largest relative error of the frequencies in the band unless the project says another.
const USUAL_ERROR: f64 = 1e-3;
