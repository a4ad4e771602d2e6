//! The amplitude spectrum of a record on a logarithmic axis, with the fitted harmonics as points.

use super::{axis, curve, frame, keys, log};
use crate::math::spectrum::Spectrum;
use crate::measurement::ChannelFit;
use crate::window::format;
use crate::window::widgets::UiExt;
use egui::Ui;
use egui_plot::{AxisHints, CoordinatesFormatter, Corner, HPlacement, MarkerShape, PlotPoints, Points};
use std::f64::consts::TAU;

/// Shows a spectrum up to a little above the highest harmonic.
pub fn show(ui: &mut Ui, id: &str, spectrum: &Spectrum, fit: &ChannelFit, omega: f64, unit: &str) {
    let palette = ui.palette();
    let frequency = omega / TAU;
    let last = frequency * (fit.amplitudes.len() as f64 + 1.5);
    let shown = spectrum.amplitude.len().min((last / spectrum.resolution_hz).ceil() as usize + 2);
    let largest = spectrum.amplitude.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let floor = 1e-7 * largest;
    let line: Vec<[f64; 2]> =
        (1..shown).map(|k| [spectrum.frequency_hz(k), spectrum.amplitude[k].max(floor).log10()]).collect();
    let harmonic = |(h, y): (usize, &faer::c64)| [(h + 1) as f64 * frequency, y.re.hypot(y.im).max(floor).log10()];
    let points: Vec<[f64; 2]> = fit.amplitudes.iter().enumerate().map(harmonic).collect();
    keys(ui, &[(palette.measured, "measured"), (palette.model, "fitted harmonics")]);
    let y_axis = axis(AxisHints::new_y(), palette, &format!("Amplitude, {unit}"))
        .placement(HPlacement::Left)
        .min_thickness(52.0)
        .formatter(|mark, _| log::label(mark.value));
    let read = move |p: &egui_plot::PlotPoint, _: &egui_plot::PlotBounds| {
        format!("{} Hz   {} {unit}", format::significant(p.x, 4), format::significant(10f64.powf(p.y), 3))
    };
    frame(ui, id, "Frequency, Hz", "")
        .custom_y_axes(vec![y_axis])
        .y_grid_spacer(|input| log::decades(&input))
        .coordinates_formatter(Corner::RightTop, CoordinatesFormatter::new(read))
        .height(ui.available_height() - 4.0)
        .show(ui, |plot| {
            plot.line(curve("spectrum", line, palette.measured, 1.2));
            let markers = Points::new("harmonics", PlotPoints::from(points));
            plot.points(markers.shape(MarkerShape::Circle).filled(false).radius(4.5).color(palette.model));
        });
}
