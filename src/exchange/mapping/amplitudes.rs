//! Results of stepped sines as measuring programs export them: a table of amplitudes and phases over frequency, any number of
//! responses, a file or a sheet a level.
//!
//! ```text
//! Freq (Hz);Force 8 (N);Acc 1 (m/s2);Phase 1 (deg);Acc 3 (m/s2);Phase 3 (deg)
//! ```
//!
//! Amplitudes are channels of the mapping (`[[channel]]`: quantity, DOF, unit, sign, factor); `[harmonics.phases]` says which column
//! holds the phase of which: `Y = A exp(i phi)`, where `phi` is the phase by which the channel leads the force.

use super::guess::place_of;
use super::propose::{Proposal, propose};
use super::samples::factor_to_si;
use super::table::ChannelTable;
use crate::exchange::records::columns::{Role, role};
use crate::exchange::records::error::At;
use crate::exchange::records::{HarmonicsRun, RecordFileError};
use crate::measurement::record::MOST;
use crate::measurement::{Channel as Measured, ChannelFit, HarmonicFit, Quantity};
use crate::structure::Structure;
use dashpot_datafiles::{Channel, Contents, DataFile, Kind, Set, Values, open};
use faer::{Mat, c64};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::path::Path;

/// Words of names of phases.
const PHASES: [&str; 10] =
    ["phase", "phas", "phi", "arg", "angle", "winkel", "phasenwinkel", "phasenlage", "fase", "φ"];
/// Words of names of amplitudes that say nothing of what was measured.
const AMPLITUDES: [&str; 8] = ["amplitude", "amp", "ampl", "mag", "magnitude", "abs", "betrag", "peak"];

/// Largest number of a level.
const MOST_LEVEL: f64 = 1e9;

/// What the columns of such a table are.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AmplitudeColumns {
    /// Columns of amplitudes.
    pub mapping: Proposal,
    /// Column of the phase of a channel, by the name of its column.
    pub phases: BTreeMap<String, String>,
}

/// What a file says of such a table for reading it: mapping, phases, set.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AmplitudeTable<'a> {
    pub channels: &'a [ChannelTable],
    pub phases: &'a BTreeMap<String, String>,
    pub set: Option<&'a str>,
    /// Quantity whose phases are given, where it is not that of the channel.
    pub phase_of: Option<Quantity>,
}

/// The columns of a set, if it is such a table.
pub(super) fn amplitudes(contents: &Contents, set: &Set) -> Option<AmplitudeColumns> {
    let swept = set.kind == Kind::Spectrum && set.axis_unit.eq_ignore_ascii_case("hz")
        || set.kind == Kind::Table && set.channels.iter().any(|channel| frequency(channel).is_some());
    let (phases, others): (Vec<&Channel>, Vec<&Channel>) = set.channels.iter().partition(|channel| is_phase(channel));
    if !swept || phases.is_empty() || set.channels.iter().any(|channel| channel.complex) {
        return None;
    }
    let is_size = |channel: &&Channel| frequency(channel).is_none() && !is_level(channel);
    let sizes: Vec<Channel> = others.into_iter().filter(is_size).cloned().collect();
    let as_record = Set { kind: Kind::Time, channels: sizes, name: String::new(), ..set.clone() };
    let mut mapping = propose(&Contents { sets: vec![as_record], notes: Vec::new(), format: contents.format });
    mapping.channels.iter_mut().for_each(|table| table.set = None);
    mapping.needs_sampling = false;
    let found = pairs(set, &mapping.channels, &phases);
    let is_force = |table: &&ChannelTable| table.quantity == Quantity::Force;
    let complete = mapping.channels.iter().any(|table| is_force(&table))
        && mapping.channels.iter().any(|table| !is_force(&table))
        && mapping.channels.iter().all(|table| is_force(&table) || found.contains_key(&table.name));
    complete.then_some(AmplitudeColumns { mapping, phases: found })
}

/// Names of the sets of a file that hold all columns.
pub(crate) fn sets_with<'a>(contents: &'a Contents, table: &AmplitudeColumns) -> Vec<&'a str> {
    let has = |set: &Set, name: &String| set.channels.iter().any(|channel| channel.name == *name);
    let whole = |set: &&Set| {
        table.mapping.channels.iter().all(|channel| has(set, &channel.name))
            && table.phases.values().all(|phase| has(set, phase))
    };
    contents.sets.iter().filter(whole).map(|set| set.name.as_str()).collect()
}

fn words(name: &str) -> Vec<String> {
    let lower = name.to_lowercase();
    lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

fn is_phase(channel: &Channel) -> bool {
    let unit = channel.unit.trim().to_lowercase();
    let angle =
        matches!(unit.as_str(), "" | "-" | "deg" | "°" | "degree" | "degrees" | "grad" | "rad" | "radian" | "radians");
    angle && words(&channel.name).iter().any(|word| PHASES.contains(&word.as_str()))
}

/// Factor to Hz of a column of frequencies.
fn frequency(channel: &Channel) -> Option<f64> {
    match role(&format!("{} [{}]", channel.name, channel.unit)) {
        Role::Frequency(to_hz) => Some(to_hz),
        _ => None,
    }
}

/// Whether a column numbers the level of each row.
fn is_level(channel: &Channel) -> bool {
    channel.unit.trim().is_empty() && role(&channel.name) == Role::Level
}

/// Levels of the rows of a set, where a column of whole numbers says them.
fn levels(file: &DataFile, s: usize, at: &At<'_>) -> Result<Option<Vec<i64>>, RecordFileError> {
    let channels = &file.contents().sets[s].channels;
    let Some(name) = channels.iter().find(|channel| is_level(channel)).map(|channel| channel.name.as_str()) else {
        return Ok(None);
    };
    let (_, values) = column(file, s, name, at)?;
    if let Some(row) = values.iter().position(|value| value.fract() != 0.0 || value.abs() > MOST_LEVEL) {
        let problem = format!("row {} is {}, and levels are whole numbers", row + 1, values[row]);
        return Err(at.channel(Some(name), format!("{problem}; correct it or rename the column")));
    }
    Ok(Some(values.into_iter().map(|value| value as i64).collect()))
}

/// The column of the phase of each channel: of the same name but for words, of the same place, or the next on its right.
fn pairs(set: &Set, channels: &[ChannelTable], phases: &[&Channel]) -> BTreeMap<String, String> {
    let core = |name: &str| -> Vec<String> {
        let said = |word: &String| !PHASES.contains(&word.as_str()) && !AMPLITUDES.contains(&word.as_str());
        words(name).into_iter().filter(said).collect()
    };
    let column = |name: &str| set.channels.iter().position(|channel| channel.name == name);
    let place = |name: &str| place_of(name).map(|(label, _)| label);
    let motions = || channels.iter().filter(|table| table.quantity != Quantity::Force);
    let mut found = BTreeMap::new();
    for phase in phases {
        let same = channels.iter().find(|table| core(&table.name) == core(&phase.name));
        let at_place = || {
            let here = place(&phase.name)?;
            let mut there = motions().filter(|table| place(&table.name).is_some_and(|own| own == here));
            there.next().filter(|_| there.next().is_none())
        };
        let beside = || {
            let left = column(&phase.name)?.checked_sub(1)?;
            motions().find(|table| column(&table.name) == Some(left))
        };
        if let Some(table) = same.or_else(at_place).or_else(beside) {
            found.entry(table.name.clone()).or_insert_with(|| phase.name.clone());
        }
    }
    found
}

/// Reads every row of a table as a run.
pub(crate) fn read_amplitudes(
    path: &Path,
    table: AmplitudeTable<'_>,
    structure: &Structure,
) -> Result<Vec<HarmonicsRun>, RecordFileError> {
    let name = path.display().to_string();
    let at = At { file: &name };
    let file = open(path).map_err(|error| at.data(error))?;
    let s = set_of(&file, &table, &at)?;
    let wanted = table.channels.iter().filter(|channel| !channel.optional || has(&file, s, &channel.name));
    let columns: Vec<Column> =
        wanted.map(|channel| Column::read(&file, s, channel, &table, structure, &at)).collect::<Result<_, _>>()?;
    let Some(frequencies) = frequencies(&file, s) else {
        return Err(at.channel(None, "the table has no column of frequencies; call it `Frequency [Hz]`"));
    };
    columns.iter().try_for_each(|column| column.measurable(&at))?;
    let levels = levels(&file, s, &at)?;
    let set = table.set.map_or_else(String::new, |set| format!("{set} "));
    let run = |(row, &frequency_hz): (usize, &f64)| {
        let fit = row_of(&columns, row, frequency_hz, table.phase_of).ok_or_else(|| {
            let problem = "has no frequency above 0 Hz, or an amplitude or phase that is no number; leave the row out";
            at.channel(None, format!("row {} of its numbers {problem}", row + 1))
        })?;
        let level = levels.as_ref().and_then(|levels| levels.get(row).copied());
        Ok(HarmonicsRun { name: format!("{set}row {}", row + 1), fit, level, session: None })
    };
    frequencies.iter().enumerate().map(run).collect()
}

/// The amplitudes of a channel over the rows, with its phases in radians.
struct Column {
    channel: Measured,
    /// Factor to SI, with sign and calibration.
    factor: f64,
    sizes: Vec<f64>,
    /// None for a force, whose phase is 0.
    phases: Option<Vec<f64>>,
}

impl Column {
    fn read(
        file: &DataFile,
        s: usize,
        channel: &ChannelTable,
        table: &AmplitudeTable<'_>,
        structure: &Structure,
        at: &At<'_>,
    ) -> Result<Self, RecordFileError> {
        let columns = &file.contents().sets[s].channels;
        let (c, sizes) = column(file, s, &channel.name, at)?;
        let target = super::read::target(channel, &columns[c].unit, structure, at)?;
        let factor = factor_to_si(&columns[c].unit, channel, at)?;
        let phases = table.phases.get(&channel.name).map(|name| column(file, s, name, at)).transpose()?;
        let phases = phases.map(|(c, values)| radians(&columns[c], values));
        if phases.is_none() && channel.quantity != Quantity::Force {
            return Err(at.channel(Some(&channel.name), "has no phase; name its column under [harmonics.phases]"));
        }
        Ok(Self { channel: target, factor, sizes, phases })
    }

    /// Refuses an amplitude that no sensor reads.
    fn measurable(&self, at: &At<'_>) -> Result<(), RecordFileError> {
        let beyond = |size: &f64| size.is_finite() && (size * self.factor).abs() > MOST;
        let Some(row) = self.sizes.iter().position(beyond) else { return Ok(()) };
        let value = self.sizes[row] * self.factor;
        let problem = format!("row {} is {value:e} (SI units), more than any sensor reads", row + 1);
        Err(at.channel(Some(&self.channel.to_string()), format!("{problem}; mend the number or leave the row out")))
    }
}

/// The harmonics of a row; none where a number is missing or is none.
fn row_of(columns: &[Column], row: usize, frequency_hz: f64, phase_of: Option<Quantity>) -> Option<HarmonicFit> {
    let fit = |column: &Column| {
        let phase = column.phases.as_ref().map_or(Some(0.0), |phases| phases.get(row).copied())?;
        let size = column.sizes.get(row)? * column.factor;
        Some(fit(&column.channel, size, phase, phase_of)).filter(|fit| fit.amplitudes.iter().all(|y| y.is_finite()))
    };
    let channels: Vec<ChannelFit> = columns.iter().map(fit).collect::<Option<_>>()?;
    let omega = TAU * frequency_hz;
    (omega > 0.0 && omega.is_finite()).then_some(HarmonicFit { omega, omega_deviation: 0.0, channels })
}

fn fit(channel: &Measured, size: f64, phase: f64, phase_of: Option<Quantity>) -> ChannelFit {
    let turned = if channel.quantity == Quantity::Force { None } else { phase_of };
    let turn = match (channel.quantity.derivatives(), turned.and_then(Quantity::derivatives)) {
        (Some(own), Some(said)) => c64::new(0.0, 1.0).powi(own - said),
        _ => c64::new(1.0, 0.0),
    };
    ChannelFit {
        channel: channel.clone(),
        offset: 0.0,
        slope: 0.0,
        amplitudes: vec![c64::new(0.0, phase).exp() * size * turn],
        covariance: Mat::zeros(2, 2),
        noise: 0.0,
    }
}

/// The set that is named, else the first with all columns.
fn set_of(file: &DataFile, table: &AmplitudeTable<'_>, at: &At<'_>) -> Result<usize, RecordFileError> {
    let sets = &file.contents().sets;
    let names = || sets.iter().take(12).map(|set| format!("\"{}\"", set.name)).collect::<Vec<_>>().join(", ");
    if let Some(wanted) = table.set {
        let named = sets.iter().position(|set| set.name == wanted);
        return named.ok_or_else(|| at.channel(None, format!("the file has no set \"{wanted}\"; it has {}", names())));
    }
    let whole = |s: &usize| table.phases.iter().all(|(size, phase)| has(file, *s, size) && has(file, *s, phase));
    (0..sets.len()).find(whole).ok_or_else(|| {
        let wanted: Vec<String> =
            table.phases.iter().flat_map(|(size, phase)| [size, phase]).map(|name| format!("\"{name}\"")).collect();
        at.channel(None, format!("no table of the file has the columns {} of [harmonics.phases]", wanted.join(", ")))
    })
}

fn has(file: &DataFile, set: usize, name: &str) -> bool {
    file.contents().sets[set].channels.iter().any(|channel| channel.name == name)
}

/// Place and numbers of a column.
fn column(file: &DataFile, set: usize, name: &str, at: &At<'_>) -> Result<(usize, Vec<f64>), RecordFileError> {
    let channels = &file.contents().sets[set].channels;
    let Some(c) = channels.iter().position(|channel| channel.name == name) else {
        let names: Vec<String> = channels.iter().take(12).map(|channel| format!("\"{}\"", channel.name)).collect();
        return Err(
            at.channel(Some(name), format!("the table has no column of that name; it has {}", names.join(", ")))
        );
    };
    match file.read(set, c).map_err(|error| at.data(error))? {
        Values::Real(values) => Ok((c, values)),
        Values::Complex(_) => Err(at.channel(Some(name), "is complex, and an amplitude or phase is needed")),
    }
}

/// Phases in radians: in degrees unless their unit says otherwise, or there is none and none is above 2 pi.
fn radians(column: &Channel, values: Vec<f64>) -> Vec<f64> {
    let in_radians = match column.unit.trim().to_lowercase().as_str() {
        "rad" | "radian" | "radians" => true,
        "" | "-" => {
            let said = words(&column.name);
            said.iter().any(|word| word == "rad")
                || !said.iter().any(|word| word == "deg") && values.iter().all(|phase| phase.abs() <= TAU)
        }
        _ => false,
    };
    if in_radians { values } else { values.into_iter().map(f64::to_radians).collect() }
}

/// Frequencies of the rows of a set, Hz: a column of them, else its abscissa.
pub(super) fn frequencies(file: &DataFile, s: usize) -> Option<Vec<f64>> {
    let mut channels = file.contents().sets[s].channels.iter().enumerate();
    let Some((c, to_hz)) = channels.find_map(|(c, channel)| Some((c, frequency(channel)?))) else {
        return file.axis(s, 0).ok()?;
    };
    match file.read(s, c) {
        Ok(Values::Real(values)) => Some(values.into_iter().map(|f| f * to_hz).collect()),
        _ => None,
    }
}
