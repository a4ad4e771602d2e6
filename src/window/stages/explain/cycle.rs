//! One period of a channel, and the loop of force over displacement, both from their harmonics.

use crate::explain::compare::ChannelComparison;
use crate::measurement::{HarmonicFit, Quantity};
use crate::window::format;
use crate::window::plots::figure::Axis;
use crate::window::plots::{curve, frame, keys, ticks};
use crate::window::solid::frame::round_step;
use crate::window::widgets::UiExt;
use crate::window::words;
use egui::Ui;
use egui_plot::{GridInput, GridMark, LineStyle};
use faer::c64;
use std::f64::consts::TAU;

/// Samples a period.
const SAMPLES: usize = 240;

/// A channel of one run, measured and modelled.
pub struct Cycle<'a> {
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
    let at = |k: usize| {
        let t = TAU * k as f64 / SAMPLES as f64;
        let one = |(h, y): (usize, &c64)| {
            let (s, c) = ((h + 1) as f64 * t).sin_cos();
            y.re * c - y.im * s
        };
        amplitudes.iter().enumerate().map(one).sum()
    };
    (0..=SAMPLES).map(at).collect()
}

/// A factor and prefix by which a largest value reads well, in steps of a thousand.
fn scaled(largest: f64) -> (f64, &'static str) {
    const PREFIXES: [(f64, &str); 5] = [(1.0, ""), (1e3, "m"), (1e6, "µ"), (1e9, "n"), (1e12, "p")];
    PREFIXES.into_iter().find(|(factor, _)| largest * factor >= 1.0).unwrap_or((1.0, ""))
}

/// Lines of a linear axis at round numbers.
pub fn round(input: GridInput) -> Vec<GridMark> {
    ticks::marks(&Axis::new("", ""), &input)
}

/// The same on an axis so many points high, far enough apart for their numbers.
pub fn lines(height: f32) -> impl Fn(GridInput) -> Vec<GridMark> {
    // The names under the axis take a part of the height.
    let parts = f64::from((height - 30.0) / 40.0).max(1.5);
    move |input| {
        let (low, high) = input.bounds;
        let step = round_step((high - low).max(f64::MIN_POSITIVE), parts);
        let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
        (first..=last.min(first + 40)).map(|k| GridMark { value: k as f64 * step, step_size: step }).collect()
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

impl Cycle<'_> {
    fn legend(&self, ui: &mut Ui, rest: bool) {
        let palette = ui.palette();
        let mut entries = vec![(palette.measured, "measured"), (palette.model, "model")];
        if self.trial.is_some() {
            entries.push((palette.missing, "with the effect on trial"));
        }
        if rest {
            entries.push((palette.weak, "measured minus model"));
        }
        keys(ui, &entries);
    }

    /// One period.
    pub fn time(&self, ui: &mut Ui) {
        self.legend(ui, true);
        let palette = ui.palette();
        let (period, milli) = (TAU / self.fit.omega, 1e3);
        let points = |wave: &[f64]| -> Vec<[f64; 2]> {
            wave.iter().enumerate().map(|(k, y)| [milli * period * k as f64 / SAMPLES as f64, *y]).collect()
        };
        let of = |c: &ChannelComparison, model: bool| {
            let values: Vec<c64> = c.harmonics.iter().map(|h| if model { h.model } else { h.measured }).collect();
            wave(&values)
        };
        let (measured, model) = (of(self.now, false), of(self.now, true));
        let rest: Vec<f64> = measured.iter().zip(&model).map(|(y, m)| y - m).collect();
        let label = words::axis(self.quantity, self.rotation);
        let height = ui.available_height() - 6.0;
        frame(ui, "one period", "Time, ms", label)
            .include_x(0.0)
            .include_x(milli * period)
            .x_grid_spacer(round)
            .y_grid_spacer(lines(height))
            .height(height)
            .show(ui, |plot| {
                plot.line(curve("rest", points(&rest), palette.weak, 1.0));
                plot.line(curve("measured", points(&measured), palette.measured, 2.6));
                plot.line(curve("model", points(&model), palette.model, 1.6));
                if let Some(trial) = self.trial {
                    let dashed = curve("trial", points(&of(trial, true)), palette.missing, 1.8);
                    plot.line(dashed.style(LineStyle::dashed_dense()));
                }
            });
    }

    /// Force of the first exciter over the displacement that the channel stands for.
    pub fn hysteresis(&self, ui: &mut Ui) {
        let Some(force) = self.fit.channels.iter().find(|c| c.channel.quantity == Quantity::Force) else {
            ui.empty("No force", "The run has no force channel.");
            return;
        };
        self.legend(ui, false);
        let palette = ui.palette();
        let order = self.quantity.derivatives().unwrap_or(0);
        let displacement = |c: &ChannelComparison, model: bool| {
            let one = |h: &crate::explain::compare::HarmonicComparison| {
                let value = if model { h.model } else { h.measured };
                value / c64::new(0.0, h.harmonic as f64 * self.fit.omega).powi(order)
            };
            wave(&c.harmonics.iter().map(one).collect::<Vec<_>>())
        };
        let (measured, model) = (displacement(self.now, false), displacement(self.now, true));
        let (factor, prefix) = scaled(largest(&measured).max(largest(&model)));
        let force_wave = wave(&force.amplitudes);
        let points =
            |x: &[f64]| -> Vec<[f64; 2]> { x.iter().zip(&force_wave).map(|(x, f)| [factor * x, *f]).collect() };
        let base = if self.rotation { "rad" } else { "m" };
        let x =
            format!("Displacement at DOF {}, {prefix}{base}", self.now.channel.rsplit('@').next().unwrap_or_default());
        let y = format!("Force at DOF {}, N", force.channel.label);
        let height = ui.available_height() - 6.0;
        frame(ui, "loop", &x, &y)
            .set_margin_fraction(egui::vec2(0.05, 0.08))
            .x_grid_spacer(round)
            .y_grid_spacer(lines(height))
            .height(height)
            .coordinates_formatter(
                egui_plot::Corner::RightTop,
                egui_plot::CoordinatesFormatter::new(move |p, _| {
                    format!("{} {prefix}{base}   {} N", format::significant(p.x, 3), format::significant(p.y, 3))
                }),
            )
            .show(ui, |plot| {
                plot.line(curve("measured", points(&measured), palette.measured, 2.6));
                plot.line(curve("model", points(&model), palette.model, 1.6));
                if let Some(trial) = self.trial {
                    let dashed = curve("trial", points(&displacement(trial, true)), palette.missing, 1.8);
                    plot.line(dashed.style(LineStyle::dashed_dense()));
                }
            });
    }
}

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
