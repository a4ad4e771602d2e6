//! One channel of a record that is not steady against the model's record: over time with what is left below, as spectra, and
//! what is left over time and frequency.

use super::figure::{Axis, Data, Figure, Look};
use super::pyramid::Pyramid;
use super::spectrogram::Spectrogram;
use super::style::Palette;
use crate::diagnosis::records::compare::OneRecord;
use crate::display::words;
use crate::math::spectrum::Spectrum;
use crate::measurement::TransientRun;
use std::sync::Arc;

/// A channel of motion with what the model gives.
pub struct RecordResidual<'a> {
    run: &'a TransientRun,
    /// Number of the channel in the record.
    channel: usize,
    measured: &'a [f64],
    model: &'a [f64],
    left: Vec<f64>,
}

impl<'a> RecordResidual<'a> {
    /// Of the channel of that name, else of the one of greatest error; `None` where the record has no such channel.
    pub fn new(run: &'a TransientRun, found: &'a OneRecord, name: Option<&str>) -> Option<Self> {
        let worst = |a: &usize, b: &usize| found.channels[*a].1[0].total_cmp(&found.channels[*b].1[0]);
        let named = |name: &str| found.channels.iter().position(|(own, _)| own == name);
        let k = name.map_or_else(|| (0..found.channels.len()).max_by(worst), named)?;
        let is_it = |c: &crate::measurement::Channel| c.to_string() == found.channels[k].0;
        let channel = run.channels().iter().position(is_it)?;
        let model = found.model.get(k)?.as_slice();
        let samples = run.samples(channel);
        let left = samples.iter().zip(model).map(|(y, m)| y - m).collect();
        Some(Self { run, channel, measured: samples, model, left })
    }

    /// Name of the channel with its record.
    pub fn title(&self) -> String {
        format!("{} of {}", self.run.channels()[self.channel], self.run.file)
    }

    fn axis(&self) -> Axis {
        Axis::of(words::axis(self.run.channels()[self.channel].quantity, false))
    }

    /// Measured and modelled over time; what is left below on a scale of its own.
    pub fn over_time(&self, palette: &Palette) -> Vec<Figure> {
        let time = self.run.time();
        let list = |y: &[f64]| Data::Record(Arc::new(Pyramid::new(&time[..y.len()], y)));
        let x = || Axis::new("Time", "s");
        let both = Figure::new("Measured and modelled", x(), self.axis())
            .with("measured", palette.measured, Look::Line(1.2), list(self.measured))
            .with("model", palette.model, Look::Line(1.2), list(self.model));
        let y = Axis { name: format!("{} left", self.axis().name), ..self.axis() };
        let left = Figure::new("What is left", x(), y).with("left", palette.missing, Look::Line(1.2), list(&self.left));
        vec![both, left]
    }

    /// Amplitude spectra of what was measured, of the model's record and of what is left; `None` of a record that is too short.
    pub fn spectra(&self, palette: &Palette) -> Option<Figure> {
        let line = |y: &[f64]| {
            let spectrum = Spectrum::new(y, self.run.step())?;
            let at = |k: usize| [spectrum.frequency_hz(k), spectrum.amplitude[k].max(f64::MIN_POSITIVE)];
            Some((1..spectrum.amplitude.len()).map(at).collect::<Vec<[f64; 2]>>())
        };
        let record = |points: Vec<[f64; 2]>| {
            let (x, y): (Vec<f64>, Vec<f64>) = points.into_iter().map(|[x, y]| (x, y)).unzip();
            Data::Record(Arc::new(Pyramid::new(&x, &y)))
        };
        let [measured, model, left] = [line(self.measured)?, line(self.model)?, line(&self.left)?];
        let unit = self.axis().unit;
        Some(
            Figure::new("Spectra", Axis::new("Frequency", "Hz"), Axis::log("Amplitude", &unit))
                .with("measured", palette.measured, Look::Line(1.2), record(measured))
                .with("model", palette.model, Look::Line(1.2), record(model))
                .with("left", palette.missing, Look::Line(1.2), record(left)),
        )
    }

    /// What is left over time and frequency, relative to the largest of what was measured.
    pub fn spectrogram(&self) -> Option<Spectrogram> {
        Spectrogram::new(&self.left, self.measured, (self.run.time()[0], self.run.step()))
    }
}
