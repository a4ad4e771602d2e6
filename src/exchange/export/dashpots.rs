//! Viscous sources as single dashpots: what finite-element programs call CDAMP2 or DASHPOT elements.

use super::identified::Identified;
use crate::effects::{Effect, Leg};
use crate::structure::{Direction, Structure, StructureKind};

/// A dashpot to the ground or between two DOFs, `c` in N s/m.
pub(super) struct Dashpot {
    pub leg: Leg,
    pub c: f64,
}

/// The dashpots of all viscous sources, and a sentence for every source that is none.
pub(super) fn dashpots(identified: &Identified, format: &str) -> (Vec<Dashpot>, Vec<String>) {
    let mut found = Vec::new();
    let mut warnings = Vec::new();
    for source in identified.sources.iter().map(|s| &s.source) {
        if source.effect.is_dashpot() {
            let c = source.coefficient();
            found.extend(source.place.legs().into_iter().map(|leg| Dashpot { leg, c }));
        } else {
            let title = source.title(identified.structure);
            warnings.push(format!("{title} is not viscous: {format} dashpots cannot hold it"));
        }
    }
    (found, warnings)
}

/// Unit of the coefficient of a law, `-` for a pure number.
pub(super) fn coefficient_unit(effect: Effect) -> &'static str {
    match effect.coefficient().map(|k| effect.parameters()[k].unit) {
        None | Some("") => "-",
        Some(unit) => unit,
    }
}

/// Grid point and component (1 to 6, 0 for a generalised coordinate) of a DOF: the node's own number where all nodes of an
/// imported structure have one, else its place in the list of nodes, from 1.
pub(super) fn grid_component(structure: &Structure, dof: usize) -> (usize, u8) {
    let number = |label: &str| label.parse::<usize>().ok().filter(|&id| id > 0);
    let is_numbered = structure.kind() == StructureKind::Matrices
        && structure.nodes().iter().all(|node| number(&node.label).is_some());
    let dof = &structure.dofs()[dof];
    let component = match dof.direction {
        Direction::X => 1,
        Direction::Y => 2,
        Direction::Z => 3,
        Direction::Rx => 4,
        Direction::Ry => 5,
        Direction::Rz => 6,
        Direction::Q => 0,
    };
    let own = number(&structure.nodes()[dof.node].label).filter(|_| is_numbered);
    (own.unwrap_or(dof.node + 1), component)
}
