//! Loops of a component in a testing machine: measured and modelled force over the displacement that is imposed.

use super::figure::{Axis, Figure, Look};
use super::style::Palette;
use crate::balance::loops::LoopRecord;

/// The loop of one record with the model's force (N) on the same samples.
pub(crate) fn figure(palette: &Palette, one: &LoopRecord, model: &[f64]) -> Figure {
    let over = |force: &[f64]| one.d.iter().zip(force).map(|(d, f)| [*d, *f]).collect::<Vec<[f64; 2]>>();
    let [measured, modelled] = [&one.force, model].map(|force: &[f64]| one.work(force));
    let title = format!("{}: work measured {measured:.4} J, model {modelled:.4} J", one.file);
    let mut figure = Figure::new(&title, Axis::new("Displacement", "m"), Axis::new("Force", "N"))
        .points("measured", palette.measured, Look::Line(1.6), over(&one.force))
        .points("model", palette.model, Look::Line(1.2), over(model));
    figure.margin = 0.08;
    figure
}
