//! Bode and Nyquist diagrams: the model's curve with the measured points on it.

use super::figure::{Axis, Figure, Look, Ticks};
use super::style::Palette;
use crate::display::format;
use crate::exchange::Project;
use crate::measurement::Quantity as Measured;
use crate::response::frequency_response::ResponseForm;
use faer::c64;
use std::f64::consts::TAU;

/// Bounds of half the band of a Nyquist diagram, natural logarithms of frequency.
const LEAST_BAND: f64 = 0.08;
const MOST_BAND: f64 = 0.4;
/// Share of a force that another one may be of where it is said to act alone.
const ALONE: f64 = 0.02;

/// A receptance between two DOFs on a range of frequencies.
#[derive(Debug, Clone, PartialEq)]
pub struct ReceptanceCurve {
    /// DOF whose displacement is divided by the force.
    pub response: usize,
    /// DOF at which the force acts.
    pub excitation: usize,
    /// Circular frequencies, rad/s, ascending.
    pub omega: Vec<f64>,
    /// Receptance, m/N.
    pub receptance: Vec<c64>,
}

/// A measured receptance at the fundamental of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Point {
    /// Circular frequency, rad/s.
    pub omega: f64,
    /// Receptance, m/N.
    pub value: c64,
    /// Standard deviation of its real and of its imaginary part over its magnitude: those of motion and force together.
    pub deviation: f64,
}

/// Measured receptances at the fundamentals of all used runs that have both channels and in which no other force acts: a moving
/// base loads every DOF, and motion over one of these forces is no receptance.
pub(crate) fn measured(p: &Project, response: usize, excitation: usize) -> Vec<Point> {
    let response_of = |run: &crate::measurement::Run| {
        let channel =
            |want: &dyn Fn(&crate::measurement::Channel) -> bool| run.fit.channels.iter().find(|c| want(&c.channel));
        let force = channel(&|c| c.quantity == Measured::Force && c.dof == excitation)?;
        let motion = channel(&|c| c.quantity != Measured::Force && c.dof == response)?;
        let size = |c: &crate::measurement::ChannelFit| c.amplitudes.first().map_or(0.0, |y| y.norm());
        let forces = run.fit.channels.iter().filter(|c| c.channel.quantity == Measured::Force);
        if forces.filter(|c| c.channel.dof != excitation).any(|c| size(c) > ALONE * size(force)) {
            return None;
        }
        let order = motion.channel.quantity.derivatives()?;
        let omega = run.fit.omega;
        let turn = (0..order).fold(c64::new(1.0, 0.0), |z, _| z * c64::new(0.0, omega));
        let value = *motion.amplitudes.first()? / (turn * force.amplitudes.first()?);
        let relative = |c: &crate::measurement::ChannelFit| {
            let y = c.amplitudes.first().copied().unwrap_or_default();
            c.deviation(1) / y.re.hypot(y.im)
        };
        Some(Point { omega, value, deviation: relative(motion).hypot(relative(force)) })
    };
    p.runs.iter().filter(|r| r.enabled).filter_map(response_of).collect()
}

/// A frequency response and what is divided by the force.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Diagram<'a> {
    /// The project, for labels and measured points.
    pub project: &'a Project,
    /// The model's curve.
    pub response: &'a ReceptanceCurve,
    /// What is divided by the force.
    pub quantity: ResponseForm,
}

impl Diagram<'_> {
    fn points(&self) -> Vec<Point> {
        let r = self.response;
        let scaled = |p: Point| Point { value: p.value * self.quantity.factor(p.omega), ..p };
        measured(self.project, r.response, r.excitation).into_iter().map(scaled).collect()
    }

    fn model(&self) -> Vec<(f64, c64)> {
        let r = self.response;
        r.omega.iter().zip(&r.receptance).map(|(&w, &h)| (w, h * self.quantity.factor(w))).collect()
    }

    fn name(&self) -> &'static str {
        match self.quantity {
            ResponseForm::Receptance => "Receptance",
            ResponseForm::Mobility => "Mobility",
            ResponseForm::Accelerance => "Accelerance",
        }
    }

    /// Title of what is exported: which quantity between which DOFs.
    pub(crate) fn title(&self, kind: &str) -> String {
        let label = |dof: usize| self.project.structure.label(dof);
        let r = self.response;
        format!(
            "{kind}, {} of DOF {} for a force at DOF {}",
            self.name().to_lowercase(),
            label(r.response),
            label(r.excitation)
        )
    }

    /// Magnitude and phase as plots.
    pub(crate) fn bode_figures(&self, palette: &Palette) -> [Figure; 2] {
        let (model, points) = (self.model(), self.points());
        let size = |h: c64| h.re.hypot(h.im);
        let phase = |h: c64| h.im.atan2(h.re).to_degrees();
        let frequency = || Axis::log("Frequency", "Hz").ticks(Ticks::OneTwoFive);
        let points_of = |f: &dyn Fn(c64) -> f64| points.iter().map(|p| [p.omega / TAU, f(p.value)]).collect::<Vec<_>>();
        let unit = format::pretty_unit(self.quantity.unit());
        let magnitude = Figure::new("Magnitude", frequency(), Axis::log(self.name(), &unit))
            .points("model", palette.model, Look::Line(1.8), model.iter().map(|&(w, h)| [w / TAU, size(h)]).collect())
            .points("measured", palette.measured, Look::Dots(4.0), points_of(&size))
            .deviation(points.iter().map(|p| p.deviation * size(p.value)).collect());
        let degrees = Axis::new("Phase", "°").ticks(Ticks::RightAngles).include(&[-180.0, 0.0]);
        let mut angle = Figure::new("Phase", frequency(), degrees);
        for piece in unwrapped(model.iter().map(|&(w, h)| [w / TAU, phase(h)])) {
            angle = angle.points("model", palette.model, Look::Line(1.8), piece);
        }
        let angle = angle
            .points("measured", palette.measured, Look::Dots(4.0), points_of(&phase))
            .deviation(points.iter().map(|p| p.deviation.to_degrees()).collect());
        [magnitude, angle]
    }

    /// Half the band of a Nyquist diagram about `centre` (rad/s), as a natural logarithm: half way to the nearest run of
    /// another resonance, so that the circle closes and no other is drawn with it.
    fn band(&self, centre: f64) -> f64 {
        let away = |r: &crate::measurement::Run| (r.fit.omega / centre).ln().abs();
        let others = self.project.runs.iter().filter(|r| r.enabled).map(away).filter(|d| *d > 2.0 * LEAST_BAND);
        (0.5 * others.fold(f64::INFINITY, f64::min)).clamp(LEAST_BAND, MOST_BAND)
    }

    /// Imaginary over real part within a band about `centre` (rad/s).
    pub(crate) fn nyquist_figure(&self, palette: &Palette, centre: f64) -> Figure {
        let band = self.band(centre);
        let near = |w: f64| (w / centre).ln().abs() < band;
        let plane = |h: c64| [h.re, h.im];
        let line = self.model().into_iter().filter(|&(w, _)| near(w)).map(|(_, h)| plane(h)).collect();
        let points: Vec<Point> = self.points().into_iter().filter(|p| near(p.omega)).collect();
        let unit = format::pretty_unit(self.quantity.unit());
        let x = Axis::new("Real part", &unit).include(&[0.0]);
        let y = Axis::new("Imaginary part", &unit).include(&[0.0]);
        let mut figure = Figure::new(self.name(), x, y)
            .points("model", palette.model, Look::Line(1.8), line)
            .points("measured", palette.measured, Look::Dots(5.0), points.iter().map(|p| plane(p.value)).collect())
            .deviation(points.iter().map(|p| p.deviation * p.value.re.hypot(p.value.im)).collect());
        (figure.square, figure.margin) = (true, 0.08);
        figure
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
