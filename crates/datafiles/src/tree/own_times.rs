//! Times that every channel has for itself, as DEWESoft exports them to MATLAB: `Data1_Force` and `Data1_time_Force`.

use super::abscissa::Abscissa;
use super::{Array, Arrays, Entry, MOST_CHECKED, Node};
use crate::axis::{ascending, even_step};
use crate::contents::Kind;
use crate::error::Read;

/// The times of each entry of a group.
pub(super) struct OwnTimes(Vec<Option<Abscissa>>);

impl OwnTimes {
    /// Vectors called as another with the word `time` among its parts, as long as it and ascending.
    pub(super) fn among(entries: &[Entry], arrays: &dyn Arrays) -> Read<Self> {
        let mut found: Vec<Option<Abscissa>> = vec![None; entries.len()];
        for (t, entry) in entries.iter().enumerate() {
            let Some((array, count)) = vector(entry) else { continue };
            let Some(name) = without_time(&entry.name) else { continue };
            let is_its = |other: &Entry| other.name == name && vector(other).is_some_and(|(_, own)| own == count);
            let Some(of) = entries.iter().position(is_its) else { continue };
            let step = if count <= MOST_CHECKED {
                let values = arrays.read(array.id)?.re;
                if !ascending(&values) {
                    continue;
                }
                even_step(&values)
            } else {
                array.step_of_peek(count)
            };
            let unit = "s".to_owned();
            found[of] = Some(Abscissa { entry: Some(t), id: array.id, count, step, kind: Kind::Time, unit });
        }
        Ok(Self(found))
    }

    /// The times of entry `i`.
    pub(super) fn of(&self, i: usize) -> Option<&Abscissa> {
        self.0[i].as_ref()
    }

    /// Whether entry `i` is the times of another.
    pub(super) fn is_time(&self, i: usize) -> bool {
        self.0.iter().flatten().any(|axis| axis.entry == Some(i))
    }
}

/// A real vector with its length.
fn vector(entry: &Entry) -> Option<(&Array, u64)> {
    let Node::Array(array) = &entry.node else { return None };
    let count = array.shape.len().filter(|&count| count > 1 && array.is_vector() && !array.complex)?;
    Some((array, count))
}

/// A name without its part `time`; none where it has no such part, or no other.
fn without_time(name: &str) -> Option<String> {
    let parts: Vec<&str> = name.split('_').collect();
    let at = parts.iter().position(|part| part.eq_ignore_ascii_case("time"))?;
    let others: Vec<&str> = parts.iter().enumerate().filter(|(i, _)| *i != at).map(|(_, part)| *part).collect();
    (!others.is_empty()).then(|| others.join("_"))
}

#[cfg(test)]
mod tests {
    use super::super::source::Flat;
    use super::super::{Shape, sets::sets};
    use super::*;

    /// Array 0 rises by 2 ms, array 1 by 1 ms, all others fall.
    struct Ramps;
    impl Arrays for Ramps {
        fn read(&self, id: usize) -> Read<Flat> {
            let slope = [2e-3, 1e-3].get(id).copied().unwrap_or(-1.0);
            Ok(Flat { re: (0..4).map(|k| slope * f64::from(k)).collect(), im: Vec::new() })
        }
    }

    #[test]
    fn every_channel_has_its_own_times_and_these_are_no_channels() {
        let array = |name: &str, id: usize| {
            let shape = Shape::new([4, 1], true);
            let peek = vec![[0.0, 0.0]; shape.wanted().len()];
            Entry::new(name, Node::Array(Array { id, shape, complex: false, peek }))
        };
        let entries = [
            array("Data1_Force", 2),
            array("Data1_time_Force", 0),
            array("Data1_Acc_P2", 3),
            array("Data1_time_Acc_P2", 1),
        ];
        let set = sets(&entries, &[], &Ramps).unwrap_or_default().0.remove(0);
        let told: Vec<_> = set.channels.iter().map(|channel| (channel.name.as_str(), channel.axis.step())).collect();
        assert_eq!(told, [("Data1_Force", Some(2e-3)), ("Data1_Acc_P2", Some(1e-3))]);
        assert_eq!((set.kind, set.axis_unit.as_str()), (Kind::Time, "s"));
    }
}
