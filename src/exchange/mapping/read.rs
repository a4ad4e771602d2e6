//! A run out of a laboratory file by the mapping of the project.

use super::memory::too_large;
use super::propose::own_name;
use super::table::ChannelTable;
use super::units::LabUnit;
use crate::exchange::records::{RecordFileError, RecordProblem, base_channel};
use crate::measurement::channel::ChannelName;
use crate::measurement::{Channel, Quantity, Record};
use crate::structure::{Structure, StructureKind};
use dashpot_datafiles::{Axis, DataFile, Kind, Values, open};
use std::path::Path;

/// Largest difference of the times of two channels of a run, in steps.
const SAME_TIME: f64 = 0.01;
/// Largest relative difference of a sampling rate that is given and that of the file.
const SAME_RATE: f64 = 0.01;

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

struct At<'a> {
    file: &'a str,
}

impl At<'_> {
    fn error(&self, column: Option<&str>, problem: impl Into<String>) -> RecordFileError {
        let problem = RecordProblem::DataFile { problem: problem.into() };
        RecordFileError {
            file: self.file.to_owned(),
            line: None,
            column: column.map(|name| format!("channel \"{name}\"")),
            problem,
        }
    }
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
    let file = open(path).map_err(|error| data(&at, error))?;
    let own;
    let channels = if template.channels.is_empty() {
        own = own_channels(&file);
        &own
    } else {
        template.channels
    };
    if channels.is_empty() {
        return Err(at.error(
            None,
            "no [[channel]] says what its channels measure; `dashpot import FILE --propose` writes them",
        ));
    }
    if !template.sets.is_empty() && template.sets.len() != channels.len() {
        let (sets, channels) = (template.sets.len(), channels.len());
        return Err(at.error(
            None,
            format!("`sets` of its [[run]] names {sets} sets, one for each of the {channels} [[channel]] is needed"),
        ));
    }
    let set_of = |i: usize| template.sets.get(i).map(String::as_str).or(template.set);
    let place = |(i, table)| locate(&file, table, set_of(i), &at);
    let places = channels.iter().enumerate().map(place).collect::<Result<Vec<_>, _>>()?;
    let count = |&(set, channel): &(usize, usize)| file.contents().sets[set].channels[channel].count;
    if let Some(problem) = too_large(places.iter().map(count).sum(), channels.len()) {
        return Err(at.error(None, problem));
    }
    let mut time: Option<Vec<f64>> = None;
    let (mut found, mut samples) = (Vec::new(), Vec::new());
    for (table, &(set, channel)) in channels.iter().zip(&places) {
        found.push(target(table, structure, &at)?);
        samples.push(values(&file, set, channel, table, &at)?);
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

/// The error of the file itself.
fn data(at: &At<'_>, error: dashpot_datafiles::Error) -> RecordFileError {
    let problem = RecordProblem::DataFile { problem: error.problem };
    RecordFileError { file: at.file.to_owned(), line: None, column: error.place, problem }
}

/// Channels whose names in the file are those of the project.
fn own_channels(file: &DataFile) -> Vec<ChannelTable> {
    let sets = file.contents().sets.iter();
    sets.flat_map(|set| set.channels.iter().filter_map(|channel| own_name(&set.name, channel))).collect()
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
    if let Some(wanted) = wanted.filter(|wanted| sets.iter().all(|set| set.name != *wanted)) {
        let names: Vec<String> = sets.iter().take(12).map(|set| format!("\"{}\"", set.name)).collect();
        return Err(
            at.error(Some(&table.name), format!("the file has no set \"{wanted}\"; it has {}", names.join(", ")))
        );
    }
    let inside = |name: &str| wanted.is_none_or(|wanted| wanted == name);
    let places = sets.iter().enumerate().filter(|(_, set)| inside(&set.name)).flat_map(|(s, set)| {
        set.channels.iter().enumerate().filter(|(_, channel)| channel.name == table.name).map(move |(c, _)| (s, c))
    });
    let places: Vec<(usize, usize)> = places.collect();
    match places[..] {
        [one] => Ok(one),
        [] => {
            let names = sets.iter().filter(|set| inside(&set.name)).flat_map(|set| &set.channels);
            let names: Vec<String> = names.take(12).map(|channel| format!("\"{}\"", channel.name)).collect();
            let has = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            Err(at.error(Some(&table.name), format!("the file has no channel of that name; it has {has}")))
        }
        [first, second, ..] if first.0 == second.0 => {
            Err(at.error(Some(&table.name), "two channels of the set have that name; rename one in the measuring system, the files cannot be told apart"))
        }
        _ => {
            let names: Vec<String> = places.iter().take(6).map(|&(s, _)| format!("\"{}\"", sets[s].name)).collect();
            Err(at.error(Some(&table.name), format!("{} sets have that channel; name one by `set`: {}", places.len(), names.join(", "))))
        }
    }
}

/// The channel of the project that a table names.
fn target(table: &ChannelTable, structure: &Structure, at: &At<'_>) -> Result<Channel, RecordFileError> {
    let label = table.dof.clone();
    if table.quantity == Quantity::Base {
        return base_channel(&label, structure).ok_or_else(|| {
            let problem =
                format!("the base of this structure does not move along \"{label}\"; write x, y or z of its DOFs");
            at.error(Some(&table.name), problem)
        });
    }
    let Some(dof) = structure.dof(&label) else {
        return Err(at.error(
            Some(&table.name),
            format!("the structure has no DOF \"{label}\"; correct `dof` of its [[channel]]"),
        ));
    };
    unit_suits(table, structure, dof, at)?;
    Ok(Channel { quantity: table.quantity, dof, label })
}

/// Refuses a unit of rotation at a translation and the other way round, where the unit is given in the mapping.
fn unit_suits(table: &ChannelTable, structure: &Structure, dof: usize, at: &At<'_>) -> Result<(), RecordFileError> {
    let Some(unit) = table.unit.as_deref().and_then(LabUnit::from_name) else { return Ok(()) };
    let rotation = structure.dofs()[dof].direction.is_rotation();
    if structure.kind() == StructureKind::Points || unit.rotation == rotation || unit.quantity == Quantity::Force {
        return Ok(());
    }
    let kind = if rotation { "rotation" } else { "translation" };
    let name = table.unit.as_deref().unwrap_or_default();
    Err(at.error(
        Some(&table.name),
        format!("DOF {} is a {kind} and is not measured in {name}; correct `unit` or `dof`", table.dof),
    ))
}

/// Samples in SI units, with sign and calibration.
fn values(
    file: &DataFile,
    set: usize,
    channel: usize,
    table: &ChannelTable,
    at: &At<'_>,
) -> Result<Vec<f64>, RecordFileError> {
    let entry = &file.contents().sets[set].channels[channel];
    let kind = file.contents().sets[set].kind;
    if matches!(kind, Kind::Frf | Kind::Spectrum | Kind::Shape | Kind::Geometry | Kind::Matrix) || entry.complex {
        let problem =
            format!("is of kind {}, and a run needs samples over time; choose a channel that has them", kind.word());
        return Err(at.error(Some(&table.name), problem));
    }
    if entry.count == 0 {
        return Err(at.error(Some(&table.name), "has 0 samples; export the record again or leave the channel out"));
    }
    let named = table.unit.as_deref().unwrap_or(&entry.unit);
    let quantity = table.quantity;
    let known = LabUnit::names_of(quantity);
    let Some(unit) = LabUnit::from_name(named) else {
        let problem = if named.is_empty() {
            format!("the file says no unit; add `unit` to its [[channel]]: {known}")
        } else {
            format!(
                "\"{named}\" is no known unit; add `unit` to its [[channel]] ({known}), with `factor` for units a number"
            )
        };
        return Err(at.error(Some(&table.name), problem));
    };
    if !unit.measures(quantity) {
        return Err(at.error(
            Some(&table.name),
            format!("{named} is not a unit of {}; correct `quantity` or `unit` ({known})", quantity.word()),
        ));
    }
    let factor = unit.to_si * table.factor.unwrap_or(1.0) * table.sign.unwrap_or(1) as f64;
    let read = file.read(set, channel).map_err(|error| data(at, error))?;
    let Values::Real(mut samples) = read else {
        return Err(at.error(Some(&table.name), "is complex, and a run needs samples over time"));
    };
    samples.iter_mut().for_each(|value| *value *= factor);
    Ok(samples)
}

/// Times of a channel, s.
fn times(
    file: &DataFile,
    set: usize,
    channel: usize,
    table: &ChannelTable,
    sampling_hz: Option<f64>,
    at: &At<'_>,
) -> Result<Vec<f64>, RecordFileError> {
    let entry = &file.contents().sets[set].channels[channel];
    let axis = file.axis(set, channel).map_err(|error| data(at, error))?;
    let unit = file.contents().sets[set].axis_unit.trim().to_lowercase();
    let scale = match unit.as_str() {
        "" | "s" | "sec" | "secs" | "second" | "seconds" => 1.0,
        "ms" => 1e-3,
        "us" | "µs" => 1e-6,
        "ns" => 1e-9,
        "min" => 60.0,
        "h" => 3600.0,
        other => {
            return Err(
                at.error(Some(&table.name), format!("its abscissa is in \"{other}\", and a run needs time in s"))
            );
        }
    };
    match (axis, sampling_hz) {
        (None, None) => {
            let problem = "the file does not say the time between samples; add `sampling_hz` to its [[run]]";
            Err(at.error(Some(&table.name), problem))
        }
        (None, Some(rate)) => Ok((0..entry.count).map(|i| i as f64 / rate).collect()),
        (Some(mut axis), rate) => {
            if let (Some(rate), Some(step)) = (rate, entry.axis.step())
                && (rate * step * scale - 1.0).abs() > SAME_RATE
            {
                let found = 1.0 / (step * scale);
                return Err(at.error(
                    Some(&table.name),
                    format!("the file is sampled at {found} Hz and `sampling_hz` says {rate}; leave it out"),
                ));
            }
            axis.iter_mut().for_each(|time| *time *= scale);
            Ok(axis)
        }
    }
}

/// Whether the file states the same even times for two channels, so that they need not be compared one by one.
fn same_even_axis(file: &DataFile, first: (usize, usize), other: (usize, usize)) -> bool {
    let sets = &file.contents().sets;
    let of = |(set, channel): (usize, usize)| {
        let entry = &sets[set].channels[channel];
        (&entry.axis, entry.count, &sets[set].axis_unit)
    };
    matches!(of(first).0, Axis::Even { .. }) && of(first) == of(other)
}

/// Channels of a run share their times.
fn same_time(
    first: &[f64],
    own: &[f64],
    a: &ChannelTable,
    b: &ChannelTable,
    at: &At<'_>,
) -> Result<(), RecordFileError> {
    if first.len() != own.len() {
        let problem = format!(
            "has {} samples and \"{}\" has {}; map channels of one length and rate",
            own.len(),
            a.name,
            first.len()
        );
        return Err(at.error(Some(&b.name), problem));
    }
    let step = if first.len() > 1 { (first[first.len() - 1] - first[0]) / (first.len() - 1) as f64 } else { 0.0 };
    // Written so that NaN is a difference.
    let far = |(x, y): (&f64, &f64)| (x - y).is_nan() || (x - y).abs() > SAME_TIME * step.abs();
    match first.iter().zip(own).position(far) {
        None => Ok(()),
        Some(i) => {
            let problem = format!(
                "sample {} is at {} s and that of \"{}\" at {} s; map channels of one start and rate",
                i + 1,
                own[i],
                a.name,
                first[i]
            );
            Err(at.error(Some(&b.name), problem))
        }
    }
}
