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
        let (measured, model) = (run.samples(number), found.model.get(k)?.as_slice());
        let left: Vec<f64> = measured.iter().zip(model).map(|(y, m)| y - m).collect();
        let three = [measured, model, &left];
        Some(Self {
            channel: channel.to_string(),
            file: run.file.clone(),
            axis: Axis::of(words::axis(channel.quantity, rotation)),
            samples: three.map(|y| Arc::new(Pyramid::new(&run.time()[..y.len()], y))),
            spectra: spectra(three, run.step()),
            spectrogram: Spectrogram::new(&left, measured, (run.time()[0], run.step())),
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
        vec![both, Figure::new("What is left", x(), y).with("left", palette.missing, Look::Line(1.2), left)]
    }

    /// Amplitude spectra of what was measured, of the model's record and of what is left; `None` of a record that is too short.
    pub fn spectra(&self, palette: &Palette) -> Option<Figure> {
        let [measured, model, left] = self.spectra.as_ref()?.each_ref().map(|y| Data::Record(Arc::clone(y)));
        Some(
            Figure::new("Spectra", Axis::new("Frequency", "Hz"), Axis::log("Amplitude", &self.axis.unit))
                // What is left of noise is the noise that was measured: it must not hide it.
                .with("left", palette.missing, Look::Line(1.2), left)
                .with("measured", palette.measured, Look::Line(1.2), measured)
                .with("model", palette.model, Look::Line(1.2), model),
        )
    }

    /// What is left over time and frequency, relative to the largest of what was measured; `None` of a record that is too short.
    pub fn spectrogram(&self) -> Option<&Spectrogram> {
        self.spectrogram.as_ref()
    }
}

/// Amplitude spectra of samples `step` s apart.
fn spectra(three: [&[f64]; 3], step: f64) -> Option<Three> {
    let line = |y: &[f64]| {
        let spectrum = Spectrum::new(y, step)?;
        let lines = 1..spectrum.amplitude.len();
        let frequencies: Vec<f64> = lines.clone().map(|k| spectrum.frequency_hz(k)).collect();
        let amplitudes: Vec<f64> = lines.map(|k| spectrum.amplitude[k].max(f64::MIN_POSITIVE)).collect();
        Some(Arc::new(Pyramid::new(&frequencies, &amplitudes)))
    };
    let [measured, model, left] = three;
    Some([line(measured)?, line(model)?, line(left)?])
}
