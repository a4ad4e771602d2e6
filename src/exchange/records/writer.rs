//! Writes a time record as CSV in SI units.

use super::error::{At, RecordFileError, RecordProblem};
use crate::exchange::atomic::write_atomically;
use crate::math::numerals::rounded;
use crate::measurement::{Channel, Record};
use crate::structure::Structure;
use std::fmt::Write as _;
use std::path::Path;

/// Writes `record` to `path`. Without `digits` every number has as many as it takes to read back the same; with it, the
/// samples are rounded to that many significant digits (1 to 17), which keeps files small. The time is never rounded.
pub fn write_record(
    path: &Path,
    record: &Record,
    structure: &Structure,
    digits: Option<usize>,
) -> Result<(), RecordFileError> {
    save(path, &record_text(record, structure, digits))
}

/// The text that [`write_record`] writes.
pub(crate) fn record_text(record: &Record, structure: &Structure, digits: Option<usize>) -> String {
    let mut text = String::from("time [s]");
    for channel in record.channels() {
        let name = channel_name(channel, structure);
        let _ = write!(text, ",{}", quoted(&name));
    }
    text.push('\n');
    for (n, time) in record.time().iter().enumerate() {
        let _ = write!(text, "{time}");
        for c in 0..record.channels().len() {
            text.push(',');
            push_number(&mut text, record.samples(c)[n], digits);
        }
        text.push('\n');
    }
    text
}

/// Name of a channel with its SI unit.
pub(super) fn channel_name(channel: &Channel, structure: &Structure) -> String {
    let rotation = structure.dofs().get(channel.dof).is_some_and(|dof| dof.direction.is_rotation());
    format!("{channel} [{}]", channel.quantity.si_unit(rotation))
}

/// A cell in quotes where its text would otherwise be cut.
pub(super) fn quoted(text: &str) -> String {
    if text.contains(['"', ',', ';', '\t', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

/// Writes a number in the shorter of its two notations.
pub(super) fn push_number(text: &mut String, value: f64, digits: Option<usize>) {
    let value = match digits {
        Some(digits) => rounded(value, digits.clamp(1, 17)),
        None => value,
    };
    let plain = format!("{value}");
    let scientific = format!("{value:e}");
    text.push_str(if scientific.len() < plain.len() { &scientific } else { &plain });
}

/// Writes the text to a file beside `path` and puts it in its place when complete.
pub(super) fn save(path: &Path, text: &str) -> Result<(), RecordFileError> {
    let name = path.display().to_string();
    let failed = |reason: String| At { file: &name }.file(RecordProblem::Unwritable { reason });
    write_atomically(path, text.as_bytes()).map_err(|error| failed(error.to_string()))
}
