//! DOFs of a Universal File in a structure.

use crate::exchange::records::known_labels;
use crate::structure::{Direction, Structure};
use std::collections::BTreeMap;

/// A DOF of the structure and the sign of the file's direction in it.
pub(super) type Place = (usize, f64);

/// Finds the DOF of the structure for one of the file.
///
/// In this order: what the project says under `dofs` (a label after `-` is reversed), the entity as a label, node and
/// direction of the structure.
pub(super) fn place(dof: &uff::Dof, named: &BTreeMap<String, String>, structure: &Structure) -> Result<Place, String> {
    let sign = if dof.direction < 0 { -1.0 } else { 1.0 };
    let [full, plain, positive] = keys(dof);
    for (name, sign) in [(&full, 1.0), (&plain, 1.0), (&positive, sign)] {
        let Some(label) = named.get(name) else { continue };
        let direct = structure.dof(label).map(|row| (row, sign));
        let reversed = || label.strip_prefix('-').and_then(|label| structure.dof(label)).map(|row| (row, -sign));
        return direct.or_else(reversed).ok_or_else(|| {
            format!("`\"{name}\" = \"{label}\"`: the structure has no such DOF; it has {}", known_labels(structure))
        });
    }
    let entity = Some(&dof.entity).filter(|entity| !entity.is_empty());
    if let Some(row) = entity.and_then(|entity| structure.dof(entity)) {
        return Ok((row, sign));
    }
    // A point without a direction is the DOF of that label.
    if let Some(row) = structure.dof(&dof.node.to_string()).filter(|_| dof.direction == 0 && dof.node != 0) {
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

/// Names under which a project may say a DOF of the file: with its entity, without it, of its positive direction.
pub(super) fn keys(dof: &uff::Dof) -> [String; 3] {
    let plain = uff::Dof { entity: String::new(), ..dof.clone() };
    let positive = uff::Dof { direction: dof.direction.abs(), ..plain.clone() };
    [dof.to_string(), plain.to_string(), positive.to_string()]
}

/// Finds the DOF of the structure for a name such as `12:+Z`, `12z`, `-12z` or `acc@12z`.
pub(super) fn place_of_name(
    name: &str,
    named: &BTreeMap<String, String>,
    structure: &Structure,
) -> Result<Place, String> {
    let plain = name.split_once('@').map_or(name, |(_, label)| label).trim();
    let asked = named.get(name.trim()).or_else(|| named.get(plain)).map_or(plain, String::as_str);
    if let Some(row) = structure.dof(asked) {
        return Ok((row, 1.0));
    }
    if let Some(row) = asked.strip_prefix('-').and_then(|label| structure.dof(label)) {
        return Ok((row, -1.0));
    }
    if let Some(dof) = file_dof(asked) {
        return place(&dof, named, structure);
    }
    let short = plain_place(asked);
    if short != asked {
        return place_of_name(short, named, structure);
    }
    let known = known_labels(structure);
    Err(format!(
        "\"{asked}\" is no DOF of the structure, which has {known}; add `\"{plain}\" = LABEL` under [frf.dofs]"
    ))
}

/// The place at the end of a name: `12:+Z` of `FRF Plate:12:+Z`, `1` of `Point 1`; the whole name where it ends in none.
pub(crate) fn plain_place(name: &str) -> &str {
    let name = name.trim();
    let tail = name.trim_end_matches(['x', 'y', 'z', 'X', 'Y', 'Z', 'S']);
    let tail = if name.len() - tail.len() > 1 { name } else { tail };
    let axis = tail.trim_end_matches(['r', 'R']);
    let tail = if tail.len() - axis.len() == 1 && tail.len() < name.len() { axis } else { tail };
    let digits = tail.trim_end_matches(['+', '-', ':', '_', ' ']);
    let front = digits.trim_end_matches(|c: char| c.is_ascii_digit());
    if front.len() == digits.len() {
        return name;
    }
    // A sign in front of the whole name reverses.
    if front == "-" { name } else { &name[front.len()..] }
}

/// A DOF that is written as Universal Files write it: node, colon or none, sign, direction.
fn file_dof(text: &str) -> Option<uff::Dof> {
    let end = text.find(|c: char| !c.is_ascii_digit())?;
    let node = text[..end].parse().ok()?;
    let rest = text[end..].trim_start_matches([':', '_', ' ']);
    let (sign, axis) = match rest.chars().next()? {
        '-' => (-1, &rest[1..]),
        '+' => (1, &rest[1..]),
        _ => (1, rest),
    };
    let axes = ["x", "y", "z", "rx", "ry", "rz"];
    let direction = axes.iter().position(|known| axis.eq_ignore_ascii_case(known))? as i64 + 1;
    Some(uff::Dof { entity: String::new(), ..uff::Dof::new(node, sign * direction) })
}

/// Response and reference in the name of a channel: `12:+Z/1:+Z`, `acc@7/force@19`, `H_7z_19z`, `FRF(3,1)`.
pub(crate) fn pair_in_name(name: &str) -> Option<[String; 2]> {
    if let Some((response, reference)) = name.split_once('/')
        && [response, reference].iter().all(|side| side.chars().any(|c| c.is_ascii_digit()))
    {
        return Some([response.trim().to_owned(), reference.trim().to_owned()]);
    }
    // `2Z:8Z` of ME'scope: both sides are places with a direction.
    let last = name.split_whitespace().next_back().unwrap_or_default();
    if let Some((response, reference)) = last.split_once(':')
        && [response, reference].iter().all(|side| is_directed(side))
    {
        return Some([response.to_owned(), reference.to_owned()]);
    }
    let words = name.split(|c: char| !(c.is_alphanumeric() || c == '+' || c == '-' || c == ':'));
    let places: Vec<String> = words
        .map(|word| word.trim_start_matches(|c: char| !c.is_ascii_digit()))
        .filter(|word| !word.is_empty())
        .map(str::to_owned)
        .collect();
    <[String; 2]>::try_from(places).ok()
}

/// Whether a text is a number with the letter of an axis behind it, such as `2Z` or `2-Z`.
fn is_directed(text: &str) -> bool {
    let axis = text.trim_start_matches(|c: char| c.is_ascii_digit());
    axis.len() < text.len() && matches!(axis.trim_start_matches(['+', '-']), "X" | "Y" | "Z" | "x" | "y" | "z")
}

/// Response in a name that says no reference, such as `Point 3` or `Acc 12 +Z`: from its first digit on.
pub(crate) fn response_in_name(name: &str) -> Option<String> {
    let from = name.find(|c: char| c.is_ascii_digit())?;
    Some(name[from..].trim_end_matches(|c: char| !c.is_alphanumeric()).to_owned())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_out_of_names() {
        let pair = |name: &str| pair_in_name(name).map(|pair| pair.join(" "));
        assert_eq!(pair("12:+Z/1:-Z").as_deref(), Some("12:+Z 1:-Z"));
        assert_eq!(pair("acc@7/force@19").as_deref(), Some("acc@7 force@19"));
        assert_eq!(pair("1 2Z:8Z").as_deref(), Some("2Z 8Z"));
        assert_eq!(pair("12:+Z"), None);
        assert_eq!(pair("H_7z_19z").as_deref(), Some("7z 19z"));
        assert_eq!(pair("FRF(3,1)").as_deref(), Some("3 1"));
        assert_eq!((pair("H[1]"), pair("FRF")), (None, None));
    }

    #[test]
    fn places_at_the_end_of_names() {
        for (name, place) in [
            ("FRF Plate:12:+Z", "12:+Z"),
            ("Point 1", "1"),
            ("12z", "12z"),
            ("-12z", "-12z"),
            ("acc 7 rx", "7 rx"),
            ("left wing", "left wing"),
            ("7", "7"),
        ] {
            assert_eq!(plain_place(name), place);
        }
    }

    #[test]
    fn dofs_as_programs_write_them() {
        let dof = |text: &str| file_dof(text).map(|dof| (dof.node, dof.direction));
        assert_eq!((dof("12:+Z"), dof("12-Z"), dof("7rx")), (Some((12, 3)), Some((12, -3)), Some((7, 4))));
        assert_eq!((dof("12"), dof("z"), dof("12:S")), (None, None, None));
    }
}
