//! The amplitude spectrum of a record on a logarithmic axis, with the fitted harmonics as points.

use super::figure::{Axis, Figure, Look};
use super::show::Stack;
use crate::math::spectrum::Spectrum;
use crate::measurement::ChannelFit;
use crate::window::widgets::UiExt;
use crate::window::words;
use egui::Ui;
use std::f64::consts::TAU;

/// Shows a spectrum up to a little above the highest harmonic.
pub fn show(ui: &mut Ui, id: &str, spectrum: &Spectrum, fit: &ChannelFit, omega: f64, unit: &str) {
    let palette = ui.palette();
    let frequency = omega / TAU;
    let last = frequency * (fit.amplitudes.len() as f64 + 1.5);
    let shown = spectrum.amplitude.len().min((last / spectrum.resolution_hz).ceil() as usize + 2);
    let largest = spectrum.amplitude.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let floor = 1e-7 * largest;
    let line = (1..shown).map(|k| [spectrum.frequency_hz(k), spectrum.amplitude[k].max(floor)]).collect();
    let height = |y: &faer::c64| y.re.hypot(y.im);
    let harmonics = fit.amplitudes.iter().enumerate();
    let points = harmonics.clone().map(|(h, y)| [(h + 1) as f64 * frequency, height(y).max(floor)]).collect();
    let deviations = harmonics.map(|(h, y)| if height(y) > floor { fit.deviation(h + 1) } else { 0.0 }).collect();
    let figure = Figure::new("Spectrum", Axis::new("Frequency", "Hz"), Axis::log("Amplitude", unit))
        .points("measured", palette.measured, Look::Line(1.2), line)
        .points("fitted harmonics", palette.model, Look::Rings(4.5), points)
        .deviation(deviations);
    Stack { id, title: &words::capital(id), figures: vec![(figure, 1.0)], keys: true }.show(ui);
}
