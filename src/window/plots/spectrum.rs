//! The amplitude spectrum of a record on a logarithmic axis, with the fitted harmonics as points.

use super::figure::{Axis, Data, Figure, Look};
use super::pyramid::Pyramid;
use super::show::Stack;
use crate::measurement::ChannelFit;
use crate::window::widgets::UiExt;
use crate::window::words;
use egui::Ui;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Shows a spectrum with the harmonics that were fitted.
pub fn show(ui: &mut Ui, id: &str, spectrum: &Arc<Pyramid>, fit: &ChannelFit, omega: f64, unit: &str) {
    let palette = ui.palette();
    let frequency = omega / TAU;
    let floor = spectrum.range()[0].max(f64::MIN_POSITIVE);
    let height = |y: &faer::c64| y.re.hypot(y.im);
    let harmonics = fit.amplitudes.iter().enumerate();
    let points = harmonics.clone().map(|(h, y)| [(h + 1) as f64 * frequency, height(y).max(floor)]).collect();
    let deviations = harmonics.map(|(h, y)| if height(y) > floor { fit.deviation(h + 1) } else { 0.0 }).collect();
    let figure = Figure::new("Spectrum", Axis::new("Frequency", "Hz"), Axis::log("Amplitude", unit))
        .with("measured", palette.measured, Look::Line(1.2), Data::Record(Arc::clone(spectrum)))
        .points("fitted harmonics", palette.model, Look::Rings(4.5), points)
        .deviation(deviations);
    Stack { id, title: &words::capital(id), figures: vec![(figure, 1.0)], keys: true }.show(ui);
}
