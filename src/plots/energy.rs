//! Measured and identified energy of every run, on a logarithmic axis.

use super::figure::{Axis, Figure, Look, Ticks};
use super::style::Palette;
use crate::exchange::Project;
use crate::identify::Outcome;

/// The chart as a plot.
pub(crate) fn figure(palette: &Palette, p: &Project, outcome: &Outcome, current: usize) -> Figure {
    let step = outcome.steps.get(current).map_or(&[][..], |s| &s.identified_energy[..]);
    let number = |run: usize| run as f64 + 1.0;
    let pairs = || outcome.runs.iter().zip(step);
    let measured = pairs().map(|(r, _)| [number(r.run), r.input_energy]).collect();
    let identified = pairs().map(|(r, &e)| [number(r.run), e]).collect();
    let x = Axis::new("Run", "").ticks(Ticks::Whole).include(&[0.5, p.runs.len() as f64 + 0.5]);
    let mut figure = Figure::new("Energy per period and run", x, Axis::log("Energy", "J"));
    for (r, &e) in pairs().filter(|(r, e)| r.input_energy > 0.0 && **e > 0.0) {
        let ends = vec![[number(r.run), r.input_energy], [number(r.run), e]];
        figure = figure.points("", palette.missing, Look::Line(2.0), ends);
    }
    figure.points("measured input", palette.measured, Look::Dots(4.0), measured).points(
        "identified",
        palette.model,
        Look::Rings(6.5),
        identified,
    )
}
