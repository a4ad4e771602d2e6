//! Reads a time record from CSV.
//!
//! One header row `time [s]`, then `QUANTITY@DOF [UNIT]` a channel. Understood beside the comma: semicolons or tabs
//! between the columns (then also a decimal comma), quoted names, a byte order mark, blank lines, separators at the end
//! of rows, any spacing in names. Numbers become SI units.

use super::error::{At, RecordFileError, RecordProblem};
use super::table::{Table, quote};
use crate::control::Control;
use crate::measurement::base::AXES;
use crate::measurement::channel::{ChannelName, Unit};
use crate::measurement::record::RecordError;
use crate::measurement::{Channel, Quantity, Record};
use crate::structure::{Structure, StructureKind};
use std::path::Path;

/// Rows between two looks at the control.
const ROWS_PER_REPORT: usize = 4096;

/// Rows whose digits are counted to find the step in which the numbers were written.
const ROWS_COUNTED: usize = 4096;

/// From this many digits on a number is as good as exact.
const EXACT_DIGITS: i32 = 15;

/// Most labels that an error message lists.
const MOST_LABELS: usize = 12;

/// Reads the record in the file at `path`; messages name the file as it is given here.
pub fn read_record(path: &Path, structure: &Structure) -> Result<Record, RecordFileError> {
    read_record_with(path, structure, &Control::unattended())
}

/// Reads a record as [`read_record`] does, reports its progress and can be cancelled.
pub fn read_record_with(path: &Path, structure: &Structure, control: &Control) -> Result<Record, RecordFileError> {
    let name = path.display().to_string();
    let bytes = std::fs::read(path)
        .map_err(|error| At { file: &name }.file(RecordProblem::Unreadable { reason: error.to_string() }))?;
    parse_record(&bytes, &name, structure, control)
}

/// Reads a record from the bytes of a file called `name` in messages, as [`read_record_with`] does.
pub fn parse_record(
    bytes: &[u8],
    name: &str,
    structure: &Structure,
    control: &Control,
) -> Result<Record, RecordFileError> {
    let at = At { file: name };
    let mut table = Table::open(bytes, at)?;
    let columns = columns(&table, structure, at)?;
    let rows = 1 + bytes.len() / (8 * table.header.len());
    let mut time: Vec<f64> = Vec::with_capacity(rows);
    let mut samples: Vec<Vec<f64>> = columns.iter().map(|_| Vec::with_capacity(rows)).collect();
    let mut digits = vec![0; columns.len()];
    while table.next()? {
        table.check_width()?;
        let now = table.number(0)?;
        if let Some(&before) = time.last().filter(|&&before| now < before) {
            return Err(table.error(0, RecordProblem::TimeGoesBack { time: now, before }));
        }
        for (c, values) in samples.iter_mut().enumerate() {
            values.push(in_si(&table, c + 1, columns[c].1)?);
            if time.len() < ROWS_COUNTED {
                digits[c] = significant_digits(table.bytes(c + 1)).max(digits[c]);
            }
        }
        time.push(now);
        if time.len().is_multiple_of(ROWS_PER_REPORT) {
            control.report(table.progress());
            control.check().map_err(|_| at.file(RecordProblem::Cancelled))?;
        }
    }
    if time.is_empty() {
        return Err(at.file(RecordProblem::HeaderOnly));
    }
    let resolution = (0..columns.len()).map(|c| resolution(&samples[c], columns[c].1, digits[c])).collect();
    let channels = columns.into_iter().map(|(channel, _)| channel).collect();
    let record = Record::new(time, channels, samples).map_err(|problem| locate(problem, &table, at))?;
    Ok(record.with_resolution(resolution))
}

/// A number in SI units; a finite number of a file may still be too large for them.
fn in_si(table: &Table<'_>, column: usize, unit: &Unit) -> Result<f64, RecordFileError> {
    let value = table.number(column)? * unit.to_si;
    if value.is_finite() {
        return Ok(value);
    }
    Err(table.error(column, RecordProblem::NotFinite { text: quote(table.bytes(column)) }))
}

/// Puts what the record's constructor found where the user looks for it.
fn locate(problem: RecordError, table: &Table<'_>, at: At<'_>) -> RecordFileError {
    match problem {
        RecordError::DuplicateChannel { .. } => at.line(table.header_line, RecordProblem::Record { problem }),
        _ => at.file(RecordProblem::Record { problem }),
    }
}

/// Channels and units of the header's columns behind the time.
fn columns(
    table: &Table<'_>,
    structure: &Structure,
    at: At<'_>,
) -> Result<Vec<(Channel, &'static Unit)>, RecordFileError> {
    let line = table.header_line;
    // A unit may stand below its name.
    if let Some(name) = table.header.iter().find(|name| name.lines().count() > 2) {
        let first = name.lines().next().unwrap_or_default();
        return Err(at.line(line, RecordProblem::OpenQuote { name: quote(first.as_bytes()) }));
    }
    check_time_column(&table.header[0]).map_err(|problem| at.line(line, problem))?;
    if table.header.len() < 2 {
        return Err(at.line(line, RecordProblem::OneColumn));
    }
    let mut columns: Vec<(Channel, &'static Unit)> = Vec::new();
    for (i, name) in table.header.iter().enumerate().skip(1) {
        if name.is_empty() {
            return Err(at.line(line, RecordProblem::NoName { number: i + 1 }));
        }
        let (channel, unit) =
            channel(name, structure).map_err(|problem| at.cell(line, &quote(name.as_bytes()), problem))?;
        if columns.iter().any(|(other, _)| *other == channel) {
            let problem = RecordError::DuplicateChannel { channel: channel.to_string() };
            return Err(at.line(line, RecordProblem::Record { problem }));
        }
        columns.push((channel, unit));
    }
    Ok(columns)
}

/// Accepts `time [s]` in any case and spacing.
fn check_time_column(name: &str) -> Result<(), RecordProblem> {
    let plain: String = name.chars().filter(|c| !c.is_whitespace()).collect::<String>().to_lowercase();
    let unit = plain.strip_prefix("time").map(|unit| unit.trim_matches(|c| "[]()".contains(c)));
    match unit {
        Some("s") => Ok(()),
        Some(_) => {
            let unit = name.trim().get(4..).unwrap_or_default().trim().trim_matches(|c| "[]()".contains(c));
            if unit.is_empty() {
                return Err(RecordProblem::NoTimeUnit);
            }
            Err(RecordProblem::TimeUnit { unit: quote(unit.as_bytes()) })
        }
        None if name.replace(',', ".").parse::<f64>().is_ok() => Err(RecordProblem::NoHeader),
        None => Err(RecordProblem::NoTime { found: quote(name.as_bytes()) }),
    }
}

/// The channel and unit of a column's name, at a DOF of the structure that can be measured in that unit.
pub(super) fn channel(name: &str, structure: &Structure) -> Result<(Channel, &'static Unit), RecordProblem> {
    let ChannelName { quantity, label, unit } =
        ChannelName::parse(name).map_err(|problem| RecordProblem::Channel { problem })?;
    if quantity == Quantity::Base {
        return match base_channel(&label, structure) {
            Some(channel) => Ok((channel, unit)),
            None => Err(no_base_axis(&label, structure)),
        };
    }
    let Some(dof) = structure.dof(&label) else {
        return Err(RecordProblem::UnknownDof { label: quote(label.as_bytes()), known: known_labels(structure) });
    };
    let rotation = structure.dofs()[dof].direction.is_rotation();
    // Points have no direction of their own: they may be anything.
    if structure.kind() != StructureKind::Points && !unit.suits(rotation) {
        let kind = if rotation { "rotation" } else { "translation" };
        let units: Vec<&str> = crate::measurement::channel::UNITS
            .iter()
            .filter(|other| other.quantity == quantity && other.suits(rotation))
            .map(|other| other.name)
            .collect();
        return Err(RecordProblem::UnitOfOtherKind { label, kind, unit: unit.name, units: units.join(", ") });
    }
    Ok((Channel { quantity, dof, label }, unit))
}

/// The channel of a base that moves along `x`, `y` or `z`; it is listed at the first DOF that follows it. None for another
/// direction, and for a structure that does not move in it.
pub(crate) fn base_channel(label: &str, structure: &Structure) -> Option<Channel> {
    let axis = AXES.iter().position(|&axis| axis == label)?;
    let dof = structure.carried_by_base(axis).first().copied()?;
    Some(Channel { quantity: Quantity::Base, dof, label: label.to_owned() })
}

/// That no DOF follows a base along `label`, with the directions that DOFs have.
fn no_base_axis(label: &str, structure: &Structure) -> RecordProblem {
    let moves = |axis: &usize| !structure.carried_by_base(*axis).is_empty();
    let known: Vec<&str> = (0..AXES.len()).filter(moves).map(|axis| AXES[axis]).collect();
    RecordProblem::NoBaseAxis { label: quote(label.as_bytes()), known: known.join(" or ") }
}

pub(crate) fn known_labels(structure: &Structure) -> String {
    let dofs = structure.dofs();
    let labels: Vec<&str> = dofs.iter().take(MOST_LABELS).map(|dof| dof.label.as_str()).collect();
    match dofs.last() {
        Some(last) if dofs.len() > MOST_LABELS => format!("{} … {}", labels.join(", "), last.label),
        _ => labels.join(", "),
    }
}

/// Digits of a number's text from its first that is not zero.
fn significant_digits(cell: &[u8]) -> i32 {
    let mantissa = cell.iter().take_while(|byte| !matches!(byte, b'e' | b'E'));
    mantissa.filter(|byte| byte.is_ascii_digit()).skip_while(|&&byte| byte == b'0').count() as i32
}

/// Step of the largest number of a channel, SI units, if its longest number has that many digits; 0 for exact.
fn resolution(values: &[f64], unit: &Unit, digits: i32) -> f64 {
    let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs())) / unit.to_si;
    if largest == 0.0 || digits >= EXACT_DIGITS {
        return 0.0;
    }
    let place = largest.log10().floor() as i32 - digits.max(1) + 1;
    10.0_f64.powi(place) * unit.to_si
}
