//! Channels out of an array: their names, units and abscissae by what the array, its group and the lists beside it say.

use super::abscissa::Abscissa;
use super::context::{Context, note};
use super::labels::{self, Labels};
use super::names;
use super::source::Place;
use super::timeseries::is_plain;
use super::{Array, Cut, Entry};
use crate::axis::kind_of;
use crate::contents::{Axis, Channel, FIRST, Number, Set};
use crate::note::not_read;
use crate::parts::unit_of_part;
use crate::units::suffix;

/// An array whose columns become channels.
pub(super) struct Columns<'a> {
    pub entry: &'a Entry,
    pub array: &'a Array,
    /// Places of the values that were kept of it, ascending.
    wanted: Vec<u64>,
}

impl<'a> Columns<'a> {
    pub(super) fn of(entry: &'a Entry, array: &'a Array) -> Self {
        Self { entry, array, wanted: array.shape.wanted() }
    }
}

/// The first values of a channel, out of those at the places `wanted` that were kept.
pub(super) fn first(array: &Array, wanted: &[u64], cut: &Cut, channel: u64) -> Vec<Number> {
    let places = (0..cut.count.min(FIRST as u64)).map(|i| cut.offset(channel) + i * cut.stride);
    let kept = |place| wanted.binary_search(&place).ok().and_then(|at| array.peek.get(at).copied());
    places.filter_map(kept).map(|value| number(value, array.complex)).collect()
}

/// Whether a name is a direction alone.
fn is_direction(name: &str) -> bool {
    matches!(name.trim_start_matches(['+', '-']), "x" | "y" | "z" | "X" | "Y" | "Z")
}

/// A number of an array.
pub(super) fn number(value: [f64; 2], complex: bool) -> Number {
    if complex { Number::Complex(value) } else { Number::Real(value[0]) }
}

/// Adds the channels of an array to a set: all of them, or those of `chosen` (number of samples, channels as
/// [`super::Shape::cut`] counts them).
pub(super) fn add(
    set: &mut Set,
    places: &mut Vec<Place>,
    columns: &Columns<'_>,
    context: Context,
    axis: Option<&Abscissa>,
    labels: &Labels,
    chosen: Option<(u64, &[u64])>,
) {
    let Columns { entry, array, .. } = *columns;
    let axis = axis.filter(|axis| array.shape.extents.contains(&axis.count));
    let Some(cut) = array.shape.cut(chosen.map(|(samples, _)| samples).or(axis.map(|axis| axis.count))) else {
        note(set, not_read(&entry.name, "it would make too many channels; save it in pieces"));
        return;
    };
    let mut own = context;
    for (name, value) in &entry.attributes {
        own.take(value.parse().ok().and_then(|value| names::sampling(name, value)));
    }
    let beside =
        labels.unit_of.iter().find(|(name, _)| *name == entry.name.to_lowercase()).map(|(_, unit)| unit.as_str());
    let side = labels.sides.iter().find(|(array, ..)| entry.name.eq_ignore_ascii_case(array));
    let list_of = |word: fn(&str) -> bool| labels::list_of(&entry.attributes, word).unwrap_or_default();
    let (items, item_units) = (labels.items_of(&entry.name), labels.item_units_of(&entry.name));
    let (own_names, own_units) = (list_of(names::is_names_word), list_of(names::is_unit_word));
    let all: Vec<u64> = (0..cut.channels).collect();
    let chosen = chosen.map_or(&all[..], |(_, chosen)| chosen);
    let several = chosen.len() > 1;
    for (k, &c) in chosen.iter().enumerate() {
        let listed = |list: &Vec<String>| (list.len() == chosen.len()).then(|| list[k].clone());
        let numbered = if several { format!("{}[{}]", entry.name, k + 1) } else { entry.name.clone() };
        let beside_name = side.and_then(|(_, names, _)| listed(names));
        let name = beside_name.or_else(|| listed(&own_names).filter(|_| several));
        let item = || items.and_then(listed);
        let name = name.or_else(item).or_else(|| listed(&labels.names).filter(|_| several));
        // A place or a direction alone does not say what was measured there; the name of the array may.
        let place = |name: &String| {
            name.starts_with(|c: char| c.is_ascii_digit()) || is_direction(name) && !is_plain(&entry.name)
        };
        let told_apart = |name: &String| place(name) || labels.shared && labels.names.contains(name);
        let name = name.map(|name| if told_apart(&name) { format!("{} {name}", entry.name) } else { name });
        let name = name.unwrap_or(numbered);
        let single = names::unit_of(&entry.attributes).filter(|_| own_units.is_empty());
        let unit = single
            .map(str::to_owned)
            .or_else(|| listed(&own_units))
            .or_else(|| item_units.and_then(listed))
            .or_else(|| side.and_then(|(_, _, units)| listed(units)))
            .or_else(|| beside.map(str::to_owned))
            .or_else(|| suffix(&entry.name).filter(|_| !several).map(|(_, unit)| unit.to_owned()));
        // One unit beside functions is that of all of them.
        let of_all = || labels.units.first().filter(|_| array.complex && labels.units.len() == 1).cloned();
        let unit = unit
            .or_else(|| unit_of_part(&entry.name, &labels.units))
            .or_else(|| listed(&labels.units).filter(|_| kind_of(&entry.name, "").is_none()));
        let unit = unit.or_else(of_all).unwrap_or_default();
        let mut channel = Channel::new(name, unit, cut.count);
        channel.complex = array.complex;
        channel.attributes.clone_from(&entry.attributes);
        channel.axis = match (axis, own.step) {
            (Some(axis), _) => Axis::Stored { step: axis.step },
            (None, Some(step)) if cut.count > 1 => Axis::Even { start: own.start, step },
            _ => Axis::None,
        };
        channel.first = first(array, &columns.wanted, &cut, c);
        set.channels.push(channel);
        places.push(Place { id: array.id, cut: cut.clone(), channel: c, whole: false, axis: axis.map(|axis| axis.id) });
    }
}
