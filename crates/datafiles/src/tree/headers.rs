//! Arrays that have their name, unit and sampling rate in a struct beside them, such as `Channel_1_Data` and `Channel_1_Header`
//! in exports of catman.

use super::names::{sampling, text_at};
use super::{Entry, Node};
use std::borrow::Cow;

/// Ends of the names of the structs.
const STRUCTS: [&str; 5] = ["_header", "_info", "_properties", "_props", "_meta"];
/// Ends of the names of the arrays that they describe.
const ARRAYS: [&str; 4] = ["_data", "_values", "_signal", ""];
/// Fields of the structs with names of channels, and with units.
pub(super) const NAMES: [&str; 12] = [
    "SignalName",
    "ChannelName",
    "Name",
    "name",
    "Label",
    "label",
    "signalname",
    "channel_name",
    "channelName",
    "channelname",
    "Channel",
    "channel",
];
const UNITS: [&str; 6] = ["Unit", "unit", "Units", "units", "PhysicalUnit", "YUnit"];

/// The entries of a group, described arrays under their own names and with units and sampling rates as attributes.
pub(super) fn with_headers(entries: &[Entry]) -> Cow<'_, [Entry]> {
    let header = |entry: &Entry| described(entry, entries);
    if !entries.iter().any(|entry| header(entry).is_some()) {
        return Cow::Borrowed(entries);
    }
    let named = |entry: &Entry| {
        let Some(fields) = header(entry) else { return entry.clone() };
        let text = |words: &[&str]| words.iter().find_map(|word| text_at(fields, &[word])).map(str::trim);
        let mut entry = entry.clone();
        if let Some(name) = text(&NAMES).filter(|name| !name.is_empty()) {
            name.clone_into(&mut entry.name);
        }
        entry.attributes.extend(text(&UNITS).map(|unit| ("unit".to_owned(), unit.to_owned())));
        let scalar = |field: &Entry| match &field.node {
            Node::Array(array) => array.scalar(),
            Node::Text(texts) => texts.first()?.trim().parse().ok(),
            _ => None,
        };
        let stated = fields.iter().filter_map(|field| Some((field.name.clone(), scalar(field)?)));
        let stated = stated.filter(|(name, value)| sampling(name, *value).is_some());
        entry.attributes.extend(stated.map(|(name, value)| (name, value.to_string())));
        entry
    };
    Cow::Owned(entries.iter().map(named).collect())
}

/// The fields of the struct beside an array that describes it.
fn described<'a>(entry: &Entry, entries: &'a [Entry]) -> Option<&'a [Entry]> {
    let Node::Array(_) = entry.node else { return None };
    let name = entry.name.to_lowercase();
    let stem = ARRAYS.iter().find_map(|end| name.strip_suffix(end))?;
    entries.iter().find_map(|other| match &other.node {
        Node::Group(fields) => {
            let own = STRUCTS.iter().any(|end| other.name.to_lowercase().strip_suffix(end) == Some(stem));
            own.then_some(fields.as_slice())
        }
        _ => None,
    })
}
