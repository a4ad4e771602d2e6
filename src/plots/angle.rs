//! The angle between measured and identified energies against the number of sources, on a logarithmic axis.

use super::figure::{Axis, Figure, Look, Ticks};
use super::style::Palette;
use crate::identify::Outcome;

/// Angles below this are drawn as this: exact data reach rounding.
const LEAST: f64 = 1e-8;

/// The chart as a plot.
pub(crate) fn figure(palette: &Palette, outcome: &Outcome, current: usize, limit_deg: f64) -> Figure {
    let best: Vec<[f64; 2]> = outcome.steps.iter().map(|s| [s.count as f64, s.angle_deg.max(LEAST)]).collect();
    let others = outcome
        .steps
        .iter()
        .flat_map(|s| s.alternatives.iter().map(|a| [s.count as f64, a.angle_deg.max(LEAST)]))
        .collect();
    let single = |k: usize| best.get(k).copied().into_iter().collect::<Vec<_>>();
    let (chosen, accepted) = (single(current), single(outcome.accepted));
    let most = outcome.steps.last().map_or(1, |s| s.count) as f64;
    let x = Axis::new("Sources", "").ticks(Ticks::Whole).include(&[0.5, most + 0.5]);
    let y = Axis::log("Angle", "°").include(&[limit_deg.max(LEAST)]);
    Figure::new("Angle against number of sources", x, y)
        .points("limit", palette.missing, Look::Levels(1.4), vec![[1.0, limit_deg.max(LEAST)]])
        .points("others", palette.weak.gamma_multiply(0.6), Look::Dots(3.0), others)
        .points("best sets", palette.model, Look::Line(1.8), best.clone())
        .points("best sets", palette.model, Look::Dots(4.5), best)
        .points("accepted", palette.model, Look::Rings(8.0), accepted)
        .points("looked at", palette.accent, Look::Dots(6.0), chosen)
}
