//! Samples and times of the channels of a mapping.

use super::table::ChannelTable;
use super::units::LabUnit;
use crate::exchange::records::RecordFileError;
use crate::exchange::records::error::At;
use dashpot_datafiles::{Axis, Contents, DataFile, Defect, Kind, Note, Set, Values};

/// Largest difference of the times of two channels of a run, in steps.
const SAME_TIME: f64 = 0.01;
/// Largest relative difference of a sampling rate that is given and that of the file.
const SAME_RATE: f64 = 0.01;

/// Samples of channels at set and channel of the file in SI units, with sign and calibration. Channels of one set are read in
/// one pass where the file holds them together.
pub(super) fn samples(
    file: &DataFile,
    tables: &[ChannelTable],
    places: &[(usize, usize)],
    at: &At<'_>,
) -> Result<Vec<Vec<f64>>, RecordFileError> {
    let factor = |(table, place): (&ChannelTable, &(usize, usize))| factor(file, *place, table, at);
    let factors = tables.iter().zip(places).map(factor).collect::<Result<Vec<_>, _>>()?;
    let mut found: Vec<Vec<f64>> = vec![Vec::new(); places.len()];
    for set in 0..file.contents().sets.len() {
        let (of_set, channels): (Vec<usize>, Vec<usize>) =
            places.iter().enumerate().filter(|(_, place)| place.0 == set).map(|(i, place)| (i, place.1)).unzip();
        let read = file.read_several(set, &channels).map_err(|error| at.data(error))?;
        for (i, values) in of_set.into_iter().zip(read) {
            let Values::Real(mut values) = values else {
                return Err(at.channel(Some(&tables[i].name), "is complex, and a run needs samples over time"));
            };
            if let Some(row) = mark_of_missing(&values) {
                let mark = values[row];
                let problem = format!(
                    "sample {} is {mark}, which marks a value that is missing: all others are smaller by far",
                    row + 1
                );
                return Err(at.channel(Some(&tables[i].name), format!("{problem}; remove the row or mend the number")));
            }
            values.iter_mut().for_each(|value| *value *= factors[i]);
            found[i] = values;
        }
    }
    Ok(found)
}

/// Numbers that programs write where a value is missing.
const MARKS: [f64; 6] = [-999.0, -9999.0, -99999.0, 9999.0, 99999.0, 999_999.0];
/// How many times all others such a number must be.
const BEYOND: f64 = 100.0;

/// The first sample that is a mark for a missing value, as all samples that are none are far smaller.
fn mark_of_missing(values: &[f64]) -> Option<usize> {
    let row = values.iter().position(|value| MARKS.contains(value))?;
    let others = values.iter().filter(|value| !MARKS.contains(value));
    let largest = others.fold(0.0_f64, |most, value| most.max(value.abs()));
    (largest > 0.0 && values[row].abs() > BEYOND * largest).then_some(row)
}

/// Factor of the numbers of a channel to SI, with sign and calibration.
fn factor(
    file: &DataFile,
    (set, channel): (usize, usize),
    table: &ChannelTable,
    at: &At<'_>,
) -> Result<f64, RecordFileError> {
    let entry = &file.contents().sets[set].channels[channel];
    let kind = file.contents().sets[set].kind;
    if matches!(kind, Kind::Frf | Kind::Spectrum | Kind::Shape | Kind::Geometry | Kind::Matrix) || entry.complex {
        let problem =
            format!("is of kind {}, and a run needs samples over time; choose a channel that has them", kind.word());
        return Err(at.channel(Some(&table.name), problem));
    }
    if entry.count == 0 {
        return Err(at.channel(Some(&table.name), "has 0 samples; export the record again or leave the channel out"));
    }
    factor_to_si(&entry.unit, table, at)
}

/// Factor of numbers in the unit `own` of the file to SI, with sign and calibration.
pub(super) fn factor_to_si(own: &str, table: &ChannelTable, at: &At<'_>) -> Result<f64, RecordFileError> {
    let named = table.unit.as_deref().unwrap_or(own);
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
        return Err(at.channel(Some(&table.name), problem));
    };
    if !unit.measures(quantity) {
        return Err(at.channel(
            Some(&table.name),
            format!("{named} is not a unit of {}; correct `quantity` or `unit` ({known})", quantity.word()),
        ));
    }
    Ok(unit.to_si * table.factor.unwrap_or(1.0) * table.sign.unwrap_or(1) as f64)
}

/// Times of a channel, s.
pub(super) fn times(
    file: &DataFile,
    set: usize,
    channel: usize,
    table: &ChannelTable,
    sampling_hz: Option<f64>,
    at: &At<'_>,
) -> Result<Vec<f64>, RecordFileError> {
    let entry = &file.contents().sets[set].channels[channel];
    let axis = file.axis(set, channel).map_err(|error| at.data(error))?;
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
                at.channel(Some(&table.name), format!("its abscissa is in \"{other}\", and a run needs time in s"))
            );
        }
    };
    match (axis, sampling_hz) {
        (None, None) => {
            if let Some(back) = time_goes_back(&file.contents().sets[set]) {
                return Err(at.channel(None, back));
            }
            let problem = "the file does not say the time between samples; add `sampling_hz` to its [[run]]";
            Err(at.channel(Some(&table.name), problem))
        }
        (None, Some(rate)) => Ok((0..entry.count).map(|i| i as f64 / rate).collect()),
        (Some(mut axis), rate) => {
            if let (Some(rate), Some(step)) = (rate, entry.axis.step())
                && (rate * step * scale - 1.0).abs() > SAME_RATE
            {
                let found = 1.0 / (step * scale);
                return Err(at.channel(
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
pub(super) fn same_even_axis(file: &DataFile, first: (usize, usize), other: (usize, usize)) -> bool {
    let sets = &file.contents().sets;
    let axis_of = |(set, channel): (usize, usize)| {
        let entry = &sets[set].channels[channel];
        (&entry.axis, entry.count, &sets[set].axis_unit)
    };
    matches!(axis_of(first).0, Axis::Even { .. }) && axis_of(first) == axis_of(other)
}

/// Where the times of a set are not in order, and how to mend it.
pub(crate) fn time_goes_back(set: &Set) -> Option<String> {
    let back = set.notes.iter().find(|note| note.tells(Defect::TimeGoesBack))?;
    Some(format!("{back}; sort the rows by time"))
}

/// What a file says of its end where it was cut off, which is why channels of a set are not of one length.
pub(crate) fn cut_off(contents: &Contents, set: usize) -> Option<String> {
    let said = |note: &&Note| note.tells(Defect::CutOff) || note.tells(Defect::BrokenOff);
    let cut = contents.sets[set].notes.iter().chain(&contents.notes).find(said)?;
    Some(if cut.tells(Defect::CutOff) {
        format!("{cut}: it was cut off; copy or export it again, or remove the last row")
    } else {
        format!("{cut}; copy or export it again with channels of one length")
    })
}

/// Refuses channels of a file that was cut off and are not of one length.
pub(super) fn whole(file: &DataFile, places: &[(usize, usize)], at: &At<'_>) -> Result<(), RecordFileError> {
    let count = |&(set, channel): &(usize, usize)| file.contents().sets[set].channels[channel].count;
    let uneven = places.windows(2).any(|pair| count(&pair[0]) != count(&pair[1]));
    match places.first().and_then(|&(set, _)| cut_off(file.contents(), set)).filter(|_| uneven) {
        Some(cut) => Err(at.channel(None, cut)),
        None => Ok(()),
    }
}

/// Channels of a run share their times.
pub(super) fn same_time(
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
        return Err(at.channel(Some(&b.name), problem));
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
            Err(at.channel(Some(&b.name), problem))
        }
    }
}
