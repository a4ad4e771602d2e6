//! One channel over frequency (measured points on the model's curves, a colour a level of force) and over the force level.

use super::figure::{Axis, Figure, Look, Ticks};
use super::response_curve::{Curve, ForceLevel};
use super::samples::{Sample, phase};
use super::style::Palette;
use crate::display::format;
use ecolor::Color32;
use faer::c64;
use std::collections::HashSet;

/// Share by which frequencies of one test may differ.
const SAME_FREQUENCY: f64 = 0.015;

/// What is plotted.
pub(crate) struct ChannelResponse<'a> {
    /// Name of the channel.
    pub name: &'a str,
    /// Runs of the channel.
    pub samples: &'a [Sample],
    /// Selected run.
    pub run: usize,
    /// Runs near it in frequency, by level.
    pub levels: &'a [ForceLevel],
    /// Index of the channel in the fit of the selected run.
    pub channel: usize,
    /// Unit of the channel.
    pub unit: &'a str,
    /// The model's curves near the run, one a level.
    pub curves: &'a [Curve],
    /// The curves with the effect on trial.
    pub trial: &'a [Curve],
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

impl ChannelResponse<'_> {
    /// Magnitude and phase over the force, along frequency; each with its share of the height.
    pub(crate) fn over_frequency(&self, palette: &Palette) -> Vec<(Figure, f32)> {
        let figure = |part| self.frequency_figure(palette, part);
        present(vec![(figure(Part::Magnitude), 0.54), (figure(Part::Phase), 0.46)])
    }

    fn frequency_figure(&self, palette: &Palette, part: Part) -> Figure {
        let y = match part {
            Part::Magnitude => Axis::log("Magnitude", &per_force(self.unit)).ticks(Ticks::OneTwoFive),
            Part::Phase => Axis::new("Phase", "°").ticks(Ticks::RightAngles),
        };
        let mut figure = Figure::new(title(part), Axis::new("Frequency", "Hz"), y);
        if self.levels.len() > 1 {
            figure = self.keys(figure, palette);
        }
        for (curves, dashed) in [(self.curves, false), (self.trial, true)] {
            for curve in curves {
                figure = self.curve(figure, palette, curve, dashed, part);
            }
        }
        for level in self.levels {
            let colour = self.colours(palette, level.force).measured;
            let name = if self.levels.len() > 1 { String::new() } else { "measured".to_owned() };
            // A level may hold thousands of runs.
            let runs: HashSet<usize> = level.runs.iter().copied().collect();
            let own = runs.contains(&self.run);
            let in_level = |s: &&Sample| runs.contains(&s.run);
            let points = |value: &dyn Fn(&Sample) -> Option<c64>, list: &[&Sample]| -> Vec<[f64; 2]> {
                list.iter().filter_map(|s| Some([s.frequency, part.of(value(s)?)])).collect()
            };
            let list: Vec<&Sample> = self.samples.iter().filter(in_level).collect();
            // Where the prediction of a run does not lie on its curve, the run was on another branch.
            let lit = self.colours(palette, level.force).model;
            if own {
                figure = figure.points("", lit, Look::Rings(5.0), points(&|s| Some(s.model), &list));
            }
            let radius = if own { 3.8 } else { 2.8 };
            figure = figure.points(&name, colour, Look::Dots(radius), points(&|s| Some(s.measured), &list));
        }
        let chosen = self.samples.iter().filter(|s| s.run == self.run);
        figure.points(
            "",
            palette.accent,
            Look::Rings(9.0),
            chosen.map(|s| [s.frequency, part.of(s.measured)]).collect(),
        )
    }

    /// Keys to marks and colours where there is more than one level.
    fn keys(&self, mut figure: Figure, palette: &Palette) -> Figure {
        figure = figure.key("measured", palette.ink, Look::Dots(3.5)).key("model", palette.ink, Look::Line(1.8));
        if !self.trial.is_empty() {
            figure = figure.key("with the effect on trial", palette.ink, Look::Dashed(1.8));
        }
        for level in self.levels {
            let name = level.name();
            figure = figure.key(&name, self.colours(palette, level.force).model, Look::Line(3.0));
        }
        figure
    }

    /// Colours of measured and modelled data at a force: those of the level, and of data and model where there is one only.
    fn colours(&self, palette: &Palette, force: f64) -> Colours {
        if self.levels.len() < 2 {
            return Colours { measured: palette.measured, model: palette.model, trial: palette.missing };
        }
        let near = |k: &usize| (self.levels[*k].force / force).ln().abs();
        let k = (0..self.levels.len()).min_by(|a, b| near(a).total_cmp(&near(b))).unwrap_or(0);
        let colour = palette.level(k as f32 / (self.levels.len() - 1) as f32);
        Colours { measured: colour, model: colour, trial: colour }
    }

    fn curve(&self, mut figure: Figure, palette: &Palette, curve: &Curve, dashed: bool, part: Part) -> Figure {
        let colours = self.colours(palette, curve.force);
        let own = self
            .levels
            .iter()
            .find(|l| l.runs.contains(&self.run))
            .is_none_or(|l| (l.force - curve.force).abs() < 1e-9 * l.force);
        let width = if own { 2.0 } else { 1.2 };
        let (colour, look, name) = if dashed {
            (colours.trial, Look::Dashed(width), "with the effect on trial")
        } else {
            (colours.model, Look::Line(width), "model")
        };
        let name = if self.levels.len() > 1 { "" } else { name };
        for (stable, piece) in pieces(curve, self.channel, part) {
            figure = figure.points(name, colour, if stable { look } else { Look::Dotted(width) }, piece);
        }
        figure
    }

    /// Magnitude and phase over the force, along the force, at the frequency of the run; none where there is one force only.
    pub(crate) fn over_level(&self, palette: &Palette) -> Option<Vec<(Figure, f32)>> {
        let own = self.samples.iter().find(|s| s.run == self.run)?;
        let near = |s: &&Sample| (s.frequency / own.frequency).ln().abs() < SAME_FREQUENCY;
        let mut list: Vec<&Sample> = self.samples.iter().filter(near).collect();
        list.sort_by(|a, b| a.force.total_cmp(&b.force));
        let figure = |part: Part| {
            let y = match part {
                // Linear: a linear structure shows a level line.
                Part::Magnitude => Axis::new("Magnitude", &per_force(self.unit)),
                Part::Phase => Axis::new("Phase", "°"),
            };
            let points = |value: &dyn Fn(&Sample) -> Option<c64>| -> Vec<[f64; 2]> {
                list.iter().filter_map(|s| Some([s.force, part.of(value(s)?)])).collect()
            };
            let trial = "with the effect on trial";
            let mut figure = Figure::new(title(part), Axis::new("Force amplitude", "N").peak(), y)
                .points("measured", palette.measured, Look::Line(1.2), points(&|s| Some(s.measured)))
                .points("model", palette.model, Look::Line(1.8), points(&|s| Some(s.model)))
                .points(trial, palette.missing, Look::Dashed(1.8), points(&|s| s.trial))
                .points("model", palette.model, Look::Rings(5.5), points(&|s| Some(s.model)))
                .points(trial, palette.missing, Look::Rings(7.0), points(&|s| s.trial))
                .points("measured", palette.measured, Look::Dots(3.5), points(&|s| Some(s.measured)))
                .points("", palette.accent, Look::Rings(9.0), points(&|s| (s.run == self.run).then_some(s.measured)));
            figure.series.retain(|s| s.name != trial || !s.points(0.0, f64::INFINITY, 1).is_empty());
            figure.margin = 0.06;
            figure
        };
        (list.len() > 1).then(|| present(vec![(figure(Part::Magnitude), 0.54), (figure(Part::Phase), 0.46)]))
    }

    /// Title of what is exported.
    pub(crate) fn title(&self, along: &str) -> String {
        format!("{} along {along}, run {}", self.name, self.run + 1)
    }
}

/// Colours of one level.
struct Colours {
    measured: Color32,
    model: Color32,
    trial: Color32,
}

/// Without series of nothing: what is not there has no key.
fn present(mut figures: Vec<(Figure, f32)>) -> Vec<(Figure, f32)> {
    figures
        .iter_mut()
        .for_each(|(f, _)| f.series.retain(|s| s.is_key() || !s.points(0.0, f64::INFINITY, 1).is_empty()));
    figures
}

fn title(part: Part) -> &'static str {
    match part {
        Part::Magnitude => "Magnitude",
        Part::Phase => "Phase",
    }
}

/// `m/s²/N`.
pub(super) fn per_force(unit: &str) -> String {
    format!("{}/N", format::pretty_unit(unit))
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
    use crate::plots::response_curve::{Curve, CurvePoint};
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
        assert_eq!(per_force("m/s^2"), "m/s²/N");
        assert_eq!(per_force("m"), "m/N");
    }
}
