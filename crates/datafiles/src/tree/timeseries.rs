//! Groups that hold one signal: MATLAB's timeseries (`Time` and `Data` with their name and `DataInfo.Units` beside them),
//! elements of arrays of structs (`rec(1).name`, `rec(1).data`, `rec(1).node`).

use super::headers::NAMES;
use super::names::text_at;
use super::{Entry, Node};
use crate::axis::kind_of;
use crate::contents::Set;

/// Fields that say of the signal where it was measured and by which sensor.
const SAID: [&str; 9] = ["node", "point", "dof", "direction", "dir", "pointid", "nodeid", "sensitivity", "axis"];

/// Whether the name of an array says nothing of what is in it.
pub(crate) fn is_plain(name: &str) -> bool {
    let plain = ["data", "value", "values", "signal", "samples", "untitled", "y", "ydata", "y_data", "waveform"];
    plain.contains(&name.trim().to_lowercase().as_str())
}

/// Gives the one array of a group its name, its unit and its place: those that the group says; an array `Data` without a name
/// is called as the group itself.
pub(super) fn name_data(set: &mut Set, path: &str, entries: &[Entry], attributes: &[(String, String)]) {
    let mut data = set.channels.iter_mut().filter(|channel| kind_of(&channel.name, &channel.unit).is_none());
    let (Some(channel), None) = (data.next(), data.next()) else { return };
    let own = path.rsplit('/').next().filter(|name| !name.is_empty());
    let element = own.is_some_and(|own| own.starts_with(['(', '{']));
    if !element && !is_plain(&channel.name) {
        return;
    }
    channel.attributes.extend(entries.iter().filter_map(said));
    let attribute = |word: &&str| attributes.iter().find(|(name, _)| name == word).map(|(_, value)| value.as_str());
    let mut stated = NAMES.iter().filter_map(|word| text_at(entries, &[word]).or_else(|| attribute(word)));
    let stated = stated.find(|name| !matches!(name.trim(), "" | "unnamed"));
    if let Some(name) = stated.or_else(|| own.filter(|_| channel.name.eq_ignore_ascii_case("data"))) {
        name.trim().clone_into(&mut channel.name);
    }
    if channel.unit.is_empty()
        && let Some(unit) = text_at(entries, &["DataInfo", "Units"])
    {
        unit.trim().clone_into(&mut channel.unit);
    }
}

/// A field that says where the signal was measured, as word and value.
fn said(field: &Entry) -> Option<(String, String)> {
    let plain: String = field.name.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_lowercase();
    let value = match &field.node {
        Node::Array(array) => array.scalar()?.to_string(),
        Node::Text(texts) => texts.first()?.clone(),
        _ => return None,
    };
    SAID.contains(&plain.as_str()).then_some((plain, value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contents::{Channel, Kind};
    use crate::tree::Node;

    fn entry(name: &str, node: Node) -> Entry {
        Entry { name: name.to_owned(), node, attributes: Vec::new() }
    }

    #[test]
    fn data_is_called_as_its_timeseries_and_has_its_unit() {
        let text = |name: &str, said: &str| entry(name, Node::Text(vec![said.to_owned()]));
        let info = entry("DataInfo", Node::Group(vec![text("Units", "m/s^2")]));
        let named = |path: &str, entries: &[Entry]| {
            let mut set = Set::new(path, Kind::Time);
            set.channels = ["Time", "Data"].map(|name| Channel::new(name.to_owned(), String::new(), 5)).into();
            name_data(&mut set, path, entries, &[]);
            (set.channels[1].name.clone(), set.channels[1].unit.clone())
        };
        assert_eq!(named("ts/acc", &[text("Name", "Acc 1"), info]), ("Acc 1".to_owned(), "m/s^2".to_owned()));
        assert_eq!(named("ts/acc", &[text("Name", "unnamed")]), ("acc".to_owned(), String::new()));
        assert_eq!(named("", &[]).0, "Data");
    }
}
