//! A time record with the fitted curve on top, and the residual under it on the same time axis.

use super::{curve, frame, keys, readout};
use crate::measurement::ChannelFit;
use crate::window::derived::Trace;
use crate::window::widgets::UiExt;
use egui::{Id, Ui};
use egui_plot::PlotUi;
use faer::c64;

/// Periods shown at first.
const PERIODS: f64 = 6.0;

/// `offset + slope (t - t_mid) + Re sum_h Y_h exp(i h omega t)`.
pub fn fitted(fit: &ChannelFit, omega: f64, middle: f64, t: f64) -> f64 {
    let turn = c64::new((omega * t).cos(), (omega * t).sin());
    let mut power = c64::new(1.0, 0.0);
    let mut sum = fit.offset + fit.slope * (t - middle);
    for y in &fit.amplitudes {
        power *= turn;
        sum += y.re * power.re - y.im * power.im;
    }
    sum
}

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
    /// Shows both plots in the room there is.
    pub fn show(&self, ui: &mut Ui) {
        let palette = ui.palette();
        let [start, end] = self.trace.record.span();
        let period = std::f64::consts::TAU / self.omega;
        let visible = (start + PERIODS * period).min(end);
        let group = Id::unique(("record", self.id));
        keys(ui, &[(palette.measured, "measured"), (palette.model, "fitted harmonics"), (palette.missing, "residual")]);
        let height = ui.available_height() - 4.0;
        let unit = self.axis.rsplit(", ").next().unwrap_or("");
        let (corner, format) = readout("t, s", unit);
        frame(ui, &format!("{} record", self.id), "", self.axis)
            .height(0.62 * height)
            .default_x_bounds(start, visible)
            .link_axis(group, [true, false])
            .link_cursor(group, [true, false])
            .coordinates_formatter(corner, format)
            .show_axes([false, true])
            .show(ui, |plot| {
                let [from, to, columns] = seen(plot);
                plot.line(curve(
                    "measured",
                    self.trace.record.polyline(from, to, columns as usize),
                    palette.measured,
                    1.3,
                ));
                plot.line(curve("fitted", self.curve(from, to, columns), palette.model, 1.5));
            });
        let (corner, format) = readout("t, s", unit);
        frame(ui, &format!("{} residual", self.id), "Time, s", "Residual")
            .height(0.38 * height)
            .default_x_bounds(start, visible)
            .link_axis(group, [true, false])
            .link_cursor(group, [true, false])
            .coordinates_formatter(corner, format)
            .include_y(0.0)
            .show(ui, |plot| {
                let [from, to, columns] = seen(plot);
                plot.line(curve(
                    "residual",
                    self.trace.residual.polyline(from, to, columns as usize),
                    palette.missing,
                    1.1,
                ));
            });
    }

    fn curve(&self, from: f64, to: f64, columns: f64) -> Vec<[f64; 2]> {
        let [start, end] = self.trace.record.span();
        let (from, to) = (from.max(start), to.min(end));
        // Beyond this many periods the curve is a band: its extremes are those of the record.
        let n = (2.0 * columns) as usize;
        let middle = 0.5 * (start + end);
        (0..=n)
            .map(|k| {
                let t = from + (to - from) * k as f64 / n as f64;
                [t, fitted(self.fit, self.omega, middle, t)]
            })
            .collect()
    }
}

/// First and last time in sight and the columns of pixels between.
fn seen(plot: &PlotUi<'_>) -> [f64; 3] {
    let bounds = plot.plot_bounds();
    let columns = f64::from(plot.transform().frame().width()).max(1.0);
    [bounds.min()[0], bounds.max()[0], columns]
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
