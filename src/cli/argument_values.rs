//! Values of arguments, checked as they are read.

use crate::exchange::export::Format;
use crate::exchange::records::harmonics::HIGHEST_HARMONIC;
use clap::builder::{PossibleValuesParser, TypedValueParser};

pub(super) fn paper(text: &str) -> Result<[u32; 2], String> {
    let fault = || "write width x height in points, from 200x150 to 8000x8000, such as 900x520".to_owned();
    let (width, height) = text.split_once('x').ok_or_else(fault)?;
    match (width.parse(), height.parse()) {
        (Ok(w), Ok(h)) if (200..=8000).contains(&w) && (150..=8000).contains(&h) => Ok([w, h]),
        _ => Err(fault()),
    }
}

pub(super) fn noise(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(ratio) if (0.0..=10.0).contains(&ratio) => Ok(ratio),
        _ => Err("give a ratio from 0 to 10, such as 0.05 for 5 %".to_owned()),
    }
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("give a frequency above 0 Hz, such as 10.4".to_owned()),
    }
}

pub(super) fn harmonics(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(count) if (1..=HIGHEST_HARMONIC).contains(&count) => Ok(count),
        _ => Err(format!("give a number of harmonics from 1 to {HIGHEST_HARMONIC}")),
    }
}

/// Parses a time limit, s.
pub(super) fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value <= 1e6 => Ok(value),
        _ => Err("give a number of seconds above 0, such as 10".to_owned()),
    }
}

pub(super) fn fraction(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(fraction) if (0.0..=1.0).contains(&fraction) => Ok(fraction),
        _ => Err("give a fraction from 0 (periodic) to 1 (from rest)".to_owned()),
    }
}

pub(super) fn format() -> impl TypedValueParser<Value = Format> {
    PossibleValuesParser::new(Format::ALL.map(Format::name))
        .try_map(|name| Format::from_name(&name).ok_or_else(|| format!("no format {name}")))
}
