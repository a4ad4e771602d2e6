//! Loops of force over displacement: of the exciter, measured and of the model, and of each source.

use super::cycle::scaled;
use super::figure::{Axis, Figure, Look};
use crate::display::{format, words};
use crate::effects::{Motion, Place, Source};
use crate::exchange::Project;
use crate::measurement::Quantity;
use faer::c64;
use std::f64::consts::TAU;

/// Samples of a loop.
const SAMPLES: usize = 256;

/// A closed loop: displacement, m, and force, N.
#[derive(Debug, Clone, PartialEq)]
pub struct HysteresisPlot {
    /// Title.
    pub name: String,
    /// Points of the model's loop.
    pub model: Vec<[f64; 2]>,
    /// Points of the measured loop, where both force and motion are measured there.
    pub measured: Vec<[f64; 2]>,
    /// Whether it is a moment, N·m, over a rotation, rad.
    pub rotation: bool,
}

/// Loops of one run: the exciter's and one a source, for the model's amplitudes `x` of displacement (m) at the fundamental.
pub(crate) fn loops(p: &Project, run: usize, x: &[c64], acting: &[Source]) -> Vec<HysteresisPlot> {
    let Some(r) = p.runs.get(run) else { return Vec::new() };
    let omega = r.fit.omega;
    let mut loops = Vec::new();
    for force in r.fit.channels.iter().filter(|c| c.channel.quantity == Quantity::Force) {
        let dof = force.channel.dof;
        let Some(&f) = force.amplitudes.first() else { continue };
        let motion = r.fit.channels.iter().find(|c| c.channel.dof == dof && c.channel.quantity != Quantity::Force);
        let measured = motion.and_then(|m| {
            let order = m.channel.quantity.derivatives()?;
            let turn = (0..order).fold(c64::new(1.0, 0.0), |z, _| z * c64::new(0.0, omega));
            Some(ellipse(*m.amplitudes.first()? / turn, f))
        });
        loops.push(HysteresisPlot {
            name: format!("Exciter at DOF {}", force.channel.label),
            model: x.get(dof).map_or_else(Vec::new, |&x| ellipse(x, f)),
            measured: measured.unwrap_or_default(),
            rotation: p.structure.dofs()[dof].direction.is_rotation(),
        });
    }
    for source in acting {
        for leg in source.place.legs() {
            let Some(law) = source.effect.law() else { continue };
            let motion = Motion::new(omega, 0.0, &[leg.relative(|d| x[d])], SAMPLES);
            let mut force = vec![0.0; SAMPLES];
            law.force(&source.parameters, &motion, &mut force);
            let points = motion.displacement.iter().zip(&force).map(|(&d, &f)| [d, f]);
            let mut model: Vec<[f64; 2]> = points.collect();
            model.extend(model.first().copied());
            let place = source.place.cell(&p.structure);
            let rotation = matches!(&source.place, Place::Dofs(dofs) if is_rotation(p, dofs));
            let name = format!("{} {place}", source.effect.noun());
            loops.push(HysteresisPlot { name, model, measured: Vec::new(), rotation });
        }
    }
    loops
}

/// Whether a source turns what it acts on.
fn is_rotation(p: &Project, dofs: &[usize]) -> bool {
    dofs.iter().any(|&d| p.structure.dofs().get(d).is_some_and(|d| d.direction.is_rotation()))
}

/// The loop of two harmonic quantities over one period.
fn ellipse(x: c64, f: c64) -> Vec<[f64; 2]> {
    let point_at = |k: usize| {
        let (s, c) = (TAU * k as f64 / SAMPLES as f64).sin_cos();
        [x.re * c - x.im * s, f.re * c - f.im * s]
    };
    (0..=SAMPLES).map(point_at).collect()
}

/// Work per period of the force of a closed loop, J: the integral of `f dx` by the trapezoidal rule.
pub(crate) fn area(points: &[[f64; 2]]) -> f64 {
    points.windows(2).map(|p| 0.5 * (p[0][1] + p[1][1]) * (p[1][0] - p[0][0])).sum()
}

impl HysteresisPlot {
    /// What it encloses, in words: `model 1.23 mJ, measured 1.25 mJ`.
    pub fn energies(&self) -> String {
        if self.measured.is_empty() {
            return format::prefixed(area(&self.model), "J");
        }
        let energy_in_words = |name: &str, points: &[[f64; 2]]| {
            (!points.is_empty()).then(|| format!("{name} {}", format::prefixed(area(points), "J")))
        };
        [energy_in_words("model", &self.model), energy_in_words("measured", &self.measured)]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join(", ")
    }

    /// As a plot.
    pub fn figure(&self, palette: &crate::plots::style::Palette) -> Figure {
        let title = format!("{}: area {}", self.name, self.energies());
        let most = |k: usize| self.model.iter().chain(&self.measured).map(|p| p[k].abs()).fold(0.0, f64::max);
        let [(a, x), (b, y)] =
            [(Quantity::Displacement, most(0)), (Quantity::Force, most(1))].map(|(quantity, most)| {
                let (factor, prefix) = scaled(most);
                let plain = Axis::of(words::axis(quantity, self.rotation));
                (factor, Axis::new(&plain.name, &format!("{prefix}{}", plain.unit)))
            });
        let points = |list: &[[f64; 2]]| list.iter().map(|p| [a * p[0], b * p[1]]).collect();
        let mut figure = Figure::new(&title, x, y)
            .points("measured", palette.measured, Look::Line(2.4), points(&self.measured))
            .points("model", palette.model, Look::Line(1.6), points(&self.model));
        figure.margin = 0.08;
        figure
    }
}

#[cfg(test)]
mod tests {
    use super::{area, ellipse};
    use faer::c64;

    #[test]
    fn the_area_of_a_loop_is_the_work_of_the_force() {
        // Work per period of f on x: integral f dx = -pi Im(F conj X) ... with x = Re X e^{iwt}: pi (F_im X_re - F_re X_im).
        let (x, f) = (c64::new(0.3, -0.8), c64::new(2.0, 0.5));
        let points = ellipse(x, f);
        let work = area(&points);
        let expected = -(std::f64::consts::PI * (f.im * x.re - f.re * x.im));
        assert!((work.abs() - expected.abs()).abs() < 1e-3, "{work} {expected}");
    }
}
