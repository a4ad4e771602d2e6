//! One channel of a record that is not steady as it was measured: over time, and its amplitude spectrum.

use super::figure::{Axis, Data, Figure, Look};
use super::pyramid::Pyramid;
use super::record_residual::spectrum_of;
use super::style::Palette;
use crate::display::words;
use crate::measurement::{Channel, TransientRun};
use std::sync::Arc;

/// A channel, ready to be drawn at any zoom.
#[derive(Debug, Clone)]
pub struct UnsteadyRecord {
    channel: Channel,
    samples: Arc<Pyramid>,
    spectrum: Option<Arc<Pyramid>>,
}

impl UnsteadyRecord {
    /// Channel number `channel` of a record; `None` where it has no such channel.
    pub fn new(run: &TransientRun, channel: usize) -> Option<Self> {
        let of = run.channels().get(channel)?.clone();
        let samples = run.samples(channel);
        Some(Self {
            channel: of,
            samples: Arc::new(Pyramid::new(run.time(), samples)),
            spectrum: spectrum_of(samples, run.step()),
        })
    }

    fn axis(&self) -> Axis {
        Axis::of(words::axis(self.channel.quantity, false))
    }

    /// The samples over time.
    pub fn over_time(&self, palette: &Palette, title: &str) -> Figure {
        figure(palette, title, [Axis::new("Time", "s"), self.axis()], &self.samples)
    }

    /// The amplitude spectrum through a Hann window; `None` of a record that is too short.
    pub fn over_frequency(&self, palette: &Palette, title: &str) -> Option<Figure> {
        let y = Axis::log("Amplitude", &self.axis().unit).peak();
        Some(figure(palette, title, [Axis::new("Frequency", "Hz"), y], self.spectrum.as_ref()?))
    }
}

fn figure(palette: &Palette, title: &str, [x, y]: [Axis; 2], data: &Arc<Pyramid>) -> Figure {
    let data = Data::Record(Arc::clone(data));
    Figure::new(title, x, y).with("measured", palette.measured, Look::Line(1.2), data)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::UnsteadyRecord;
    use crate::measurement::transient_run::TransientLabel;
    use crate::measurement::{Channel, Kind, Quantity, Record, TransientRun};
    use crate::plots::figure::Data;
    use crate::plots::style::Palette;
    use std::f64::consts::TAU;
    use std::sync::Arc;

    /// A ringing of 40 Hz that dies away peaks there, on an axis that does not go below 120 dB.
    #[test]
    fn a_decay_peaks_at_its_frequency() {
        let time: Vec<f64> = (0..4000).map(|k| f64::from(k) * 1e-3).collect();
        let samples = time.iter().map(|t| (-t).exp() * (TAU * 40.0 * t).cos()).collect();
        let channel = Channel { quantity: Quantity::Acceleration, dof: 0, label: "1".into() };
        let record = Arc::new(Record::new(time, vec![channel], vec![samples]).unwrap());
        let label = TransientLabel { file: "decay.csv".into(), kind: Kind::Decay, enabled: true, ..Default::default() };
        let run = TransientRun::new(label, record, &[]).unwrap();
        let shown = UnsteadyRecord::new(&run, 0).unwrap();
        let figure = shown.over_frequency(Palette::light(), "Spectrum").unwrap();
        assert_eq!((figure.x.unit.as_str(), figure.y.unit.as_str()), ("Hz", "m/s²"));
        let Data::Record(lines) = &figure.series[0].data else { panic!("a record") };
        let points = lines.polyline(0.0, 500.0, 4000);
        let peak = points.iter().max_by(|a, b| a[1].total_cmp(&b[1])).unwrap();
        assert!((peak[0] - 40.0).abs() < 0.5, "{peak:?}");
        let [low, high] = lines.range();
        assert!(low >= 1e-6 * high * (1.0 - 1e-12));
        assert!(UnsteadyRecord::new(&run, 1).is_none());
    }
}
