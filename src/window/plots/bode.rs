//! Bode and Nyquist diagrams: the model's curve with the measured points on it.

use super::{axis, curve, frame, keys, log};
use crate::exchange::Project;
use crate::measurement::Quantity as Measured;
use crate::response::frequency_response::Quantity;
use crate::window::format;
use crate::window::widgets::UiExt;
use egui::{Id, Ui};
use egui_plot::{AxisHints, CoordinatesFormatter, Corner, GridMark, HPlacement, MarkerShape, PlotPoints, Points};
use faer::c64;
use std::f64::consts::TAU;

/// A receptance between two DOFs on a range of frequencies.
#[derive(Debug, Clone, PartialEq)]
pub struct Response {
    /// DOF whose displacement is divided by the force.
    pub response: usize,
    /// DOF at which the force acts.
    pub excitation: usize,
    /// Circular frequencies, rad/s, ascending.
    pub omega: Vec<f64>,
    /// Receptance, m/N.
    pub receptance: Vec<c64>,
}

/// Measured receptances at the fundamental of every used run: circular frequency, value, run.
pub fn measured(p: &Project, response: usize, excitation: usize) -> Vec<(f64, c64, usize)> {
    let one = |(k, run): (usize, &crate::measurement::Run)| {
        let channel =
            |want: &dyn Fn(&crate::measurement::Channel) -> bool| run.fit.channels.iter().find(|c| want(&c.channel));
        let force = channel(&|c| c.quantity == Measured::Force && c.dof == excitation)?;
        let motion = channel(&|c| c.quantity != Measured::Force && c.dof == response)?;
        let order = motion.channel.quantity.derivatives()?;
        let omega = run.fit.omega;
        let turn = (0..order).fold(c64::new(1.0, 0.0), |z, _| z * c64::new(0.0, omega));
        let value = *motion.amplitudes.first()? / (turn * force.amplitudes.first()?);
        Some((omega, value, k))
    };
    p.runs.iter().enumerate().filter(|(_, r)| r.enabled).filter_map(one).collect()
}

/// A frequency response and what is divided by the force.
#[derive(Debug, Clone, Copy)]
pub struct Diagram<'a> {
    /// The project, for labels and measured points.
    pub project: &'a Project,
    /// The model's curve.
    pub response: &'a Response,
    /// What is divided by the force.
    pub quantity: Quantity,
}

impl Diagram<'_> {
    fn points(&self) -> Vec<(f64, c64, usize)> {
        let r = self.response;
        let scaled = |(omega, h, run)| (omega, h * self.quantity.factor(omega), run);
        measured(self.project, r.response, r.excitation).into_iter().map(scaled).collect()
    }

    fn model(&self) -> Vec<(f64, c64)> {
        let r = self.response;
        r.omega.iter().zip(&r.receptance).map(|(&w, &h)| (w, h * self.quantity.factor(w))).collect()
    }

    /// Magnitude and phase over frequency, both axes of frequency logarithmic and linked.
    pub fn bode(&self, ui: &mut Ui) {
        let palette = ui.palette();
        keys(ui, &[(palette.model, "model"), (palette.measured, "measured")]);
        let (model, points) = (self.model(), self.points());
        let magnitude = |w: f64, h: c64| [(w / TAU).log10(), h.re.hypot(h.im).max(f64::MIN_POSITIVE).log10()];
        let phase = |w: f64, h: c64| [(w / TAU).log10(), h.im.atan2(h.re).to_degrees()];
        let group = Id::unique("bode");
        let unit = format::pretty_unit(self.quantity.unit());
        let height = ui.available_height() - 4.0;
        let x_axis =
            |label: &str| axis(AxisHints::new_x(), palette, label).formatter(|mark, _| log::frequency(mark.value));
        let y_axis = axis(AxisHints::new_y(), palette, &format!("Magnitude, {unit}"))
            .placement(HPlacement::Left)
            .min_thickness(56.0)
            .formatter(|mark, _| log::label(mark.value));
        let marker = |points: Vec<[f64; 2]>| {
            Points::new("measured", PlotPoints::from(points))
                .shape(MarkerShape::Circle)
                .radius(4.0)
                .color(palette.measured)
        };
        let read = move |p: &egui_plot::PlotPoint, _: &egui_plot::PlotBounds| {
            format!(
                "{} Hz   {} {unit}",
                format::significant(10f64.powf(p.x), 4),
                format::significant(10f64.powf(p.y), 3)
            )
        };
        frame(ui, "bode magnitude", "", "")
            .custom_x_axes(vec![x_axis("")])
            .custom_y_axes(vec![y_axis])
            .x_grid_spacer(|input| log::decades(&input))
            .y_grid_spacer(|input| log::decades(&input))
            .link_axis(group, [true, false])
            .link_cursor(group, [true, false])
            .coordinates_formatter(Corner::RightTop, CoordinatesFormatter::new(read))
            .height(0.60 * height)
            .show_axes([false, true])
            .show(ui, |plot| {
                plot.line(curve(
                    "model",
                    model.iter().map(|&(w, h)| magnitude(w, h)).collect::<Vec<_>>(),
                    palette.model,
                    1.8,
                ));
                plot.points(marker(points.iter().map(|&(w, h, _)| magnitude(w, h)).collect()));
            });
        let degrees = axis(AxisHints::new_y(), palette, "Phase, °").placement(HPlacement::Left).min_thickness(56.0);
        let right_angles = |_: egui_plot::GridInput| {
            [-180.0, -90.0, 0.0, 90.0, 180.0].map(|value| GridMark { value, step_size: 90.0 }).to_vec()
        };
        frame(ui, "bode phase", "", "")
            .custom_x_axes(vec![x_axis("Frequency, Hz").min_thickness(32.0)])
            .custom_y_axes(vec![degrees])
            .x_grid_spacer(|input| log::decades(&input))
            .y_grid_spacer(right_angles)
            .include_y(-185.0)
            .include_y(185.0)
            .link_axis(group, [true, false])
            .link_cursor(group, [true, false])
            .height(0.40 * height)
            .show(ui, |plot| {
                for piece in unwrapped(model.iter().map(|&(w, h)| phase(w, h))) {
                    plot.line(curve("model", piece, palette.model, 1.8));
                }
                plot.points(marker(points.iter().map(|&(w, h, _)| phase(w, h)).collect()));
            });
    }

    /// Imaginary over real part within a band about `centre` (rad/s).
    pub fn nyquist(&self, ui: &mut Ui, centre: f64) {
        let palette = ui.palette();
        keys(ui, &[(palette.model, "model"), (palette.measured, "measured")]);
        let near = |w: f64| (w / centre).ln().abs() < 0.08;
        let plane = |h: c64| [h.re, h.im];
        let line: Vec<[f64; 2]> = self.model().into_iter().filter(|&(w, _)| near(w)).map(|(_, h)| plane(h)).collect();
        let points: Vec<[f64; 2]> =
            self.points().into_iter().filter(|&(w, _, _)| near(w)).map(|(_, h, _)| plane(h)).collect();
        let unit = format::pretty_unit(self.quantity.unit());
        let (x, y) = (format!("Real part, {unit}"), format!("Imaginary part, {unit}"));
        frame(ui, "nyquist", &x, &y)
            .data_aspect(1.0)
            .include_x(0.0)
            .include_y(0.0)
            .set_margin_fraction(egui::vec2(0.08, 0.08))
            .height(ui.available_height() - 4.0)
            .show(ui, |plot| {
                plot.line(curve("model", line, palette.model, 1.8));
                let marker = Points::new("measured", PlotPoints::from(points)).shape(MarkerShape::Circle);
                plot.points(marker.radius(5.0).color(palette.measured));
            });
    }
}

/// Cuts a phase curve where it jumps by a turn, so that no line is drawn across.
fn unwrapped(points: impl Iterator<Item = [f64; 2]>) -> Vec<Vec<[f64; 2]>> {
    let mut pieces: Vec<Vec<[f64; 2]>> = vec![Vec::new()];
    let mut last: Option<f64> = None;
    for point in points {
        if last.is_some_and(|y| (point[1] - y).abs() > 180.0) {
            pieces.push(Vec::new());
        }
        last = Some(point[1]);
        if let Some(piece) = pieces.last_mut() {
            piece.push(point);
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::unwrapped;

    #[test]
    fn a_phase_that_jumps_by_a_turn_is_cut() {
        let pieces = unwrapped([[0.0, -170.0], [1.0, -179.0], [2.0, 179.0], [3.0, 170.0]].into_iter());
        assert_eq!(pieces.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
    }
}
