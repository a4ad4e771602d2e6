//! One period of a channel, and the loop of force over displacement, both from their harmonics.

use super::figure::{Axis, Figure, Look};
use super::style::Palette;
use crate::diagnosis::residual::comparison::{ChannelComparison, HarmonicComparison};
use crate::display::words;
use crate::measurement::{HarmonicFit, Quantity};
use faer::c64;
use std::f64::consts::TAU;

/// Samples a period.
const SAMPLES: usize = 240;

/// A channel of one run, measured and modelled.
pub(crate) struct Cycle<'a> {
    /// Index of the run.
    pub run: usize,
    /// Harmonics of the run, for period and force.
    pub fit: &'a HarmonicFit,
    /// Channel of the comparison.
    pub now: &'a ChannelComparison,
    /// With the effect on trial.
    pub trial: Option<&'a ChannelComparison>,
    /// Quantity of the channel.
    pub quantity: Quantity,
    /// Whether its DOF is a rotation.
    pub rotation: bool,
}

/// `Re sum y_h exp(i h t)` at `SAMPLES + 1` points of a turn.
fn wave(amplitudes: &[c64]) -> Vec<f64> {
    let sum_at = |k: usize| {
        let t = TAU * k as f64 / SAMPLES as f64;
        let harmonic_at = |(h, y): (usize, &c64)| {
            let (s, c) = ((h + 1) as f64 * t).sin_cos();
            y.re * c - y.im * s
        };
        amplitudes.iter().enumerate().map(harmonic_at).sum()
    };
    (0..=SAMPLES).map(sum_at).collect()
}

/// A factor and prefix by which a largest value reads well, in steps of a thousand.
pub(super) fn scaled(largest: f64) -> (f64, &'static str) {
    const PREFIXES: [(f64, &str); 5] = [(1.0, ""), (1e3, "m"), (1e6, "µ"), (1e9, "n"), (1e12, "p")];
    PREFIXES.into_iter().find(|(factor, _)| largest * factor >= 1.0).unwrap_or((1.0, ""))
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

impl Cycle<'_> {
    /// Measured, modelled and tried points of one curve.
    fn curves(&self, figure: Figure, palette: &Palette, points: &Points<'_>) -> Figure {
        let figure = figure.points("measured", palette.measured, Look::Line(2.6), points(self.now, false)).points(
            "model",
            palette.model,
            Look::Line(1.6),
            points(self.now, true),
        );
        match self.trial {
            Some(t) => figure.points("with the effect on trial", palette.missing, Look::Dashed(1.8), points(t, true)),
            None => figure,
        }
    }

    /// One period.
    pub(crate) fn time(&self, palette: &Palette) -> Figure {
        let (period, milli) = (TAU / self.fit.omega, 1e3);
        let wave_of = |c: &ChannelComparison, model: bool| {
            let values: Vec<c64> = c.harmonics.iter().map(|h| if model { h.model } else { h.measured }).collect();
            wave(&values)
        };
        let points = |wave: Vec<f64>| -> Vec<[f64; 2]> {
            wave.into_iter().enumerate().map(|(k, y)| [milli * period * k as f64 / SAMPLES as f64, y]).collect()
        };
        let rest = wave_of(self.now, false).iter().zip(wave_of(self.now, true)).map(|(y, m)| y - m).collect();
        let x = Axis::new("Time", "ms").include(&[0.0, milli * period]);
        let figure = Figure::new("One period", x, Axis::of(words::axis(self.quantity, self.rotation))).points(
            "measured minus model",
            palette.weak,
            Look::Line(1.0),
            points(rest),
        );
        self.curves(figure, palette, &|c, model| points(wave_of(c, model)))
    }

    /// Force of the first exciter over the displacement that the channel stands for; none where no force is measured.
    pub(crate) fn hysteresis(&self, palette: &Palette) -> Option<Figure> {
        let force = self.fit.channels.iter().find(|c| c.channel.quantity == Quantity::Force)?;
        let order = self.quantity.derivatives().unwrap_or(0);
        let displacement = |c: &ChannelComparison, model: bool| {
            let displacement_of = |h: &HarmonicComparison| {
                let value = if model { h.model } else { h.measured };
                value / c64::new(0.0, h.harmonic as f64 * self.fit.omega).powi(order)
            };
            wave(&c.harmonics.iter().map(displacement_of).collect::<Vec<_>>())
        };
        let largest = largest(&displacement(self.now, false)).max(largest(&displacement(self.now, true)));
        let (factor, prefix) = scaled(largest);
        let force_wave = wave(&force.amplitudes);
        let points = |x: Vec<f64>| x.into_iter().zip(&force_wave).map(|(x, f)| [factor * x, *f]).collect();
        let unit = format!("{prefix}{}", if self.rotation { "rad" } else { "m" });
        let at = self.now.channel.rsplit('@').next().unwrap_or_default();
        let x = Axis::new(&format!("Displacement at DOF {at}"), &unit);
        let y = Axis::new(&format!("Force at DOF {}", force.channel.label), "N");
        let mut figure = self.curves(Figure::new("Loop", x, y), palette, &|c, model| points(displacement(c, model)));
        figure.margin = 0.05;
        Some(figure)
    }

    /// Title of what is exported.
    pub(crate) fn title(&self, what: &str) -> String {
        format!("{}, {what}, run {}", self.now.channel, self.run + 1)
    }
}

/// Points x, y of a channel of a comparison, measured or (true) of the model.
type Points<'a> = dyn Fn(&ChannelComparison, bool) -> Vec<[f64; 2]> + 'a;

#[cfg(test)]
mod tests {
    use super::{SAMPLES, scaled, wave};
    use faer::c64;
    use std::f64::consts::TAU;

    #[test]
    fn a_wave_is_the_sum_of_its_harmonics() {
        let samples = wave(&[c64::new(1.0, -2.0), c64::new(0.0, 0.5)]);
        for (k, y) in samples.iter().enumerate() {
            let t = TAU * k as f64 / SAMPLES as f64;
            assert!((y - (t.cos() + 2.0 * t.sin() - 0.5 * (2.0 * t).sin())).abs() < 1e-12);
        }
        assert!((samples[0] - samples[SAMPLES]).abs() < 1e-12, "it closes");
    }

    #[test]
    fn prefixes_make_numbers_readable() {
        assert_eq!(scaled(0.0042), (1e3, "m"));
        assert_eq!(scaled(3e-5), (1e6, "µ"));
        assert_eq!(scaled(0.0), (1.0, ""));
    }
}
