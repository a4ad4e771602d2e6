//! One channel along frequency (with the model's curve through its turning points) and along the force level.

use super::cycle::{lines, round};
use super::samples::{Sample, phase};
use crate::window::explained::curve::Curve;
use crate::window::format;
use crate::window::plots::{curve as line, frame, keys, log, upright};
use crate::window::solid::frame::round_step;
use crate::window::theme::Palette;
use crate::window::widgets::UiExt;
use egui::{Color32, Id, Ui};
use egui_plot::{
    CoordinatesFormatter, Corner, GridInput, GridMark, LineStyle, MarkerShape, Plot, PlotPoints, PlotUi, Points,
};
use faer::c64;

/// Share by which forces of one level may differ.
const SAME_LEVEL: f64 = 0.12;
/// Share by which frequencies of one test may differ.
const SAME_FREQUENCY: f64 = 0.015;

/// What is plotted.
pub struct Along<'a> {
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

impl Along<'_> {
    fn legend(&self, ui: &mut Ui) {
        let palette = ui.palette();
        let mut entries = vec![(palette.measured, "measured"), (palette.model, "model")];
        if self.samples.iter().any(|s| s.trial.is_some()) {
            entries.push((palette.missing, "with the effect on trial"));
        }
        keys(ui, &entries);
    }

    /// Magnitude and phase over the force, along frequency.
    pub fn frequency(&self, ui: &mut Ui) {
        self.legend(ui);
        let Some(own) = self.samples.iter().find(|s| s.run == self.run) else { return };
        let near = |s: &&Sample| self.near.contains(&s.run);
        let level = |s: &Sample| (s.force / own.force).ln().abs() < SAME_LEVEL;
        let (same, other): (Vec<&Sample>, Vec<&Sample>) = self.samples.iter().filter(near).partition(|s| level(s));
        let height = ui.available_height() - 6.0;
        let group = Id::unique("along frequency");
        let palette = ui.palette();
        let label = format!("Magnitude, {}", per_force(self.unit));
        let plots = [
            (self.magnitude_plot(ui, "frequency magnitude", "", &label), 0.60, true),
            (phase_plot(ui, "frequency phase", "Frequency, Hz", 0.40 * height), 0.40, false),
        ];
        for (plot, share, tall) in plots {
            let y = |z: c64| if tall { decades(z) } else { phase(z) };
            plot.height(share * height).link_axis(group, [true, false]).link_cursor(group, [true, false]).show(
                ui,
                |plot| {
                    let faint = palette.measured.gamma_multiply(0.35);
                    mark(plot, other.iter().map(|s| [s.frequency, y(s.measured)]), faint, MarkerShape::Circle, 2.5);
                    for (found, colour) in [(self.curve, palette.model), (self.trial, palette.missing)] {
                        let dashed = colour == palette.missing;
                        if let Some(found) = found {
                            self.draw_curve(plot, found, colour, dashed, &y);
                        }
                    }
                    let points = |of: &dyn Fn(&Sample) -> Option<c64>| -> Vec<[f64; 2]> {
                        same.iter().filter_map(|s| Some([s.frequency, y(of(s)?)])).collect()
                    };
                    self.series(plot, palette, &points, false);
                },
            );
        }
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
        self.legend(ui);
        let height = ui.available_height() - 6.0;
        let group = Id::unique("along level");
        let palette = ui.palette();
        let label = format!("Magnitude, {}", per_force(self.unit));
        let plots = [
            (level_plot(ui, &label, self.unit, 0.60 * height), 0.60, true),
            (phase_plot(ui, "level phase", "Force amplitude, N", 0.40 * height), 0.40, false),
        ];
        for (plot, share, tall) in plots {
            let y = |z: c64| if tall { z.norm() } else { phase(z) };
            let plot = plot.height(share * height).link_axis(group, [true, false]).link_cursor(group, [true, false]);
            plot.set_margin_fraction(egui::vec2(0.06, 0.12)).show(ui, |plot| {
                let points = |of: &dyn Fn(&Sample) -> Option<c64>| -> Vec<[f64; 2]> {
                    list.iter().filter_map(|s| Some([s.force, y(of(s)?)])).collect()
                };
                self.series(plot, palette, &points, true);
            });
        }
    }

    /// Measured, modelled and tried points, joined by lines where there is no curve between them.
    fn series(
        &self,
        plot: &mut PlotUi<'_>,
        palette: &Palette,
        points: &dyn Fn(&dyn Fn(&Sample) -> Option<c64>) -> Vec<[f64; 2]>,
        joined: bool,
    ) {
        let measured = points(&|s| Some(s.measured));
        let (model, trial) = (points(&|s| Some(s.model)), points(&|s| s.trial));
        if joined {
            plot.line(line("measured", measured.clone(), palette.measured, 1.2));
            plot.line(line("model", model.clone(), palette.model, 1.8));
            plot.line(line("trial", trial.clone(), palette.missing, 1.8).style(LineStyle::dashed_dense()));
        }
        let ring = |points: Vec<[f64; 2]>, colour, shape, radius| {
            Points::new("", PlotPoints::from(points)).shape(shape).radius(radius).color(colour).filled(false)
        };
        plot.points(ring(model, palette.model, MarkerShape::Circle, 5.5).allow_hover(false));
        plot.points(ring(trial, palette.missing, MarkerShape::Diamond, 6.0).allow_hover(false));
        mark(plot, measured.into_iter(), palette.measured, MarkerShape::Circle, 3.5);
        let own = points(&|s| (s.run == self.run).then_some(s.measured));
        plot.points(ring(own, palette.accent, MarkerShape::Circle, 8.0).allow_hover(false));
    }

    fn draw_curve(&self, plot: &mut PlotUi<'_>, found: &Curve, colour: Color32, dashed: bool, y: &dyn Fn(c64) -> f64) {
        for (stable, piece) in pieces(found, self.channel, y) {
            let style = match (stable, dashed) {
                (false, _) => LineStyle::dotted_dense(),
                (true, true) => LineStyle::dashed_dense(),
                (true, false) => LineStyle::Solid,
            };
            plot.line(line("", piece, colour, 1.8).style(style));
        }
    }

    fn magnitude_plot<'a>(&self, ui: &Ui, id: &str, x: &'a str, label: &str) -> Plot<'a> {
        let palette = ui.palette();
        let y_axis = upright(palette, label).min_thickness(56.0).formatter(|mark, _| magnitude(mark));
        let unit = per_force(self.unit);
        let read = move |p: &egui_plot::PlotPoint, _: &egui_plot::PlotBounds| {
            format!("{}   {} {unit}", format::significant(p.x, 4), format::significant(10f64.powf(p.y), 3))
        };
        frame(ui, id, x, "")
            .custom_y_axes(vec![y_axis])
            .x_grid_spacer(round)
            .y_grid_spacer(magnitudes)
            .coordinates_formatter(Corner::RightTop, CoordinatesFormatter::new(read))
            .show_axes([!x.is_empty(), true])
    }
}

/// Magnitude on a linear axis: a linear structure shows a level line.
fn level_plot<'a>(ui: &Ui, label: &str, unit: &str, height: f32) -> Plot<'a> {
    let y_axis = upright(ui.palette(), label).min_thickness(56.0);
    let unit = per_force(unit);
    let read = move |p: &egui_plot::PlotPoint, _: &egui_plot::PlotBounds| {
        format!("{} N   {} {unit}", format::significant(p.x, 4), format::significant(p.y, 3))
    };
    frame(ui, "level magnitude", "", "")
        .custom_y_axes(vec![y_axis])
        .x_grid_spacer(round)
        .y_grid_spacer(lines(height))
        .coordinates_formatter(Corner::RightTop, CoordinatesFormatter::new(read))
        .show_axes([false, true])
}

fn phase_plot<'a>(ui: &Ui, id: &str, x: &'a str, height: f32) -> Plot<'a> {
    let degrees = upright(ui.palette(), "Phase, °").min_thickness(56.0);
    frame(ui, id, x, "")
        .custom_y_axes(vec![degrees])
        .x_grid_spacer(round)
        .y_grid_spacer(lines(height))
        .set_margin_fraction(egui::vec2(0.0, 0.15))
}

/// Lines at 1, 2 and 5 of each decade; where the range is short, at round numbers.
fn magnitudes(input: GridInput) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    if high - low > 20.0 {
        return log::decades(&input);
    }
    let decades = low.floor() as i32..=high.ceil() as i32;
    let all = decades.flat_map(|d| {
        [(1.0, 1.0), (2.0, 0.3), (5.0, 0.3)]
            .map(|(m, step_size)| GridMark { value: f64::from(d) + f64::log10(m), step_size })
    });
    let inside: Vec<GridMark> = all.filter(|mark| (low..=high).contains(&mark.value)).collect();
    if inside.len() > 1 {
        return inside;
    }
    let ends = [low, high].map(|v| 10f64.powf(v));
    let step = round_step((ends[1] - ends[0]).max(f64::MIN_POSITIVE), 3.0);
    let first = (ends[0] / step).ceil() as i64;
    (first..first + 8)
        .map(|k| GridMark { value: (k as f64 * step).log10(), step_size: 0.3 * (high - low) })
        .filter(|mark| mark.value <= high)
        .collect()
}

/// A number on an axis of magnitudes, without zeros at its end.
fn magnitude(mark: GridMark) -> String {
    let text = format::significant(10f64.powf(mark.value), 3);
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// `(m/s²)/N`.
fn per_force(unit: &str) -> String {
    let unit = format::pretty_unit(unit);
    if unit.contains('/') { format!("({unit})/N") } else { format!("{unit}/N") }
}

fn decades(z: c64) -> f64 {
    z.norm().max(f64::MIN_POSITIVE).log10()
}

fn mark(
    plot: &mut PlotUi<'_>,
    points: impl Iterator<Item = [f64; 2]>,
    colour: Color32,
    shape: MarkerShape,
    radius: f32,
) {
    let points: Vec<[f64; 2]> = points.collect();
    plot.points(Points::new("", PlotPoints::from(points)).shape(shape).radius(radius).color(colour).allow_hover(false));
}

/// The curve in pieces of one stability, cut where a phase jumps by a turn; pieces share their ends.
fn pieces(found: &Curve, channel: usize, y: &dyn Fn(c64) -> f64) -> Vec<(bool, Vec<[f64; 2]>)> {
    let mut pieces: Vec<(bool, Vec<[f64; 2]>)> = Vec::new();
    for point in &found.points {
        let Some(z) = point.ratios.get(channel) else { continue };
        let at = [point.frequency, y(*z)];
        match pieces.last_mut() {
            Some((stable, piece)) => {
                let last = piece.last().copied().unwrap_or(at);
                let jumps = (at[1] - last[1]).abs() > 180.0;
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
    use super::{per_force, phase, pieces};
    use crate::window::explained::curve::{Curve, CurvePoint};
    use faer::c64;

    #[test]
    fn a_curve_is_cut_where_it_loses_stability_and_where_its_phase_jumps() {
        let point = |frequency: f64, degrees: f64, stable| {
            let (s, c) = degrees.to_radians().sin_cos();
            CurvePoint { frequency, ratios: vec![c64::new(c, s)], stable }
        };
        let points = vec![
            point(1.0, 170.0, true),
            point(2.0, -175.0, true),
            point(3.0, -160.0, true),
            point(2.5, -150.0, false),
            point(2.6, -140.0, true),
        ];
        let found = pieces(&Curve { force: 1.0, points }, 0, &phase);
        let shape: Vec<(bool, usize)> = found.iter().map(|(stable, piece)| (*stable, piece.len())).collect();
        assert_eq!(shape, [(true, 1), (true, 2), (false, 2), (true, 2)]);
        assert_eq!(found[2].1[0], found[1].1[1], "pieces meet where the curve turns");
    }

    #[test]
    fn units_over_the_force_are_read_as_one() {
        assert_eq!(per_force("m/s^2"), "(m/s²)/N");
        assert_eq!(per_force("m"), "m/N");
    }
}
