//! Abaqus input: `DASHPOT1` to the ground and `DASHPOT2` between nodes, one element set a dashpot.

use super::dashpots::{Dashpot, dashpots, grid_component};
use super::files::Export;
use super::identified::Identified;
use std::fmt::Write;
use std::path::Path;

/// First element number of the dashpots, above those of common models.
const FIRST_ID: usize = 900_001;

pub(super) fn export(identified: &Identified, path: &Path) -> Export {
    let (dashpots, warnings) = dashpots(identified, "Abaqus");
    let mut text = format!("** {}\n** Viscous damping, N s/m. Nodes and degrees of freedom\n", identified.title);
    for (row, dof) in identified.structure.dofs().iter().enumerate() {
        let (node, direction) = grid_component(identified.structure, row);
        let _ = writeln!(text, "** DOF {} is node {node} degree of freedom {direction}", dof.label);
    }
    for warning in &warnings {
        let _ = writeln!(text, "** {warning}");
    }
    for (index, dashpot) in dashpots.iter().enumerate() {
        text.push_str(&element(identified, index, dashpot));
    }
    let mut export = Export { warnings, ..Export::default() };
    export.add(path.to_owned(), text);
    export
}

/// One dashpot in an element set of its own.
fn element(identified: &Identified, index: usize, dashpot: &Dashpot) -> String {
    let (id, set) = (FIRST_ID + index, format!("DASHPOT-{}", index + 1));
    let (node, direction) = grid_component(identified.structure, dashpot.leg.first);
    let (kind, nodes, directions) = match dashpot.leg.second.map(|dof| grid_component(identified.structure, dof)) {
        None => ("DASHPOT1", format!("{node}"), format!("{direction}")),
        Some((other, along)) => ("DASHPOT2", format!("{node}, {other}"), format!("{direction}, {along}")),
    };
    format!(
        "*ELEMENT, TYPE={kind}, ELSET={set}\n{id}, {nodes}\n*DASHPOT, ELSET={set}\n{directions}\n{}\n",
        real(dashpot.c)
    )
}

/// A number that Abaqus reads as real: it has a point or an exponent.
fn real(value: f64) -> String {
    format!("{value:?}")
}
