//! Damping ratios from elsewhere, as CSV: `frequency_hz,damping_ratio,deviation`, one mode a row.

use crate::measurement::MeasuredRatio;
use serde::Deserialize;
use std::f64::consts::TAU;
use std::path::Path;

/// Why the ratios cannot be read.
#[derive(Debug, thiserror::Error)]
pub(crate) enum RatioFileError {
    #[error("{file}: cannot be read: {reason}; write frequency_hz,damping_ratio,deviation and one mode a row")]
    Unreadable { file: String, reason: String },
    #[error("{file}:{line}: {what} is {value}; it must be a positive number{hint}")]
    Value { file: String, line: u64, what: &'static str, value: f64, hint: &'static str },
    #[error("{file}: there is no ratio; write one mode a row")]
    Empty { file: String },
}

#[derive(Deserialize)]
struct Row {
    frequency_hz: f64,
    damping_ratio: f64,
    deviation: f64,
}

/// Reads the ratios of the file at `path`.
///
/// # Errors
/// [`RatioFileError`]: the file, the line, what is wrong and how to mend it.
pub(crate) fn read_ratios(path: &Path) -> Result<Vec<MeasuredRatio>, RatioFileError> {
    let file = path.display().to_string();
    let unreadable = |reason: String| RatioFileError::Unreadable { file: file.clone(), reason };
    let text = std::fs::read_to_string(path).map_err(|error| unreadable(error.to_string()))?;
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
    let mut ratios = Vec::new();
    for (index, row) in reader.deserialize::<Row>().enumerate() {
        let row = row.map_err(|error| unreadable(error.to_string()))?;
        let line = index as u64 + 2;
        let wrong = |what, value, hint| RatioFileError::Value { file: file.clone(), line, what, value, hint };
        if !(row.frequency_hz > 0.0 && row.frequency_hz.is_finite()) {
            return Err(wrong("frequency_hz", row.frequency_hz, " of hertz"));
        }
        if !(row.damping_ratio > 0.0 && row.damping_ratio < 1.0) {
            return Err(wrong("damping_ratio", row.damping_ratio, " below 1, such as 0.02 for 2 %"));
        }
        if !(row.deviation >= 0.0 && row.deviation.is_finite()) {
            return Err(wrong("deviation", row.deviation, ", the standard deviation of the ratio, or 0"));
        }
        let omega = TAU * row.frequency_hz;
        ratios.push(MeasuredRatio { omega, ratio: row.damping_ratio, deviation: row.deviation });
    }
    if ratios.is_empty() { Err(RatioFileError::Empty { file }) } else { Ok(ratios) }
}
