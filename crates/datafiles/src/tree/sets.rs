//! From a tree of named arrays to sets of channels.
//!
//! Arrays of one group are one set. A vector named as time or frequency is the abscissa of arrays as long as it; a scalar
//! such as `fs` or `dt` gives an even one, in its group and in those below. Square matrices are sets of their own. A group
//! of `x_values` and `y_values` is one signal (exports of Simcenter Testlab).

use super::abscissa::Abscissa;
use super::columns::{self, Columns, first, number};
use super::context::{Context, note};
use super::headers::with_headers;
use super::labels::{Labels, with_lists_above};
use super::names;
use super::own_times::OwnTimes;
use super::repeated::Repeated;
use super::source::Place;
use super::timeseries::name_data;
use super::{Array, Arrays, Entry, MOST_CHECKED, Node, Shape};
use crate::axis::{ascending, even_step, kind_of, unit_of_time, unit_since_1970};
use crate::contents::{Axis, Channel, FIRST, Kind, Set};
use crate::error::Read;
use crate::note::{Note, not_read};
use crate::units::is_unit;

/// Deepest groups that are looked into.
const DEEPEST: usize = 64;

/// Sets of a tree, and where their channels are.
pub(crate) fn sets(
    entries: &[Entry],
    attributes: &[(String, String)],
    arrays: &dyn Arrays,
) -> Read<(Vec<Set>, Vec<Vec<Place>>)> {
    let mut made = Made { arrays, sets: Vec::new(), places: Vec::new() };
    made.group(Group { path: "", entries, attributes }, Context::default(), None, 0)?;
    Ok((made.sets, made.places))
}

/// A group of a tree as it is read.
#[derive(Clone, Copy)]
struct Group<'a> {
    /// Names of the groups above and of its own.
    path: &'a str,
    entries: &'a [Entry],
    attributes: &'a [(String, String)],
}

struct Made<'a> {
    arrays: &'a dyn Arrays,
    sets: Vec<Set>,
    places: Vec<Vec<Place>>,
}

impl Made<'_> {
    /// Reads a group and those in it; `above` and `axis` are those of the group above.
    fn group(&mut self, group: Group<'_>, above: Context, axis: Option<&Abscissa>, depth: usize) -> Read<()> {
        let Group { path, attributes, .. } = group;
        if self.signal(path, group.entries) {
            return Ok(());
        }
        let entries = &with_headers(group.entries)[..];
        let context = above.within(entries, attributes);
        let own = self.abscissa(entries)?;
        let outer = axis.filter(|_| context == above);
        let handed = outer.filter(|axis| is_of(axis, entries));
        let axis = own.as_ref().or(handed);
        let labels = Labels::of(entries, attributes);
        self.set(Group { entries, ..group }, context, axis, &labels)?;
        let below = own.map(|axis| Abscissa { entry: None, ..axis });
        let below = below.as_ref().or(outer);
        for entry in entries {
            if let Node::Group(inner) = &entry.node
                && depth < DEEPEST
            {
                let name = if path.is_empty() { entry.name.clone() } else { format!("{path}/{}", entry.name) };
                let named = labels.named_cells(inner);
                let inner = named.as_deref().unwrap_or(inner);
                let handed = with_lists_above(&entry.attributes, attributes);
                let inner = Group { path: &name, entries: inner, attributes: &handed };
                self.group(inner, context, below, depth + 1)?;
            }
        }
        Ok(())
    }

    /// The arrays of a group as a set, square ones as sets of their own.
    fn set(&mut self, group: Group<'_>, context: Context, axis: Option<&Abscissa>, labels: &Labels) -> Read<()> {
        let Group { path, entries, attributes } = group;
        let mut set = Set::new(path, Kind::Table);
        let (mut places, times) = (Vec::new(), OwnTimes::among(entries, self.arrays)?);
        let over_time = axis.is_none_or(|axis| axis.kind == Kind::Time);
        let tests = Repeated::among(entries, axis.map(|axis| axis.count), labels).filter(|_| over_time);
        for (i, entry) in entries.iter().enumerate().filter(|(i, _)| !times.is_time(*i)) {
            match &entry.node {
                Node::Array(array) => {
                    if let Some(value) = array.scalar() {
                        note(&mut set, format!("{} = {value}", entry.name));
                    } else if array.shape.is_square() {
                        self.matrix(path, entry, array);
                    } else {
                        let axis = times.of(i).or(axis);
                        let is_axis = axis.is_some_and(|axis| axis.entry == Some(i));
                        if !is_axis && tests.as_ref().is_some_and(|tests| tests.takes(entry)) {
                            continue;
                        }
                        let (context, axis) = if is_axis { (Context::default(), None) } else { (context, axis) };
                        let columns = Columns::of(entry, array);
                        columns::add(&mut set, &mut places, &columns, context, axis, labels, None);
                    }
                }
                Node::Text(texts) => note(&mut set, format!("{}: {}", entry.name, texts.join(", "))),
                Node::Skipped(why) => note(&mut set, not_read(&entry.name, why)),
                Node::Group(_) => {}
            }
        }
        labels.one_each(&mut set);
        name_data(&mut set, path, entries, attributes);
        finish(&mut set, entries, attributes, axis);
        super::points::attach(&mut set, entries, attributes, self.arrays)?;
        for (name, value) in attributes {
            note(&mut set, format!("{name}: {value}"));
        }
        let Some(tests) = tests else {
            if !set.channels.is_empty() || entries.iter().any(|entry| matches!(entry.node, Node::Skipped(_))) {
                self.sets.push(set);
                self.places.push(places);
            }
            return Ok(());
        };
        // Nothing but the times lies beside the tests.
        let alone = set.channels.len() <= usize::from(axis.is_some_and(|axis| axis.entry.is_some()));
        let notes = if alone { std::mem::take(&mut set.notes) } else { Vec::new() };
        if !alone {
            self.sets.push(set);
            self.places.push(places);
        }
        self.tests(group, context, axis, labels, &tests, notes);
        Ok(())
    }

    /// Every test of arrays of three and more extents as a set; `notes` are those of the group.
    fn tests(
        &mut self,
        group: Group<'_>,
        context: Context,
        axis: Option<&Abscissa>,
        labels: &Labels,
        tests: &Repeated,
        mut notes: Vec<Note>,
    ) {
        let Group { path, entries, attributes } = group;
        let taken = entries
            .iter()
            .enumerate()
            .filter(|(i, entry)| tests.takes(entry) && axis.is_none_or(|axis| axis.entry != Some(*i)));
        let arrays: Vec<Columns<'_>> = taken
            .filter_map(|(_, entry)| match &entry.node {
                Node::Array(array) => Some(Columns::of(entry, array)),
                _ => None,
            })
            .collect();
        let column_major = arrays.first().is_some_and(|columns| columns.array.shape.column_major);
        notes.insert(0, tests.note.clone().into());
        for test in 0..tests.count() {
            let mut set = Set::new(tests.name(path, test, column_major), Kind::Table);
            set.notes = std::mem::take(&mut notes);
            let mut places = Vec::new();
            for columns in &arrays {
                let chosen = tests.channels(columns.array, test);
                let chosen = Some((tests.samples(), &chosen[..]));
                columns::add(&mut set, &mut places, columns, context, axis, labels, chosen);
            }
            finish(&mut set, entries, attributes, axis);
            self.sets.push(set);
            self.places.push(places);
        }
    }

    /// The vector that is the abscissa of a group.
    fn abscissa(&self, entries: &[Entry]) -> Read<Option<Abscissa>> {
        let named = |entry: &Entry| kind_of(&entry.name, names::unit_of(&entry.attributes).unwrap_or_default());
        let all = || entries.iter().enumerate();
        let indices = all().filter(|(_, entry)| is_index(entry)).map(|found| (found, Kind::Time));
        for ((i, entry), kind) in all().filter_map(|found| Some((found, named(found.1)?))).chain(indices) {
            let Node::Array(array) = &entry.node else { continue };
            let unit = names::unit_of(&entry.attributes).unwrap_or_default();
            let Some(count) = array.shape.len().filter(|&count| count > 1 && array.is_vector() && !array.complex)
            else {
                continue;
            };
            let long =
                |other: &Entry| matches!(&other.node, Node::Array(other) if other.shape.extents.contains(&count));
            if entries.iter().enumerate().all(|(j, other)| j == i || !within(other, &long, 0)) {
                continue;
            }
            let step = if count <= MOST_CHECKED {
                let values = self.arrays.read(array.id)?.re;
                if !ascending(&values) {
                    continue;
                }
                even_step(&values)
            } else {
                array.step_of_peek(count)
            };
            let counted = || array.peek.first().and_then(|value| unit_since_1970(value[0]));
            let unit = match (unit, kind) {
                ("", Kind::Time) => unit_of_time(&entry.name).or_else(counted).unwrap_or("s"),
                ("", _) if names::radians_beside(entries, &entry.name) => "rad/s",
                ("", _) => "Hz",
                (unit, _) => unit,
            };
            return Ok(Some(Abscissa { entry: Some(i), id: array.id, count, step, kind, unit: unit.to_owned() }));
        }
        Ok(None)
    }

    fn matrix(&mut self, path: &str, entry: &Entry, array: &Array) {
        let name = if path.is_empty() { entry.name.clone() } else { format!("{path}/{}", entry.name) };
        let mut set = Set::new(name, Kind::Matrix);
        let mut channel = Channel::new(
            entry.name.clone(),
            names::unit_of(&entry.attributes).unwrap_or_default(),
            array.shape.len().unwrap_or(0),
        );
        channel.complex = array.complex;
        channel.first =
            (0..FIRST as u64).filter_map(|i| array.at(i)).map(|value| number(value, array.complex)).collect();
        let extents: Vec<String> = array.shape.extents.iter().map(ToString::to_string).collect();
        let order = if array.shape.column_major { "columns" } else { "rows" };
        channel.attributes.push(("shape".to_owned(), extents.join(" x ")));
        channel.attributes.push(("order".to_owned(), order.to_owned()));
        set.channels.push(channel);
        let count = array.shape.len().unwrap_or(0);
        let cut = Shape { extents: vec![count], column_major: true }.cut(None);
        let Some(cut) = cut else { return };
        self.sets.push(set);
        self.places.push(vec![Place { id: array.id, cut, channel: 0, whole: true, axis: None }]);
    }

    /// A group of `x_values` and `y_values`, as Simcenter Testlab exports signals.
    fn signal(&mut self, path: &str, entries: &[Entry]) -> bool {
        let Some(array) = names::array_at(entries, &["y_values", "values"]) else { return false };
        let Some(step) = names::scalar_at(entries, &["x_values", "increment"]) else { return false };
        let start = names::scalar_at(entries, &["x_values", "start_value"]).unwrap_or(0.0);
        let x_unit = names::text_at(entries, &["x_values", "quantity", "label"]);
        // Complex values are over frequencies.
        let x_unit = x_unit.unwrap_or(if array.complex { "Hz" } else { "s" });
        let unit = names::text_at(entries, &["y_values", "quantity", "label"]).unwrap_or_default();
        let label = || names::text_at(entries, &["function_record", "primary_channel", "label"]);
        let name = names::text_at(entries, &["function_record", "name"]).or_else(label).unwrap_or(path);
        let names = names::texts_at(entries, &["function_record", "name"]).to_vec();
        let units = names::texts_at(entries, &["y_values", "quantity", "label"]).to_vec();
        let stated =
            names::scalar_at(entries, &["x_values", "number_of_values"]).filter(|n| *n >= 1.0).map(|n| n as u64);
        let Some(cut) = array.shape.cut(stated) else { return false };
        let frequency = kind_of("", x_unit) == Some(Kind::Spectrum);
        let kind = match (frequency, array.complex) {
            (true, true) => Kind::Frf,
            (true, false) => Kind::Spectrum,
            _ => Kind::Time,
        };
        let mut set = Set::new(path, kind);
        x_unit.clone_into(&mut set.axis_unit);
        let (mut places, wanted) = (Vec::new(), array.shape.wanted());
        for c in 0..cut.channels {
            let listed = |list: &[String]| list.get(c as usize).filter(|_| list.len() as u64 == cut.channels).cloned();
            let numbered = if cut.channels > 1 { format!("{name}[{}]", c + 1) } else { name.to_owned() };
            let label = listed(&names).unwrap_or(numbered);
            let mut channel = Channel::new(label, listed(&units).unwrap_or_else(|| unit.to_owned()), cut.count);
            channel.complex = array.complex;
            channel.axis = Axis::Even { start, step };
            channel.first = first(array, &wanted, &cut, c);
            if cut.channels == 1 {
                channel.attributes = sides(entries, array.complex);
            }
            set.channels.push(channel);
            places.push(Place { id: array.id, cut: cut.clone(), channel: c, whole: false, axis: None });
        }
        self.sets.push(set);
        self.places.push(places);
        true
    }
}

/// Where a signal was measured, by its `function_record`: the point of the response, and that of the reference of a function.
fn sides(entries: &[Entry], function: bool) -> Vec<(String, String)> {
    let side = |channel: &str| {
        let said = |word: &str| names::text_at(entries, &["function_record", channel, word]);
        let point =
            said("point_id").or_else(|| said("point")).filter(|point| point.contains(|c: char| c.is_ascii_digit()))?;
        Some(said("direction").map_or_else(|| point.to_owned(), |direction| format!("{point}:{direction}")))
    };
    let reference = || side("reference_channel").or_else(|| side("secondary_channel"));
    let sides = [("response", side("primary_channel")), ("reference", function.then(reference).flatten())];
    sides.into_iter().filter_map(|(word, place)| Some((word.to_owned(), place?))).collect()
}

/// Whether an entry or any below it is one that is looked for.
fn within(entry: &Entry, wanted: &impl Fn(&Entry) -> bool, depth: usize) -> bool {
    match &entry.node {
        Node::Group(inner) => depth < DEEPEST && inner.iter().any(|entry| within(entry, wanted, depth + 1)),
        _ => wanted(entry),
    }
}

/// Whether an array is the index of a table of pandas that counts no rows: times.
fn is_index(entry: &Entry) -> bool {
    let Node::Array(array) = &entry.node else { return false };
    let peek = |i: usize| array.peek.get(i).map(|value| value[0]);
    let counts = matches!((peek(0), peek(1)), (Some(first), Some(second)) if (first == 0.0 || first == 1.0) && second - first == 1.0);
    matches!(entry.name.as_str(), "index" | "axis1") && !counts
}

/// Whether an abscissa of a group above is as long as an array here.
fn is_of(axis: &Abscissa, entries: &[Entry]) -> bool {
    entries.iter().any(|entry| matches!(&entry.node, Node::Array(array) if array.shape.extents.contains(&axis.count)))
}

/// Kind, unit of the abscissa and what the group says of all its channels.
fn finish(set: &mut Set, entries: &[Entry], attributes: &[(String, String)], axis: Option<&Abscissa>) {
    if let [channel] = &mut set.channels[..] {
        names::add_missing(&mut channel.attributes, attributes);
        channel.attributes.extend(
            names::scale_beside(entries, &channel.first).map(|scale| ("scale beside".to_owned(), scale.to_string())),
        );
    }
    set.kind = kind(set, axis);
    set.axis_unit = match (&axis, set.kind) {
        (Some(axis), _) => axis.unit.clone(),
        (None, Kind::Time) => "s".to_owned(),
        _ => String::new(),
    };
    // A unit of the group is that of those of its arrays that say none.
    if let Some(unit) = names::unit_of(attributes).filter(|unit| is_unit(unit)) {
        let bare = set.channels.iter_mut().filter(|channel| channel.unit.is_empty());
        bare.filter(|channel| channel.axis != Axis::None).for_each(|channel| unit.clone_into(&mut channel.unit));
    }
}

fn kind(set: &Set, axis: Option<&Abscissa>) -> Kind {
    let complex = set.channels.iter().any(|channel| channel.complex);
    match axis.map(|axis| axis.kind) {
        Some(Kind::Spectrum) if complex => Kind::Frf,
        Some(kind) => kind,
        None if set.channels.iter().any(|channel| channel.axis != Axis::None) => Kind::Time,
        None => Kind::Table,
    }
}
