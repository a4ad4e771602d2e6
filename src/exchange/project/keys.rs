//! Keys that several tables share: ranges of elements, delays, numbers above zero.

use super::error::{ProjectError, TableProblem};
use super::reader::Table;

/// `elements = [first, last]`, from 1.
pub(super) fn elements(table: &Table<'_>) -> Result<Option<[i64; 2]>, ProjectError> {
    two_numbers(table, "elements", "[first, last], two whole numbers from 1")
}

/// Two modes that are coupled.
pub(super) fn modes(table: &Table<'_>) -> Result<Option<[i64; 2]>, ProjectError> {
    two_numbers(table, "modes", "two whole numbers from 1")
}

fn two_numbers(table: &Table<'_>, key: &str, expected: &'static str) -> Result<Option<[i64; 2]>, ProjectError> {
    let Some(numbers) = table.numbers(key)? else { return Ok(None) };
    match numbers[..] {
        [a, b] if a.fract() == 0.0 && b.fract() == 0.0 => Ok(Some([a as i64, b as i64])),
        _ => Err(table.error(key, TableProblem::WrongType { key: key.into(), expected, found: "another list" })),
    }
}

/// Longest delay of a channel, s: filters and cables take less than a second, two recorders beside each other some.
const LONGEST_DELAY: f64 = 60.0;

/// How late a channel is recorded, s.
pub(super) fn delay(table: &Table<'_>) -> Result<Option<f64>, ProjectError> {
    let given = table.number("delay")?;
    match given.filter(|value| value.abs() > LONGEST_DELAY) {
        Some(value) => {
            let (key, value, range) = ("delay".to_owned(), value.to_string(), "from -60 s to 60 s");
            Err(table.error("delay", TableProblem::OutOfRange { key, value, range }))
        }
        None => Ok(given),
    }
}

/// A number that must be positive.
pub(super) fn above_zero(
    table: &Table<'_>,
    key: &'static str,
    range: &'static str,
) -> Result<Option<f64>, ProjectError> {
    let given = table.number(key)?;
    match given.filter(|value| *value <= 0.0) {
        Some(value) => {
            let (name, value) = (key.to_owned(), value.to_string());
            Err(table.error(key, TableProblem::OutOfRange { key: name, value, range }))
        }
        None => Ok(given),
    }
}
