//! One channel along frequency (with the model's curve through its turning points) and along the force level.

use super::samples::{Sample, phase};
use crate::window::explained::curve::Curve;
use crate::window::format;
use crate::window::plots::figure::{Axis, Figure, Look, Ticks};
use crate::window::plots::show::Stack;
use crate::window::theme::Palette;
use crate::window::widgets::UiExt;
use egui::Ui;
use faer::c64;

/// Share by which forces of one level may differ.
const SAME_LEVEL: f64 = 0.12;
/// Share by which frequencies of one test may differ.
const SAME_FREQUENCY: f64 = 0.015;

/// What is plotted.
pub struct Along<'a> {
    /// Name of the channel.
    pub name: &'a str,
    /// Runs of the channel.
    pub samples: &'a [Sample],
    /// Selected run.
    pub run: usize,
    /// Runs near it in frequency.
    pub near: &'a [usize],
    /// Index of the channel in the fit of the selected run.
    pub channel: usize,
    /// Unit of the channel.
    pub unit: &'a str,
    /// The model's curve near the run.
    pub curve: Option<&'a Curve>,
    /// The curve with the effect on trial.
    pub trial: Option<&'a Curve>,
}

/// One of the two plots under each other.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    Magnitude,
    Phase,
}

impl Part {
    fn of(self, z: c64) -> f64 {
        match self {
            Self::Magnitude => z.norm(),
            Self::Phase => phase(z),
        }
    }
}

impl Along<'_> {
    /// Magnitude and phase over the force, along frequency.
    pub fn frequency(&self, ui: &mut Ui) {
        let Some(own) = self.samples.iter().find(|s| s.run == self.run) else { return };
        let near = |s: &&Sample| self.near.contains(&s.run);
        let level = |s: &Sample| (s.force / own.force).ln().abs() < SAME_LEVEL;
        let (same, other): (Vec<&Sample>, Vec<&Sample>) = self.samples.iter().filter(near).partition(|s| level(s));
        let palette = ui.palette();
        let figure = |part: Part| {
            let y = match part {
                Part::Magnitude => Axis::log("Magnitude", &per_force(self.unit)).ticks(Ticks::OneTwoFive),
                Part::Phase => Axis::new("Phase", "°").ticks(Ticks::RightAngles),
            };
            let others = other.iter().map(|s| [s.frequency, part.of(s.measured)]).collect();
            let faint = palette.measured.gamma_multiply(0.35);
            let mut figure = Figure::new(title(part), Axis::new("Frequency", "Hz"), y).points(
                "at other levels",
                faint,
                Look::Dots(2.5),
                others,
            );
            for (curve, name, colour, look) in [
                (self.curve, "model", palette.model, Look::Line(1.8)),
                (self.trial, "with the effect on trial", palette.missing, Look::Dashed(1.8)),
            ] {
                for (stable, piece) in curve.map(|c| pieces(c, self.channel, part)).unwrap_or_default() {
                    figure = figure.points(name, colour, if stable { look } else { Look::Dotted(1.8) }, piece);
                }
            }
            self.samples_on(figure, palette, &same, &|s| s.frequency, part)
        };
        let figures = vec![(figure(Part::Magnitude), 0.54), (figure(Part::Phase), 0.46)];
        self.stack(ui, "frequency", figures);
    }

    /// Magnitude and phase over the force, along the force.
    pub fn level(&self, ui: &mut Ui) {
        let Some(own) = self.samples.iter().find(|s| s.run == self.run) else { return };
        let near = |s: &&Sample| (s.frequency / own.frequency).ln().abs() < SAME_FREQUENCY;
        let mut list: Vec<&Sample> = self.samples.iter().filter(near).collect();
        list.sort_by(|a, b| a.force.total_cmp(&b.force));
        if list.len() < 2 {
            let frequency = format::with_unit(own.frequency, "Hz");
            ui.empty("One level only", &format!("At {frequency} there is no run at another force."));
            return;
        }
        let palette = ui.palette();
        let figure = |part: Part| {
            let y = match part {
                // Linear: a linear structure shows a level line.
                Part::Magnitude => Axis::new("Magnitude", &per_force(self.unit)),
                Part::Phase => Axis::new("Phase", "°"),
            };
            let joined = |of: &dyn Fn(&Sample) -> Option<c64>| -> Vec<[f64; 2]> {
                list.iter().filter_map(|s| Some([s.force, part.of(of(s)?)])).collect()
            };
            let figure = Figure::new(title(part), Axis::new("Force amplitude", "N"), y)
                .points("measured", palette.measured, Look::Line(1.2), joined(&|s| Some(s.measured)))
                .points("model", palette.model, Look::Line(1.8), joined(&|s| Some(s.model)))
                .points("with the effect on trial", palette.missing, Look::Dashed(1.8), joined(&|s| s.trial));
            let mut figure = self.samples_on(figure, palette, &list, &|s| s.force, part);
            figure.margin = 0.06;
            figure
        };
        let figures = vec![(figure(Part::Magnitude), 0.54), (figure(Part::Phase), 0.46)];
        self.stack(ui, "level", figures);
    }

    fn stack(&self, ui: &mut Ui, along: &str, mut figures: Vec<(Figure, f32)>) {
        // What is not there has no key.
        figures.iter_mut().for_each(|(f, _)| f.series.retain(|s| !s.points(0.0, f64::INFINITY, 1).is_empty()));
        let title = format!("{} along {along}, run {}", self.name, self.run + 1);
        Stack { id: &title, title: &title, figures, keys: true }.show(ui);
    }

    /// Measured points, and what the model and the effect on trial predict for them, with a ring about the selected run.
    fn samples_on(
        &self,
        figure: Figure,
        palette: &Palette,
        list: &[&Sample],
        x: &dyn Fn(&Sample) -> f64,
        part: Part,
    ) -> Figure {
        let points = |of: &dyn Fn(&Sample) -> Option<c64>| -> Vec<[f64; 2]> {
            list.iter().filter_map(|s| Some([x(s), part.of(of(s)?)])).collect()
        };
        figure
            .points("model", palette.model, Look::Rings(5.5), points(&|s| Some(s.model)))
            .points("with the effect on trial", palette.missing, Look::Rings(7.0), points(&|s| s.trial))
            .points("measured", palette.measured, Look::Dots(3.5), points(&|s| Some(s.measured)))
            .points("", palette.accent, Look::Rings(9.0), points(&|s| (s.run == self.run).then_some(s.measured)))
    }
}

fn title(part: Part) -> &'static str {
    match part {
        Part::Magnitude => "Magnitude",
        Part::Phase => "Phase",
    }
}

/// `(m/s²)/N`.
fn per_force(unit: &str) -> String {
    let unit = format::pretty_unit(unit);
    if unit.contains('/') { format!("({unit})/N") } else { format!("{unit}/N") }
}

/// The curve in pieces of one stability, cut where a phase jumps by a turn; pieces share their ends.
fn pieces(found: &Curve, channel: usize, part: Part) -> Vec<(bool, Vec<[f64; 2]>)> {
    let mut pieces: Vec<(bool, Vec<[f64; 2]>)> = Vec::new();
    for point in &found.points {
        let Some(z) = point.ratios.get(channel) else { continue };
        let at = [point.frequency, part.of(*z)];
        match pieces.last_mut() {
            Some((stable, piece)) => {
                let last = piece.last().copied().unwrap_or(at);
                let jumps = part == Part::Phase && (at[1] - last[1]).abs() > 180.0;
                if *stable == point.stable && !jumps {
                    piece.push(at);
                } else {
                    let start = if jumps { vec![at] } else { vec![last, at] };
                    pieces.push((point.stable, start));
                }
            }
            None => pieces.push((point.stable, vec![at])),
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::{Part, per_force, pieces};
    use crate::window::explained::curve::{Curve, CurvePoint};
    use faer::c64;

    #[test]
    fn a_curve_is_cut_where_it_loses_stability_and_where_its_phase_jumps() {
        let point = |frequency: f64, degrees: f64, stable| {
            let (s, c) = degrees.to_radians().sin_cos();
            CurvePoint { frequency, ratios: vec![1e3 * c64::new(c, s)], stable }
        };
        let points = vec![
            point(1.0, 170.0, true),
            point(2.0, -175.0, true),
            point(3.0, -160.0, true),
            point(2.5, -150.0, false),
            point(2.6, -140.0, true),
        ];
        let curve = Curve { force: 1.0, points };
        let shape = |part| -> Vec<(bool, usize)> {
            pieces(&curve, 0, part).iter().map(|(stable, piece)| (*stable, piece.len())).collect()
        };
        assert_eq!(shape(Part::Phase), [(true, 1), (true, 2), (false, 2), (true, 2)]);
        assert_eq!(shape(Part::Magnitude), [(true, 3), (false, 2), (true, 2)]);
        let found = pieces(&curve, 0, Part::Phase);
        assert_eq!(found[2].1[0], found[1].1[1], "pieces meet where the curve turns");
    }

    #[test]
    fn units_over_the_force_are_read_as_one() {
        assert_eq!(per_force("m/s^2"), "(m/s²)/N");
        assert_eq!(per_force("m"), "m/N");
    }
}
