//! Numbers of measured points on a structure whose DOFs are numbered otherwise than its nodes, as those of a beam are.

use super::error::{ImportError, Result};
use crate::exchange::mapping::Proposal;
use crate::exchange::project::plan;
use crate::measurement::Quantity;
use crate::structure::{Structure, StructureKind};
use std::path::Path;

/// The proposal with its numbers placed on the structure of the project text `head`. They are labels of DOFs, unless one of
/// them would be a rotation or none: then they are nodes, and their translations are meant. Which, is said.
///
/// # Errors
/// What is wrong with the structure.
pub(super) fn placed(mut mapping: Proposal, head: &str, out: &Path) -> Result<Proposal> {
    let structure = plan(head, out).map_err(ImportError::Unwritten)?.structure;
    if structure.kind() != StructureKind::Beam {
        return Ok(mapping);
    }
    let numbered = |label: &String| !label.is_empty() && label.chars().all(|c| c.is_ascii_digit());
    let tables = mapping.channels.iter().filter(|table| table.quantity != Quantity::Base);
    let numbers: Vec<String> = tables.map(|table| table.dof.clone()).filter(numbered).collect();
    let is_translation =
        |label: &String| structure.dof(label).is_some_and(|row| !structure.dofs()[row].direction.is_rotation());
    let of_nodes = !numbers.iter().all(is_translation);
    if of_nodes && !numbers.iter().all(|number| translation(&structure, number).is_some()) {
        return Ok(mapping);
    }
    for table in mapping.channels.iter_mut().filter(|table| numbers.contains(&table.dof)) {
        let (old, number) = (table.channel(), table.dof.clone());
        let at_node = translation(&structure, &number);
        let how = match (of_nodes, at_node) {
            (true, Some(label)) => {
                table.dof.clone_from(&label);
                format!("{number} is taken for the node: {label} is its translation")
            }
            (false, Some(label)) if structure.dof(&label) != structure.dof(&number) => {
                format!("{number} is taken for the DOF of that label; the translation of node {number} is {label}")
            }
            _ => continue,
        };
        let name = table.channel();
        mapping
            .assumed
            .iter_mut()
            .filter(|(channel, _)| *channel == old)
            .for_each(|(channel, _)| channel.clone_from(&name));
        mapping.assumed.push((name, how));
    }
    Ok(mapping)
}

/// Name of the translation at the node of that number.
fn translation(structure: &Structure, node: &str) -> Option<String> {
    let name = |axis: &&&str| structure.dof(&format!("{node}{axis}")).is_some();
    ["x", "y", "z"].iter().find(name).map(|axis| format!("{node}{axis}"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]
    use super::*;
    use crate::exchange::mapping::ChannelTable;

    const BEAM: &str = "[project]\nformat = 1\n[structure]\nkind = \"beam\"\nlength = 1\nbreadth = 0.1\ndepth = 0.01\n\
                        youngs_modulus = 7e10\ndensity = 2700\nelements = 4\nsupports = \"clamped-free\"\n";

    /// Places on the beam, and how many of them something is said of.
    fn at(labels: &[&str]) -> (Vec<String>, usize) {
        let table = |label: &&str| ChannelTable {
            name: format!("A{label}"),
            set: None,
            quantity: Quantity::Acceleration,
            dof: (*label).to_owned(),
            unit: None,
            sign: None,
            factor: None,
            delay: None,
            optional: false,
        };
        let mapping = Proposal { channels: labels.iter().map(table).collect(), ..Proposal::default() };
        let placed = placed(mapping, BEAM, Path::new("p.toml")).unwrap();
        (placed.channels.into_iter().map(|table| table.dof).collect(), placed.assumed.len())
    }

    #[test]
    fn numbers_are_nodes_where_they_cannot_be_translations() {
        let labels = |list: [&str; 2]| list.map(str::to_owned).to_vec();
        assert_eq!(at(&["3", "4"]), (labels(["3z", "4z"]), 2));
        // Labels, and that 3 is not node 3 is said.
        assert_eq!(at(&["3", "7"]), (labels(["3", "7"]), 1));
    }
}
