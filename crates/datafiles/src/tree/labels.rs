//! Names and units that lie beside arrays: lists of names, units, properties of tables, outputs and inputs of system
//! identification.

use super::names;
use super::{Entry, Node};

/// Names and units of columns that lie beside the array.
pub(super) struct Labels {
    pub names: Vec<String>,
    pub units: Vec<String>,
    pub unit_of: Vec<(String, String)>,
    pub sides: Vec<Side>,
}

/// An array of system identification with the names and units of its columns.
pub(super) type Side = (&'static str, Vec<String>, Vec<String>);

impl Labels {
    pub(super) fn of(entries: &[Entry]) -> Self {
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
            all.iter().filter(|entry| word(&entry.name)).find_map(|entry| texts(entry)).unwrap_or_default()
        };
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
        Self { names: find(names::is_names_word), units: find(names::is_unit_word), unit_of: unit_of.collect(), sides }
    }
}

impl Labels {
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
