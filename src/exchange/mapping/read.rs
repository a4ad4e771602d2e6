//! A run out of a laboratory file by the mapping of the project.

use super::memory::too_large;
use super::propose::own_name;
use super::samples::{same_even_axis, same_time, samples, times, whole};
use super::table::ChannelTable;
use super::units::LabUnit;
use crate::exchange::records::error::At;
use crate::exchange::records::{RecordFileError, RecordProblem, base_channel, known_labels};
use crate::measurement::channel::ChannelName;
use crate::measurement::{Channel, Quantity, Record};
use crate::structure::{Structure, StructureKind};
use dashpot_datafiles::{Channel as FileChannel, DataFile, Set, open};
use std::path::Path;

/// What the project says of its laboratory files.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Template<'a> {
    /// Channels; none: those whose names in the file are `QUANTITY@DOF`.
    pub channels: &'a [ChannelTable],
    /// Set of the run.
    pub set: Option<&'a str>,
    /// Sets of the run, one a channel in their order; none: those that the channels state.
    pub sets: &'a [String],
    /// Sampling rate where the file has no time, Hz.
    pub sampling_hz: Option<f64>,
}

/// Whether a file is a record in the project's own form (`time [s]`, `QUANTITY@DOF [UNIT]`) that nothing of the mapping
/// is meant for. Without a mapping every file is that whose ending is `csv`, or that is no file of another format.
pub(crate) fn reads_as_own(path: &Path, template: Template<'_>) -> bool {
    if template.sampling_hz.is_some() || template.set.is_some() || !template.sets.is_empty() {
        return false;
    }
    if template.channels.is_empty() {
        let csv = path.extension().is_none_or(|end| end.eq_ignore_ascii_case("csv") || end.eq_ignore_ascii_case("txt"));
        return csv || open(path).is_err();
    }
    let bare = |name: &str| name.split('[').next().unwrap_or_default().trim().to_owned();
    own_names(path)
        .is_some_and(|names| names.iter().all(|name| template.channels.iter().all(|table| table.name != bare(name))))
}

/// Whether a file is a record in the project's own form.
pub fn is_own_record(path: &Path) -> bool {
    own_names(path).is_some()
}

/// Names of the columns of a record in the project's own form; none of any other file.
fn own_names(path: &Path) -> Option<Vec<String>> {
    let mut start = vec![0; 1 << 16];
    let read = std::fs::File::open(path).and_then(|mut file| std::io::Read::read(&mut file, &mut start));
    start.truncate(read.unwrap_or(0));
    let text = String::from_utf8_lossy(&start);
    let header = text.trim_start_matches('\u{feff}').lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
    let mut cells = header.split([',', ';', '\t']).map(|cell| cell.trim().trim_matches('"'));
    let timed = cells.next().is_some_and(|cell| cell.to_lowercase().starts_with("time"));
    let names: Vec<String> = cells.filter(|cell| !cell.is_empty()).map(str::to_owned).collect();
    let own = !names.is_empty() && names.iter().all(|name| ChannelName::parse(name).is_ok());
    (timed && own).then_some(names)
}

/// Reads the record of a run from a laboratory file of any format.
pub(crate) fn read_mapped(
    path: &Path,
    template: Template<'_>,
    structure: &Structure,
) -> Result<Record, RecordFileError> {
    let name = path.display().to_string();
    let at = At { file: &name };
    let file = open(path).map_err(|error| at.data(error))?;
    let own;
    let channels = if template.channels.is_empty() {
        own = own_channels(&file);
        &own
    } else {
        template.channels
    };
    let present: Vec<ChannelTable>;
    let channels = if template.sets.is_empty() && channels.iter().any(|table| table.optional || table.set.is_some()) {
        present = present_in(&file, channels, template.set);
        &present
    } else {
        channels
    };
    if channels.is_empty() {
        return Err(at.channel(
            None,
            "no [[channel]] says what its channels measure; `dashpot import FILE --propose` writes them",
        ));
    }
    if !template.sets.is_empty() && template.sets.len() != channels.len() {
        let (sets, channels) = (template.sets.len(), channels.len());
        return Err(at.channel(
            None,
            format!("`sets` of its [[run]] names {sets} sets, one for each of the {channels} [[channel]] is needed"),
        ));
    }
    let set_of = |i: usize| template.sets.get(i).map(String::as_str).or(template.set);
    let place = |(i, table)| locate(&file, table, set_of(i), &at);
    let places = channels.iter().enumerate().map(place).collect::<Result<Vec<_>, _>>()?;
    let count = |&(set, channel): &(usize, usize)| file.contents().sets[set].channels[channel].count;
    if let Some(problem) = too_large(places.iter().map(count).sum(), channels.len()) {
        return Err(at.channel(None, problem));
    }
    let mut time: Option<Vec<f64>> = None;
    let unit = |&(set, channel): &(usize, usize)| file.contents().sets[set].channels[channel].unit.as_str();
    let target = |(table, place)| target(table, unit(place), structure, &at);
    let found = channels.iter().zip(&places).map(target).collect::<Result<Vec<_>, _>>()?;
    whole(&file, &places, &at)?;
    let samples = samples(&file, channels, &places, &at)?;
    for (table, &(set, channel)) in channels.iter().zip(&places) {
        if time.is_some() && same_even_axis(&file, places[0], (set, channel)) {
            continue;
        }
        let own = times(&file, set, channel, table, template.sampling_hz, &at)?;
        match &time {
            None => time = Some(own),
            Some(first) => same_time(first, &own, &channels[0], table, &at)?,
        }
    }
    let time = time.unwrap_or_default();
    Record::new(time, found, samples).map_err(|problem| RecordFileError {
        file: name.clone(),
        line: None,
        column: None,
        problem: RecordProblem::Record { problem },
    })
}

/// Channels whose names in the file are those of the project.
fn own_channels(file: &DataFile) -> Vec<ChannelTable> {
    let sets = file.contents().sets.iter();
    sets.flat_map(|set| set.channels.iter().filter_map(|channel| own_name(&set.name, channel))).collect()
}

/// The tables that are meant for a run of a file: not those of another set of the same name, nor optional ones that it lacks.
fn present_in(file: &DataFile, channels: &[ChannelTable], run_set: Option<&str>) -> Vec<ChannelTable> {
    let has = |set: &str| match run_set {
        Some(own) => own == set,
        None => file.contents().sets.iter().any(|other| is_called(other, set)),
    };
    let meant = channels.iter().filter(|table| table.is_meant(channels, &has));
    meant.filter(|table| !table.optional || holds(file, table, run_set)).cloned().collect()
}

/// Whether a file has the channel of a table.
fn holds(file: &DataFile, table: &ChannelTable, run_set: Option<&str>) -> bool {
    let wanted = run_set.or(table.set.as_deref());
    let mut sets = file.contents().sets.iter();
    sets.any(|set| set.channels.iter().any(|channel| channel.name == table.name && is_in(set, channel, wanted)))
}

/// Whether a channel is in a set of that name: channels that are gathered from sets of their own are in these too.
fn is_in(set: &Set, channel: &FileChannel, wanted: Option<&str>) -> bool {
    wanted.is_none_or(|wanted| wanted == set.name || channel.attribute("set") == Some(wanted))
}

/// Whether a set, or that of one of its channels, has that name.
fn is_called(set: &Set, wanted: &str) -> bool {
    set.name == wanted || set.channels.iter().any(|channel| channel.attribute("set") == Some(wanted))
}

/// The name of the only set of a file without a set `wanted` that is called as it is below the same number of groups: paths hold
/// the number of the run (`Run 1/Force 8` in one file, `Run 2/Force 8` in the next).
fn same_end<'a>(sets: &'a [Set], wanted: &str) -> Option<&'a str> {
    let (above, end) = wanted.rsplit_once('/')?;
    let depth = above.matches('/').count();
    let alike = |set: &&Set| {
        let parts = set.name.rsplit_once('/');
        set.name == wanted || parts.is_some_and(|(above, own)| own == end && above.matches('/').count() == depth)
    };
    match sets.iter().filter(alike).map(|set| set.name.as_str()).collect::<Vec<_>>()[..] {
        [one] => Some(one),
        _ => None,
    }
}

/// Set and channel of a table of the mapping: exactly one.
fn locate(
    file: &DataFile,
    table: &ChannelTable,
    run_set: Option<&str>,
    at: &At<'_>,
) -> Result<(usize, usize), RecordFileError> {
    let wanted = run_set.or(table.set.as_deref());
    let sets = &file.contents().sets;
    let renamed = table.set.as_deref().filter(|_| run_set.is_none()).and_then(|set| same_end(sets, set));
    let wanted = renamed.or(wanted);
    if let Some(wanted) = wanted.filter(|wanted| !sets.iter().any(|set| is_called(set, wanted))) {
        let names: Vec<String> = sets.iter().take(12).map(|set| format!("\"{}\"", set.name)).collect();
        return Err(
            at.channel(Some(&table.name), format!("the file has no set \"{wanted}\"; it has {}", names.join(", ")))
        );
    }
    let places = sets.iter().enumerate().flat_map(|(s, set)| {
        let named = |channel: &FileChannel| channel.name == table.name && is_in(set, channel, wanted);
        set.channels.iter().enumerate().filter(move |(_, channel)| named(channel)).map(move |(c, _)| (s, c))
    });
    let places: Vec<(usize, usize)> = places.collect();
    match places[..] {
        [one] => Ok(one),
        [] => {
            let inside = |set: &'_ Set| set.channels.iter().filter(|c| is_in(set, c, wanted)).map(|c| format!("\"{}\"", c.name)).collect();
            let names: Vec<String> = sets.iter().flat_map(|set| -> Vec<String> { inside(set) }).take(12).collect();
            let has = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            Err(at.channel(Some(&table.name), format!("the file has no channel of that name; it has {has}")))
        }
        [first, second, ..] if first.0 == second.0 => {
            Err(at.channel(Some(&table.name), "two channels of the set have that name; rename one in the measuring system, the files cannot be told apart"))
        }
        _ => {
            let names: Vec<String> = places.iter().take(6).map(|&(s, _)| format!("\"{}\"", sets[s].name)).collect();
            Err(at.channel(Some(&table.name), format!("{} sets have that channel; name one by `set`: {}", places.len(), names.join(", "))))
        }
    }
}

/// The channel of the project that a table names; `unit` is that of the file.
pub(super) fn target(
    table: &ChannelTable,
    unit: &str,
    structure: &Structure,
    at: &At<'_>,
) -> Result<Channel, RecordFileError> {
    let label = table.dof.clone();
    if table.quantity == Quantity::Base {
        return base_channel(&label, structure).ok_or_else(|| {
            let problem =
                format!("the base of this structure does not move along \"{label}\"; write x, y or z of its DOFs");
            at.channel(Some(&table.name), problem)
        });
    }
    let Some(dof) = structure.dof(&label) else {
        return Err(at.channel(
            Some(&table.name),
            format!(
                "the structure has no DOF \"{label}\", it has {}; correct `dof` of its [[channel]]",
                known_labels(structure)
            ),
        ));
    };
    unit_suits(table, unit, structure, dof, at)?;
    Ok(Channel { quantity: table.quantity, dof, label })
}

/// Refuses a unit of rotation at a translation and the other way round. Of forces N at a rotation is read as N m.
fn unit_suits(
    table: &ChannelTable,
    unit: &str,
    structure: &Structure,
    dof: usize,
    at: &At<'_>,
) -> Result<(), RecordFileError> {
    let name = table.unit.as_deref().unwrap_or(unit);
    let Some(unit) = LabUnit::from_name(name) else { return Ok(()) };
    let direction = structure.dofs()[dof].direction;
    let rotation = direction.is_rotation();
    if structure.kind() == StructureKind::Points || unit.rotation == rotation || unit.quantity == Quantity::Force {
        return Ok(());
    }
    let kind = if rotation { "rotation" } else { "translation" };
    let node = &structure.nodes()[structure.dofs()[dof].node].label;
    Err(at.channel(
        Some(&table.name),
        format!("DOF {} is a {kind} of node {node} and is not measured in {name}; correct `unit` or `dof`", table.dof),
    ))
}

#[cfg(test)]
mod tests {
    use super::same_end;
    use dashpot_datafiles::{Kind, Set};

    #[test]
    fn the_number_of_a_run_in_the_path_of_a_set_does_not_matter() {
        let named = |name: &str| Set {
            name: name.to_owned(),
            kind: Kind::Time,
            axis_unit: String::new(),
            channels: Vec::new(),
            notes: Vec::new(),
        };
        let sets = ["P/Run 2/Force 8", "P/Run 2/Acc 1", "Force 8"].map(named);
        assert_eq!(same_end(&sets, "P/Run 1/Force 8"), Some("P/Run 2/Force 8"));
        assert_eq!(same_end(&sets, "P/Run 1/Acc 3"), None);
        // Two runs in one file cannot be told apart.
        let sets = ["P/Run 2/Force 8", "P/Run 3/Force 8"].map(named);
        assert_eq!((same_end(&sets, "P/Run 1/Force 8"), same_end(&sets, "Force 8")), (None, None));
    }
}
