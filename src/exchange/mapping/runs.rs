//! Which sets of a file are runs of one layout: groups of TDMS and HDF5, sheets, structs, segments.

use super::table::ChannelTable;
use dashpot_datafiles::{Contents, Kind};

/// Names of the sets that have every channel of a mapping that says no set, optional ones aside; fewer than two where the file is one run. Sets
/// whose names are not their own cannot be told apart and are none.
pub fn runs_of(contents: &Contents, channels: &[ChannelTable]) -> Vec<String> {
    if channels.is_empty() || channels.iter().any(|table| table.set.is_some()) {
        return Vec::new();
    }
    let recorded = contents.sets.iter().filter(|set| matches!(set.kind, Kind::Time | Kind::Table));
    let whole = recorded.filter(|set| {
        let has = |table: &ChannelTable| {
            set.channels.iter().any(|channel| channel.name == table.name && channel.count > 0 && !channel.complex)
        };
        // A set that has none of the channels is no run.
        channels.iter().all(|table| table.optional || has(table)) && channels.iter().any(has)
    });
    let names: Vec<String> = whole.map(|set| set.name.clone()).collect();
    let twice = names.iter().enumerate().any(|(i, name)| names[..i].contains(name));
    if twice { Vec::new() } else { names }
}
