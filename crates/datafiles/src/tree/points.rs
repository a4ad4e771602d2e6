//! Where functions were measured, by what lies beside their array: lists of points or DOFs such as `resp_dof = [2 3 5]`, a
//! number such as `reference_node = 8`, attributes of a group such as `reference`.

use super::{Array, Arrays, Entry, Node, Shape};
use crate::contents::Set;
use crate::error::Read;

/// Most points of a list.
const MOST: u64 = 4096;

/// Sides of a function, as channels name them.
const SIDES: [&str; 2] = ["response", "reference"];

/// The side that a word names.
fn side_of(word: &str) -> Option<&'static str> {
    let plain: String = word.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_lowercase();
    let stem = [
        "nodes", "node", "dofs", "dof", "points", "point", "ids", "id", "names", "name", "labels", "label", "channels",
    ]
    .iter()
    .find_map(|end| plain.strip_suffix(end))
    .unwrap_or(&plain);
    match stem {
        "response" | "responses" | "resp" | "rsp" | "output" | "outputs" | "out" => Some(SIDES[0]),
        "reference" | "references" | "ref" | "excitation" | "exc" | "drive" | "driving" | "hammer" | "input"
        | "inputs" | "in" => Some(SIDES[1]),
        _ => None,
    }
}

/// Says of the functions of a set where they were measured. What cannot be theirs is noted.
pub(super) fn attach(
    set: &mut Set,
    entries: &[Entry],
    attributes: &[(String, String)],
    arrays: &dyn Arrays,
) -> Read<()> {
    let functions: Vec<usize> = (0..set.channels.len()).filter(|&c| set.channels[c].complex).collect();
    if functions.is_empty() {
        return Ok(());
    }
    for channel in &mut set.channels {
        let own: Vec<(String, String)> = channel.attributes.iter().chain(attributes).cloned().collect();
        for (word, value) in own {
            let new = |side: &&str| channel.complex && channel.attribute(side).is_none();
            if let Some(side) = side_of(&word).filter(new).filter(|_| value.contains(|c: char| c.is_ascii_digit())) {
                channel.attributes.push((side.to_owned(), value));
            }
        }
    }
    let mut lists: [Option<Vec<String>>; 2] = [None, None];
    for entry in entries {
        if let Some(side) = side_of(&entry.name)
            && let Some(list) = list(&entry.node, arrays)?
        {
            lists[usize::from(side == SIDES[1])] = Some(list);
        }
    }
    let shape = entries.iter().find_map(|entry| match &entry.node {
        Node::Array(array) if array.complex => Some(&array.shape),
        _ => None,
    });
    for (s, side) in SIDES.into_iter().enumerate() {
        let Some(list) = &lists[s] else { continue };
        let other = lists[1 - s].as_ref().map_or(1, Vec::len);
        let Some(place) = order(shape, list.len(), other, functions.len(), s == 0) else {
            let many = functions.len();
            set.notes.push(
                format!("the {} {}s beside its {many} functions are not theirs one by one", list.len(), side).into(),
            );
            continue;
        };
        for (k, &c) in functions.iter().enumerate() {
            if set.channels[c].attribute(side).is_none() {
                set.channels[c].attributes.push((side.to_owned(), list[place(k)].clone()));
            }
        }
    }
    Ok(())
}

/// Which of `own` points function `k` of `count` has, beside `other` points of the other side.
fn order(
    shape: Option<&Shape>,
    own: usize,
    other: usize,
    count: usize,
    is_response: bool,
) -> Option<Box<dyn Fn(usize) -> usize>> {
    if own == 1 {
        return Some(Box::new(|_| 0));
    }
    if own == count {
        return Some(Box::new(|k| k));
    }
    if own * other != count {
        return None;
    }
    // Of an array over both, the first index runs fastest where columns lie together, else the last; responses come first.
    let shape = shape?;
    let points: Vec<u64> = shape.extents.iter().copied().filter(|&n| n == own as u64 || n == other as u64).collect();
    let (responses, references) = if is_response { (own, other) } else { (other, own) };
    let responses_first = points.as_slice() == [responses as u64, references as u64];
    if !responses_first && points.as_slice() != [references as u64, responses as u64] {
        return None;
    }
    let first = is_response == responses_first;
    Some(if first == shape.column_major { Box::new(move |k| k % own) } else { Box::new(move |k| k / other) })
}

/// The points of a list: whole numbers from 1 on, or texts with figures.
fn list(node: &Node, arrays: &dyn Arrays) -> Read<Option<Vec<String>>> {
    match node {
        Node::Text(texts) if texts.iter().all(|text| text.contains(|c: char| c.is_ascii_digit())) => {
            Ok(Some(texts.clone()))
        }
        Node::Array(array) if array.scalar().is_some() => Ok(whole(&[array.scalar().unwrap_or(0.0)])),
        Node::Array(array) if is_list(array) => Ok(whole(&arrays.read(array.id)?.re)),
        _ => Ok(None),
    }
}

fn is_list(array: &Array) -> bool {
    !array.complex && array.is_vector() && array.shape.len().is_some_and(|count| count <= MOST)
}

fn whole(values: &[f64]) -> Option<Vec<String>> {
    let number = |value: &f64| value.fract() == 0.0 && *value >= 1.0 && *value < 1e9;
    values.iter().all(number).then(|| values.iter().map(|value| format!("{value}")).collect())
}

#[cfg(test)]
mod tests {
    use super::super::source::Flat;
    use super::*;

    struct Numbers;
    impl Arrays for Numbers {
        fn read(&self, id: usize) -> Read<Flat> {
            let re = match id {
                0 => vec![0.0, 0.5, 1.0, 1.5, 2.0],
                points => [2.0, 3.0, 5.0, 6.0][..points].to_vec(),
            };
            Ok(Flat { re, im: Vec::new() })
        }
    }

    /// `H`, `f`, `resp_dof = [2 3 5]` and `ref_dof = 8`: every function says where it was measured; a list of another length is
    /// noted and not used.
    #[test]
    fn points_beside_an_array_are_those_of_its_functions() {
        let array = |name: &str, id: usize, extents: [u64; 2], complex: bool| {
            let shape = Shape::new(extents, true);
            let peek = vec![[8.0, 0.0]; shape.wanted().len()];
            Entry::new(name, Node::Array(Array { id, shape, complex, peek }))
        };
        let found = |points: u64| {
            let entries = [
                array("f", 0, [5, 1], false),
                array("H", 9, [5, 3], true),
                array("resp_dof", points as usize, [points, 1], false),
                array("ref_dof", 9, [1, 1], false),
            ];
            super::super::sets::sets(&entries, &[], &Numbers).unwrap_or_default().0.remove(0)
        };
        let set = found(3);
        let pairs: Vec<_> = (set.channels.iter().filter(|channel| channel.complex))
            .map(|channel| (channel.attribute("response"), channel.attribute("reference")))
            .collect();
        assert_eq!(pairs, [(Some("2"), Some("8")), (Some("3"), Some("8")), (Some("5"), Some("8"))]);
        let set = found(4);
        assert!(set.notes.iter().any(|note| note.text.contains("responses beside its 3 functions")), "{:?}", set.notes);
        assert!(set.channels.iter().all(|channel| channel.attribute("response").is_none()));
    }

    #[test]
    fn words_of_programs_name_the_sides() {
        for word in ["resp_dof", "response_nodes", "Response", "outputs", "out_nodes", "rsp_node", "out_names"] {
            assert_eq!(side_of(word), Some("response"), "{word}");
        }
        for word in
            ["ref_dof", "reference_node", "reference", "Reference DOF", "excitation_point", "in_nodes", "inputs"]
        {
            assert_eq!(side_of(word), Some("reference"), "{word}");
        }
        assert_eq!((side_of("H"), side_of("coh"), side_of("freq"), side_of("nodes")), (None, None, None, None));
    }

    /// Which points the six functions of three responses and two references have, by index calculation in the array.
    #[test]
    fn points_of_an_array_over_both_sides() {
        for column_major in [true, false] {
            for extents in [[100_u64, 3, 2], [3, 2, 100], [3, 100, 2], [2, 3, 100]] {
                let shape = Shape::new(extents, column_major);
                let (Some(a), Some(b)) = (order(Some(&shape), 3, 2, 6, true), order(Some(&shape), 2, 3, 6, false))
                else {
                    unreachable!("both sides fill the array")
                };
                let Some(cut) = shape.cut(Some(100)) else { unreachable!("six channels") };
                for k in 0..6 {
                    // Indices of the first value of the channel.
                    let mut rest = cut.offset(k as u64);
                    let mut index = [0; 3];
                    let mut axes: Vec<usize> = (0..3).collect();
                    if !column_major {
                        axes.reverse();
                    }
                    for axis in axes {
                        (index[axis], rest) = ((rest % extents[axis]) as usize, rest / extents[axis]);
                    }
                    let along = |extent: u64| extents.iter().position(|&n| n == extent).map(|axis| index[axis]);
                    assert_eq!((Some(a(k)), Some(b(k))), (along(3), along(2)), "{extents:?} {column_major} {k}");
                }
            }
        }
    }
}
