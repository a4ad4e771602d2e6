//! The amplitude spectrum of a record on a logarithmic axis, with the fitted harmonics as points.

use super::figure::{Axis, Data, Figure, Look};
use super::pyramid::Pyramid;
use super::style::Palette;
use crate::measurement::ChannelFit;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A spectrum with the harmonics that were fitted.
pub(crate) fn figure(palette: &Palette, spectrum: &Arc<Pyramid>, fit: &ChannelFit, omega: f64, unit: &str) -> Figure {
    let frequency = omega / TAU;
    let floor = spectrum.range()[0].max(f64::MIN_POSITIVE);
    let height = |y: &faer::c64| y.re.hypot(y.im);
    let harmonics = fit.amplitudes.iter().enumerate();
    let points = harmonics.clone().map(|(h, y)| [(h + 1) as f64 * frequency, height(y).max(floor)]).collect();
    let deviations = harmonics.map(|(h, y)| if height(y) > floor { fit.deviation(h + 1) } else { 0.0 }).collect();
    Figure::new("Spectrum", Axis::new("Frequency", "Hz"), Axis::log("Amplitude", unit).peak())
        .with("measured", palette.measured, Look::Line(1.2), Data::Record(Arc::clone(spectrum)))
        .points("fitted harmonics", palette.model, Look::Rings(4.5), points)
        .deviation(deviations)
}
