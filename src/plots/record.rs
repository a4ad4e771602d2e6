//! A time record with the fitted curve on top, and the residual under it on the same time axis.

use super::figure::{Axis, Curve, Data, Figure, Look};
use super::style::Palette;
use super::trace::{Trace, fitted};
use crate::display::words;
use crate::measurement::ChannelFit;
use std::sync::Arc;

/// Periods shown at first.
const PERIODS: f64 = 6.0;

/// What the plot needs.
#[derive(Debug, Clone, Copy)]
pub struct RecordPlot<'a> {
    /// Samples.
    pub trace: &'a Trace,
    /// Fit of the channel.
    pub fit: &'a ChannelFit,
    /// Fundamental, rad/s.
    pub omega: f64,
    /// Quantity and unit.
    pub axis: &'a str,
    /// Changes when another record is shown, so that the axes start afresh.
    pub id: &'a str,
}

impl RecordPlot<'_> {
    /// Record with fit over the residual, each with its share of the height.
    pub fn figures(&self, palette: &Palette) -> Vec<(Figure, f32)> {
        let [start, end] = self.trace.record.span();
        let visible = Some([start, (start + PERIODS * std::f64::consts::TAU / self.omega).min(end)]);
        let time = || Axis::new("Time", "s");
        let mut record = Figure::new("Record", time(), Axis::of(self.axis))
            .with("measured", palette.measured, Look::Line(1.3), Data::Record(Arc::clone(&self.trace.record)))
            .with("fitted harmonics", palette.model, Look::Line(1.5), self.fitted([start, end]));
        let y = Axis::new("Residual", self.axis.rsplit(", ").next().unwrap_or("")).include(&[0.0]);
        let rest = Data::Record(Arc::clone(&self.trace.residual));
        let mut residual = Figure::new("Residual", time(), y).with("residual", palette.missing, Look::Line(1.1), rest);
        (record.start, residual.start) = (visible, visible);
        vec![(record, 0.60), (residual, 0.40)]
    }

    /// Beyond about a period a column of pixels the curve is a band: its extremes are those of the record.
    fn fitted(&self, span: [f64; 2]) -> Data {
        let (fit, omega, middle) = (self.fit.clone(), self.omega, 0.5 * (span[0] + span[1]));
        Data::Function(Curve(Arc::new(move |t| fitted(&fit, omega, middle, t))), span)
    }
}

/// Records of all channels of a run under each other on one axis of time.
pub fn lane_figures(palette: &Palette, shown: &[(&ChannelFit, Arc<Trace>)], omega: f64) -> Vec<(Figure, f32)> {
    let lane = |(fit, trace): &(&ChannelFit, Arc<Trace>)| {
        let [start, end] = trace.record.span();
        let unit = words::axis(fit.channel.quantity, false).rsplit(", ").next().unwrap_or("");
        let mut figure =
            Figure::new(&fit.channel.to_string(), Axis::new("Time", "s"), Axis::new(&fit.channel.to_string(), unit))
                .with("measured", palette.measured, Look::Line(1.2), Data::Record(Arc::clone(&trace.record)));
        figure.start = Some([start, (start + PERIODS * std::f64::consts::TAU / omega).min(end)]);
        (figure, 1.0 / shown.len() as f32)
    };
    shown.iter().map(lane).collect()
}

#[cfg(test)]
mod tests {
    use super::fitted;
    use crate::measurement::{Channel, ChannelFit, Quantity};
    use faer::{Mat, c64};

    #[test]
    fn the_fitted_curve_is_its_definition() {
        let channel = Channel { quantity: Quantity::Acceleration, dof: 0, label: "1".to_owned() };
        let amplitudes = vec![c64::new(2.0, -0.5), c64::new(0.1, 0.3)];
        let fit = ChannelFit { channel, offset: 0.7, slope: 0.2, amplitudes, covariance: Mat::zeros(4, 4), noise: 0.0 };
        for k in 0..20 {
            let (t, w) = (0.137 * f64::from(k), 11.0);
            let by_parts =
                0.7 + 0.2 * (t - 1.0) + 2.0 * (w * t).cos() + 0.5 * (w * t).sin() + 0.1 * (2.0 * w * t).cos()
                    - 0.3 * (2.0 * w * t).sin();
            assert!((fitted(&fit, w, 1.0, t) - by_parts).abs() < 1e-12);
        }
    }
}
