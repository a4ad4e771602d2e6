//! DOFs of a Universal File in a structure.

use crate::structure::{Direction, Structure};
use std::collections::BTreeMap;

/// A DOF of the structure and the sign of the file's direction in it.
pub(super) type Place = (usize, f64);

/// Finds the DOF of the structure for one of the file.
///
/// In this order: what the project says under `dofs` (a label after `-` is reversed), the entity as a label, node and
/// direction of the structure.
pub(super) fn place(dof: &uff::Dof, named: &BTreeMap<String, String>, structure: &Structure) -> Result<Place, String> {
    let positive = uff::Dof { entity: String::new(), direction: dof.direction.abs(), ..dof.clone() };
    let sign = if dof.direction < 0 { -1.0 } else { 1.0 };
    let plain = uff::Dof { entity: String::new(), ..dof.clone() };
    let asked = [(dof.to_string(), 1.0), (plain.to_string(), 1.0), (positive.to_string(), sign)];
    for (name, sign) in asked {
        let Some(label) = named.get(&name) else { continue };
        let direct = structure.dof(label).map(|row| (row, sign));
        let reversed = || label.strip_prefix('-').and_then(|label| structure.dof(label)).map(|row| (row, -sign));
        return direct
            .or_else(reversed)
            .ok_or_else(|| format!("`\"{name}\" = \"{label}\"`: the structure has no such DOF"));
    }
    let entity = Some(&dof.entity).filter(|entity| !entity.is_empty());
    if let Some(row) = entity.and_then(|entity| structure.dof(entity)) {
        return Ok((row, sign));
    }
    let at_node = direction(dof.direction).and_then(|direction| {
        let node = dof.node.to_string();
        let here = |d: &crate::structure::Dof| d.direction == direction && structure.nodes()[d.node].label == node;
        structure.dofs().iter().position(here)
    });
    at_node.map(|row| (row, sign)).ok_or_else(|| {
        format!("the file's DOF \"{positive}\" is not in the structure; add `\"{positive}\" = LABEL` under [frf.dofs]")
    })
}

/// Direction of a number of the file, whatever its sign.
fn direction(number: i64) -> Option<Direction> {
    let all = [Direction::X, Direction::Y, Direction::Z, Direction::Rx, Direction::Ry, Direction::Rz];
    usize::try_from(number.abs()).ok()?.checked_sub(1).and_then(|i| all.get(i).copied())
}

/// Number of a direction in the file.
pub(super) fn number(direction: Direction) -> i64 {
    direction as i64 + 1
}
