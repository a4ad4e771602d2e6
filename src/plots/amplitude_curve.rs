//! Frequency and damping ratio of one mode over its amplitude, measured and modelled: what the envelope of a decay tells.

use super::figure::{Axis, Figure, Look};
use super::style::Palette;
use crate::diagnosis::records::amplitude::AmplitudePoint;
use crate::diagnosis::records::compare::ModeCurve;
use crate::display::words;
use crate::measurement::Quantity;

/// Points from which on a curve says something.
pub const LEAST_POINTS: usize = 3;

/// Damping ratio over amplitude (`ratio`), else frequency over amplitude.
pub fn figure(curve: &ModeCurve, ratio: bool, palette: &Palette) -> Figure {
    let quantity = curve.channel.split('@').next().and_then(Quantity::from_word);
    let name = quantity.map_or("Amplitude", |q| words::axis(q, false));
    let y = if ratio { Axis::new("Damping ratio", "%") } else { Axis::new("Frequency", "Hz") };
    let points = |list: &[AmplitudePoint]| -> Vec<[f64; 2]> {
        list.iter().map(|p| [p.amplitude, if ratio { 100.0 * p.damping_ratio } else { p.frequency_hz }]).collect()
    };
    Figure::new(if ratio { "Damping ratio" } else { "Frequency" }, Axis::of(name), y)
        .points("measured", palette.measured, Look::Dots(3.0), points(&curve.measured))
        .points("model", palette.model, Look::Line(1.6), points(&curve.model))
}
