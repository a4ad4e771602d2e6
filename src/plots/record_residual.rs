//! One channel of a record that is not steady against the model's record: over time with what is left below, as spectra, and
//! what is left over time and frequency. All that takes longer than a frame is done once, by [`RecordResidual::new`].

use super::figure::{Axis, Data, Figure, Look};
use super::pyramid::Pyramid;
use super::spectrogram::Spectrogram;
use super::style::Palette;
use crate::diagnosis::records::compare::OneRecord;
use crate::display::words;
use crate::math::spectrum::Spectrum;
use crate::measurement::TransientRun;
use crate::structure::Structure;
use std::sync::Arc;

/// Measured, of the model, and left, ready to be drawn.
type Three = [Arc<Pyramid>; 3];

/// A channel of motion with what the model gives.
#[derive(Debug, Clone)]
pub struct RecordResidual {
    /// Name of the channel.
    pub channel: String,
    /// File of the record.
    pub file: String,
    axis: Axis,
    samples: Three,
    spectra: Option<Three>,
    spectrogram: Option<Spectrogram>,
}

impl RecordResidual {
    /// Of the channel of that name, else of the one of greatest error; `None` where the record has no such channel.
    pub fn new(structure: &Structure, run: &TransientRun, found: &OneRecord, name: Option<&str>) -> Option<Self> {
        let worst = |a: &usize, b: &usize| found.channels[*a].1[0].total_cmp(&found.channels[*b].1[0]);
        let named = |name: &str| found.channels.iter().position(|(own, _)| own == name);
        let k = name.map_or_else(|| (0..found.channels.len()).max_by(worst), named)?;
        let number = run.channels().iter().position(|c| c.to_string() == found.channels[k].0)?;
        let channel = &run.channels()[number];
        let rotation = structure.dofs().get(channel.dof).is_some_and(|d| d.direction.is_rotation());
        let (measured, model) = (found.measured.get(k)?.as_slice(), found.model.get(k)?.as_slice());
        let step = (found.time.last()? - found.time.first()?) / (found.time.len().max(2) - 1) as f64;
        let left: Vec<f64> = measured.iter().zip(model).map(|(y, m)| y - m).collect();
        let three = [measured, model, &left];
        Some(Self {
            channel: channel.to_string(),
            file: run.file.clone(),
            axis: Axis::of(words::axis(channel.quantity, rotation)),
            samples: three.map(|y| Arc::new(Pyramid::new(&found.time, y))),
            spectra: spectra(three, step),
            spectrogram: Spectrogram::new(&left, measured, found.time[0], step),
        })
    }

    /// Name of the channel with its record.
    pub fn title(&self) -> String {
        format!("{} of {}", self.channel, self.file)
    }

    /// Measured and modelled over time; what is left below on a scale of its own.
    pub fn over_time(&self, palette: &Palette) -> Vec<Figure> {
        let [measured, model, left] = self.samples.each_ref().map(|y| Data::Record(Arc::clone(y)));
        let x = || Axis::new("Time", "s");
        let both = Figure::new("Measured and modelled", x(), self.axis.clone())
            .with("measured", palette.measured, Look::Line(1.2), measured)
            .with("model", palette.model, Look::Line(1.2), model);
        let y = Axis { name: "Residual".to_owned(), ..self.axis.clone() };
        vec![both, Figure::new("What is left", x(), y).with("residual", palette.missing, Look::Line(1.2), left)]
    }

    /// Amplitude spectra of what was measured, of the model's record and of what is left; `None` of a record that is too short.
    pub fn spectra(&self, palette: &Palette) -> Option<Figure> {
        let [measured, model, left] = self.spectra.as_ref()?.each_ref().map(|y| Data::Record(Arc::clone(y)));
        Some(
            Figure::new("Spectra", Axis::new("Frequency", "Hz"), Axis::log("Amplitude", &self.axis.unit).peak())
                // What is left of noise is the noise that was measured: it must not hide it.
                .with("residual", palette.missing, Look::Line(1.2), left)
                .with("measured", palette.measured, Look::Line(1.2), measured)
                .with("model", palette.model, Look::Line(1.2), model),
        )
    }

    /// What is left over time and frequency, relative to the largest of what was measured; `None` of a record that is too short.
    pub fn spectrogram(&self) -> Option<&Spectrogram> {
        self.spectrogram.as_ref()
    }
}

/// Share of the largest line of what was measured below which no line is drawn: 120 dB, beyond the range of any converter.
const RANGE: f64 = 1e-6;
/// Share of the quiet tenth of the measured lines, their noise, below which no line is drawn: 20 dB.
const BELOW_NOISE: f64 = 0.1;

/// The amplitude that the least lines of a plot are drawn at: a model's record has no noise, and would take the axis down to
/// rounding errors.
fn floor(measured: &[f64]) -> f64 {
    let mut lines = measured.to_vec();
    let peak = lines.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let tenth = lines.len() / 10;
    let quiet = if lines.is_empty() { 0.0 } else { *lines.select_nth_unstable_by(tenth, f64::total_cmp).1 };
    (RANGE * peak).max(BELOW_NOISE * quiet)
}

/// Lines of a spectrum over frequency without the mean, none below `floor`.
fn lines(spectrum: &Spectrum, floor: f64) -> Arc<Pyramid> {
    let lines = 1..spectrum.amplitude.len();
    let frequencies: Vec<f64> = lines.clone().map(|k| spectrum.frequency_hz(k)).collect();
    let amplitudes: Vec<f64> = lines.map(|k| spectrum.amplitude[k].max(floor)).collect();
    Arc::new(Pyramid::new(&frequencies, &amplitudes))
}

/// Amplitude spectrum of samples `step` s apart that were measured; `None` where they are too few.
pub(super) fn spectrum_of(measured: &[f64], step: f64) -> Option<Arc<Pyramid>> {
    let spectrum = Spectrum::new(measured, step)?;
    let floor = floor(spectrum.amplitude.get(1..)?);
    Some(lines(&spectrum, floor))
}

/// Amplitude spectra of samples `step` s apart; the first are those that were measured.
fn spectra(three: [&[f64]; 3], step: f64) -> Option<Three> {
    let measured = Spectrum::new(three[0], step)?;
    let floor = floor(measured.amplitude.get(1..)?);
    let [_, model, left] = three;
    let line = |y: &[f64]| Some(lines(&Spectrum::new(y, step)?, floor));
    Some([lines(&measured, floor), line(model)?, line(left)?])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::spectra;
    use std::f64::consts::TAU;

    fn wave(n: usize, noise: f64) -> Vec<f64> {
        let mut seed = 1_u64;
        let sample = |k: usize| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (TAU * 0.05 * k as f64).cos() + noise * ((seed >> 33) as f64 / f64::from(1_u32 << 31) - 0.5)
        };
        (0..n).map(sample).collect()
    }

    /// Decades between the least and the largest line of all three.
    fn decades(noise: f64) -> f64 {
        let (measured, model) = (wave(4000, noise), wave(4000, 0.0));
        let left: Vec<f64> = measured.iter().zip(&model).map(|(y, m)| y - m).collect();
        let three = spectra([&measured, &model, &left], 1e-3).unwrap();
        let [low, high] = three.iter().map(|p| p.range()).fold([f64::MAX, 0.0], |[a, b], [l, h]| [a.min(l), b.max(h)]);
        (high / low).log10()
    }

    #[test]
    fn the_axis_of_spectra_ends_a_little_below_the_noise() {
        // Lines of white noise of amplitude 0.005 in 4000 samples lie near 1e-4.
        let noisy = decades(1e-2);
        assert!((4.0..5.6).contains(&noisy), "{noisy} decades");
        let quiet = decades(0.0);
        assert!((quiet - 6.0).abs() < 1e-9, "{quiet} decades without noise");
    }
}
