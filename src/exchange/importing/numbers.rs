//! Measured points on a structure that calls its DOFs otherwise: a beam, whose DOFs are numbered otherwise than its nodes, and
//! structures that move in one direction only, which may be another than that of the sensors' axes.

use super::error::{ImportError, Result};
use crate::exchange::mapping::{DIRECTION_ASSUMED, Proposal};
use crate::exchange::project::plan;
use crate::measurement::Quantity;
use crate::measurement::base::AXES;
use crate::structure::{Structure, StructureKind};
use std::collections::BTreeMap;
use std::path::Path;

/// The labels of DOFs that places named with a direction, such as `4z`, stand for where every node of the structure has one
/// translation and all of them lie along one axis, as in a chain: the axes of the sensors then need not be those of the model.
/// Empty where the places are named in several directions, where the structure has one of them as it is named, or where a
/// node is not there.
pub(super) fn along_the_only_axis<'a>(
    structure: &Structure,
    places: impl IntoIterator<Item = &'a String>,
) -> BTreeMap<String, String> {
    let (Some(at_nodes), mut found, mut axes) = (only_translations(structure), BTreeMap::new(), Vec::new()) else {
        return BTreeMap::new();
    };
    for place in places {
        let digits = place.find(|c: char| !c.is_ascii_digit()).unwrap_or(place.len());
        let (node, axis) = place.split_at(digits);
        if !matches!(axis, "x" | "y" | "z") {
            continue;
        }
        let (None, Some(label)) = (structure.dof(place), at_nodes.get(node)) else { return BTreeMap::new() };
        found.insert(place.clone(), (*label).to_owned());
        axes.push(axis);
    }
    if axes.windows(2).any(|two| two[0] != two[1]) { BTreeMap::new() } else { found }
}

/// The label of the translation of each node, where every node has one and all lie along one axis.
fn only_translations(structure: &Structure) -> Option<BTreeMap<&str, &str>> {
    let translations = || structure.dofs().iter().filter(|dof| dof.direction.axis().is_some());
    let first = translations().next()?.direction;
    let at_nodes: BTreeMap<&str, &str> =
        translations().map(|dof| (structure.nodes()[dof.node].label.as_str(), dof.label.as_str())).collect();
    let one_each = at_nodes.len() == translations().count();
    (one_each && translations().all(|dof| dof.direction == first)).then_some(at_nodes)
}

/// How a place along the only axis is said.
pub(super) fn said_of_axis(place: &str, label: &str) -> String {
    format!("the model moves in one direction only: {place} is taken for its DOF {label}")
}

/// The proposal with its numbers placed on the structure of the project text `head`. They are labels of DOFs, unless one of
/// them would be a rotation or none: then they are nodes, and their translations are meant. Which, is said.
///
/// # Errors
/// What is wrong with the structure.
pub(super) fn placed(mut mapping: Proposal, head: &str, out: &Path) -> Result<Proposal> {
    let structure = plan(head, out).map_err(ImportError::Unwritten)?.structure;
    let tables = || mapping.channels.iter().filter(|table| table.quantity != Quantity::Base);
    let only = along_the_only_axis(&structure, tables().map(|table| &table.dof));
    for (place, label) in only {
        relabel(&mut mapping, &place, &label, &said_of_axis(&place, &label));
    }
    let tables = mapping.channels.iter().filter(|table| table.quantity != Quantity::Base);
    let numbers: Vec<String> = tables.map(|table| table.dof.clone()).collect();
    for taken in of_numbers(&structure, &numbers) {
        relabel(&mut mapping, &taken.number, &taken.label, &taken.how);
    }
    base_along_the_only_axis(&mut mapping, &structure);
    Ok(mapping)
}

/// A base that moves along an axis of which the structure has no DOF moves along the only one that it has, which is said.
fn base_along_the_only_axis(mapping: &mut Proposal, structure: &Structure) {
    let mut axes: Vec<usize> = structure.dofs().iter().filter_map(|dof| dof.direction.axis()).collect();
    axes.sort_unstable();
    axes.dedup();
    let [only] = axes[..] else { return };
    let label = AXES[only];
    for table in mapping.channels.iter_mut().filter(|table| table.quantity == Quantity::Base && table.dof != label) {
        let old = table.channel();
        label.clone_into(&mut table.dof);
        let name = table.channel();
        mapping.assumed.retain(|(channel, what)| *channel != old || !what.ends_with(DIRECTION_ASSUMED));
        mapping
            .assumed
            .iter_mut()
            .filter(|(channel, _)| *channel == old)
            .for_each(|(channel, _)| channel.clone_from(&name));
        mapping.assumed.push((name, format!("the model moves along {label} only: so does its base")));
    }
}

/// What a number among places is taken for on a beam.
pub(super) struct Taken {
    pub number: String,
    /// Label of the DOF.
    pub label: String,
    /// How that is said.
    pub how: String,
}

/// What the numbers among places are taken for on a beam, where that is to be said: labels of DOFs, unless one of them would
/// be a rotation or none: then they are nodes, and their translations are meant.
pub(super) fn of_numbers(structure: &Structure, places: &[String]) -> Vec<Taken> {
    if structure.kind() != StructureKind::Beam {
        return Vec::new();
    }
    let numbered = |label: &&String| !label.is_empty() && label.chars().all(|c| c.is_ascii_digit());
    let mut numbers: Vec<String> = places.iter().filter(numbered).cloned().collect();
    numbers.sort();
    numbers.dedup();
    let is_translation =
        |label: &String| structure.dof(label).is_some_and(|row| !structure.dofs()[row].direction.is_rotation());
    let of_nodes = !numbers.iter().all(is_translation);
    if of_nodes && !numbers.iter().all(|number| translation(structure, number).is_some()) {
        return Vec::new();
    }
    let taken = |number: String| match (of_nodes, translation(structure, &number)) {
        (true, Some(label)) => {
            let how = format!("{number} is taken for the node: {label} is its translation");
            Some(Taken { number, label, how })
        }
        (false, Some(label)) if structure.dof(&label) != structure.dof(&number) => {
            let how =
                format!("{number} is taken for the DOF of that label; the translation of node {number} is {label}");
            Some(Taken { label: number.clone(), number, how })
        }
        _ => None,
    };
    numbers.into_iter().filter_map(taken).collect()
}

/// The channels at a place moved to the DOF `label`, and how that is said of each.
fn relabel(mapping: &mut Proposal, place: &str, label: &str, how: &str) {
    for table in mapping.channels.iter_mut().filter(|table| table.dof == place && table.quantity != Quantity::Base) {
        let old = table.channel();
        label.clone_into(&mut table.dof);
        let name = table.channel();
        let said = mapping.assumed.iter_mut().filter(|(channel, _)| *channel == old);
        said.for_each(|(channel, _)| channel.clone_from(&name));
        mapping.assumed.push((name, how.to_owned()));
    }
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

    /// The places of sensors along z lie on a chain, whose DOFs lie along x; several directions, or nodes that are not there,
    /// are left as they are, and a beam's own names too.
    #[test]
    fn sensors_along_another_axis_lie_on_the_dofs_of_a_chain() {
        let chain = "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [1, 1, 1]\n\
                     ground_stiffness = [1, 0, 0]\ncoupling_stiffness = [1, 1]\n";
        let structure = |text: &str| plan(text, Path::new("p.toml")).unwrap().structure;
        let found = |text: &str, places: &[&str]| {
            let places: Vec<String> = places.iter().map(|place| (*place).to_owned()).collect();
            let pairs = along_the_only_axis(&structure(text), &places).into_iter();
            pairs.map(|(place, label)| format!("{place} {label}")).collect::<Vec<_>>().join(", ")
        };
        assert_eq!(found(chain, &["1z", "3z", "3z", "2"]), "1z 1, 3z 3");
        assert_eq!(found(chain, &["1z", "3y"]), "");
        assert_eq!(found(chain, &["1z", "4z"]), "");
        assert_eq!(found(chain, &["1z", "2x"]), "");
        assert_eq!(found(BEAM, &["2y", "4y"]), "2y 3, 4y 7");
        assert_eq!(found(BEAM, &["2z", "4z"]), "");
    }

    /// A table whose direction no name says shakes a chain along its own axis.
    #[test]
    fn the_base_of_a_chain_moves_along_its_only_axis() {
        let chain = "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [1, 1]\n\
                     ground_stiffness = [1, 0]\ncoupling_stiffness = [1]\n";
        let table = ChannelTable {
            name: "Table acc".to_owned(),
            set: None,
            quantity: Quantity::Base,
            dof: "z".to_owned(),
            unit: None,
            sign: None,
            factor: None,
            delay: None,
            optional: false,
        };
        let said = ("base@z".to_owned(), format!("the file says no direction: z{DIRECTION_ASSUMED}"));
        let proposal = Proposal { channels: vec![table], assumed: vec![said], ..Proposal::default() };
        let placed = |head: &str| placed(proposal.clone(), head, Path::new("p.toml")).unwrap();
        let found = placed(chain);
        assert_eq!(found.channels[0].dof, "x");
        assert_eq!(found.assumed, [("base@x".to_owned(), "the model moves along x only: so does its base".to_owned())]);
    }

    #[test]
    fn numbers_are_nodes_where_they_cannot_be_translations() {
        let labels = |list: [&str; 2]| list.map(str::to_owned).to_vec();
        assert_eq!(at(&["3", "4"]), (labels(["3z", "4z"]), 2));
        // Labels, and that 3 is not node 3 is said.
        assert_eq!(at(&["3", "7"]), (labels(["3", "7"]), 1));
    }
}
