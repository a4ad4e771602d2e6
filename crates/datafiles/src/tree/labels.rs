//! Names and units that lie beside arrays: lists of names, units, properties of tables, outputs and inputs of system
//! identification.

use super::names;
use super::{Entry, Node};
use crate::contents::Set;
use crate::units::is_unit;

/// Names and units of columns that lie beside the array.
pub(super) struct Labels {
    pub names: Vec<String>,
    pub units: Vec<String>,
    pub unit_of: Vec<(String, String)>,
    /// All lists of texts, with their names.
    items: Vec<(String, Vec<String>)>,
    pub sides: Vec<Side>,
    /// Whether the names are those of the columns of several arrays.
    pub shared: bool,
}

/// An array of system identification with the names and units of its columns.
pub(super) type Side = (&'static str, Vec<String>, Vec<String>);

impl Labels {
    pub(super) fn of(entries: &[Entry], attributes: &[(String, String)]) -> Self {
        let texts = |entry: &Entry| match &entry.node {
            Node::Text(texts) => Some(texts.clone()),
            _ => None,
        };
        // Tables keep the names of their columns in a part of their own (`Properties`).
        let inner = entries.iter().filter_map(|entry| match &entry.node {
            Node::Group(inner) if entry.name.eq_ignore_ascii_case("properties") => Some(inner),
            _ => None,
        });
        let all: Vec<&Entry> = entries.iter().chain(inner.flatten()).collect();
        let find = |word: fn(&str) -> bool| {
            let beside = all.iter().filter(|entry| word(&entry.name)).find_map(|entry| texts(entry));
            beside.or_else(|| list_of(attributes, word)).unwrap_or_default()
        };
        let items = entries.iter().filter_map(|entry| Some((entry.name.clone(), texts(entry)?)));
        let named = |name: &str| entries.iter().find(|entry| entry.name.eq_ignore_ascii_case(name)).and_then(texts);
        // Data of system identification: outputs and inputs with names and units of their own.
        let sides = [("y", "output"), ("outputdata", "output"), ("u", "input"), ("inputdata", "input")];
        let sides = sides.into_iter().filter_map(|(array, side)| {
            let names = named(&format!("{side}Name"))?;
            Some((array, names, named(&format!("{side}Unit")).unwrap_or_default()))
        });
        let sides: Vec<Side> = sides.collect();
        let unit_of = entries.iter().filter_map(|entry| {
            let lower = entry.name.to_lowercase();
            let name = ["_units", "_unit"].iter().find_map(|end| lower.strip_suffix(end))?;
            Some((name.to_owned(), texts(entry)?.into_iter().next()?))
        });
        let names = find(names::is_names_word);
        let takes = |entry: &&Entry| match &entry.node {
            Node::Array(array) => !array.is_vector() && array.shape.extents.contains(&(names.len() as u64)),
            _ => false,
        };
        let shared = names.len() > 1 && entries.iter().filter(takes).count() > 1;
        let (unit_of, items) = (unit_of.collect(), items.collect());
        Self { names, units: find(names::is_unit_word), unit_of, items, sides, shared }
    }
}

/// What the name of a list has behind that of an array.
fn rest<'a>(list: &'a str, array: &str) -> Option<&'a str> {
    list.strip_prefix(array).map(|rest| rest.trim_start_matches('_')).filter(|rest| !rest.is_empty())
}

/// The list that an attribute gives under a word.
pub(super) fn list_of(attributes: &[(String, String)], word: fn(&str) -> bool) -> Option<Vec<String>> {
    let said = attributes.iter().find(|(name, value)| word(name) && value.contains(", "));
    said.map(|(_, value)| value.split(", ").map(str::to_owned).collect())
}

/// The attributes of a group with the lists of the group above, where it has none of its own.
pub(super) fn with_lists_above(own: &[(String, String)], above: &[(String, String)]) -> Vec<(String, String)> {
    let mut all = own.to_vec();
    for word in [names::is_names_word, names::is_unit_word] {
        if list_of(own, word).is_none() {
            all.extend(above.iter().find(|(name, value)| word(name) && value.contains(", ")).cloned());
        }
    }
    all
}

impl Labels {
    /// Names of the columns of one array, by the name of the list: `xLabels` beside `x`; pandas has `block0_items` beside `block0_values`.
    pub(super) fn items_of(&self, array: &str) -> Option<&Vec<String>> {
        let of_pandas = || array.strip_suffix("_values").map(|stem| format!("{stem}_items"));
        let named = |list: &str| {
            rest(list, array).is_some_and(names::is_names_word) || of_pandas().is_some_and(|of| of == list)
        };
        self.items.iter().find(|(list, _)| named(list)).map(|(_, texts)| texts)
    }

    /// Units of the columns of one array, by the name of the list: `xUnits` beside `x`.
    pub(super) fn item_units_of(&self, array: &str) -> Option<&Vec<String>> {
        let named = |list: &str| rest(list, array).is_some_and(names::is_unit_word);
        self.items.iter().find(|(list, _)| named(list)).map(|(_, texts)| texts)
    }

    /// Units of which there is one a channel, where no channel has one of its own: that of the times, where they begin with one,
    /// is passed over.
    pub(super) fn one_each(&self, set: &mut Set) {
        let is_time = |unit: &String| matches!(unit.trim(), "s" | "sec" | "ms");
        let units = match &self.units[..] {
            [first, rest @ ..] if is_time(first) && rest.len() == set.channels.len() => rest,
            units => units,
        };
        let bare = set.channels.iter().all(|channel| channel.unit.is_empty());
        if units.len() < 2 || units.len() != set.channels.len() || !bare {
            return;
        }
        for (channel, unit) in set.channels.iter_mut().zip(units).filter(|(_, unit)| is_unit(unit.trim())) {
            unit.trim().clone_into(&mut channel.unit);
        }
    }

    /// The arrays of a cell under the names that lie beside it, one each.
    pub(super) fn named_cells(&self, cells: &[Entry]) -> Option<Vec<Entry>> {
        let numbered = |entry: &Entry| entry.name.starts_with('{') && matches!(entry.node, Node::Array(_));
        if cells.is_empty() || cells.len() != self.names.len() || !cells.iter().all(numbered) {
            return None;
        }
        let named_entry = |(i, entry): (usize, &Entry)| {
            let unit = self.units.get(i).filter(|_| self.units.len() == cells.len());
            let unit = unit.map(|unit| ("unit".to_owned(), unit.clone()));
            let attributes = entry.attributes.iter().cloned().chain(unit).collect();
            Entry { name: self.names[i].clone(), node: entry.node.clone(), attributes }
        };
        Some(cells.iter().enumerate().map(named_entry).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::super::sets::sets;
    use super::super::source::{Arrays, Flat};
    use super::super::{Array, Shape};
    use super::*;
    use crate::error::Read;

    struct Zeros;
    impl Arrays for Zeros {
        fn read(&self, _: usize) -> Read<Flat> {
            unreachable!("no abscissa is looked for")
        }
    }

    /// Every channel an array of its own, their units in one list.
    #[test]
    fn units_of_a_list_are_those_of_the_channels_in_their_order() {
        let array = |(id, name): (usize, &&str)| {
            let shape = Shape::new([5], true);
            Entry::new(*name, Node::Array(Array { id, shape, complex: false, peek: vec![[0.0; 2]; 4] }))
        };
        let units_with = |units: &[&str]| -> Vec<String> {
            let mut entries: Vec<Entry> = ["Force_P7", "Acc_P7", "Acc_P9"].iter().enumerate().map(array).collect();
            entries.push(Entry::new("units", Node::Text(units.iter().map(|&unit| unit.to_owned()).collect())));
            let (found, _) = sets(&entries, &[], &Zeros).unwrap_or_default();
            found.iter().flat_map(|set| &set.channels).map(|c| c.unit.clone()).collect()
        };
        assert_eq!(units_with(&["N", "g ", "g"]), ["N", "g", "g"]);
        assert_eq!(units_with(&["s", "N", "g", "g"]), ["N", "g", "g"]);
        assert_eq!(units_with(&["N", "g"]), ["", "", ""], "whose they are is not known");
    }

    /// Levels and phases of the same points: the names of the points are told apart by those of the arrays.
    #[test]
    fn names_of_several_arrays_are_told_apart() {
        let array = |name: &str, id: usize| {
            let shape = Shape::new([5, 2], true);
            Entry::new(name, Node::Array(Array { id, shape, complex: false, peek: vec![[0.0; 2]; 7] }))
        };
        let text =
            |name: &str, texts: &[&str]| Entry::new(name, Node::Text(texts.iter().map(|&t| t.to_owned()).collect()));
        let names = || text("channel_names", &["Acc 1z", "Acc 2z"]);
        let labelled = |entries: &[Entry]| -> Vec<String> {
            let (found, _) = sets(entries, &[], &Zeros).unwrap_or_default();
            found.iter().flat_map(|set| &set.channels).map(|c| format!("{} [{}]", c.name, c.unit)).collect()
        };
        let two = [array("H_dB", 0), array("H_phase_deg", 1), names(), text("unit", &["g/N"])];
        assert_eq!(
            labelled(&two),
            ["H_dB Acc 1z [dB re g/N]", "H_dB Acc 2z [dB re g/N]", "H_phase_deg Acc 1z []", "H_phase_deg Acc 2z []"]
        );
        assert_eq!(labelled(&[array("data", 0), names()]), ["Acc 1z []", "Acc 2z []"]);
    }
}
