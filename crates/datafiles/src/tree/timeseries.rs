//! Groups laid out as MATLAB's timeseries: `Time` and `Data` with their name and `DataInfo.Units` beside them.

use super::Entry;
use super::names::text_at;
use crate::axis::kind_of;
use crate::contents::Set;

/// Gives the one array `Data` of a group its name and unit: those that the group says, else the name of the group itself.
pub(super) fn name_data(set: &mut Set, path: &str, entries: &[Entry]) {
    let mut data = set.channels.iter_mut().filter(|channel| kind_of(&channel.name, &channel.unit).is_none());
    let (Some(channel), None) = (data.next(), data.next()) else { return };
    if !channel.name.eq_ignore_ascii_case("data") {
        return;
    }
    let stated = text_at(entries, &["Name"]).filter(|name| !matches!(name.trim(), "" | "unnamed"));
    let own = path.rsplit('/').next().filter(|name| !name.is_empty());
    if let Some(name) = stated.or(own) {
        name.trim().clone_into(&mut channel.name);
    }
    if channel.unit.is_empty()
        && let Some(unit) = text_at(entries, &["DataInfo", "Units"])
    {
        unit.trim().clone_into(&mut channel.unit);
    }
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
            name_data(&mut set, path, entries);
            (set.channels[1].name.clone(), set.channels[1].unit.clone())
        };
        assert_eq!(named("ts/acc", &[text("Name", "Acc 1"), info]), ("Acc 1".to_owned(), "m/s^2".to_owned()));
        assert_eq!(named("ts/acc", &[text("Name", "unnamed")]), ("acc".to_owned(), String::new()));
        assert_eq!(named("", &[]).0, "Data");
    }
}
