//! Two cursors of a plot and their differences: Shift and click sets them on the nearest point, a third click takes them
//! away.

use crate::display::format::{pretty_unit, significant, with_unit};
use crate::display::units::{self, Frequency};
use crate::plots::figure::{Axis, Figure, Look, Scale, Ticks};
use crate::window::appearance::theme::{self, Palette};
use crate::window::language::tr;
use egui::{Align2, Color32, Context, Galley, Id, Pos2, Rect, RichText, Vec2, pos2, vec2};
use egui_plot::{LineStyle, MarkerShape, PlotPoint, PlotUi, Points, VLine};
use std::sync::Arc;

/// Distance within which a cursor takes the place of a point, points.
const REACH: f32 = 24.0;

/// What is read of a map of cells at a place: its axis and its value there.
pub(super) struct Reading<'a> {
    /// Name and unit.
    pub axis: Axis,
    /// The value at x and y; `None` where there is no cell.
    pub value: &'a dyn Fn([f64; 2]) -> Option<f64>,
}

/// Cursors of one plot in the terms of its figure: at most two.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Cursors {
    at: Vec<[f64; 2]>,
}

impl Cursors {
    /// Those of a plot.
    pub(crate) fn of(ctx: &Context, plot: &str) -> Self {
        ctx.data(|d| d.get_temp::<Self>(id(plot))).unwrap_or_default()
    }

    pub(super) fn keep(&self, ctx: &Context, plot: &str) {
        ctx.data_mut(|d| d.insert_temp(id(plot), self.clone()));
    }

    /// One more cursor; a third takes them all away.
    pub(super) fn set(&mut self, at: [f64; 2]) {
        if self.at.len() == 2 {
            self.at.clear();
        } else {
            self.at.push(at);
        }
    }

    /// Where they stand.
    pub(super) fn places(&self) -> &[[f64; 2]] {
        &self.at
    }

    /// What is read at the cursors, line by line: each, and their difference.
    pub(super) fn words(&self, figure: &Figure, reading: Option<&Reading<'_>>) -> Vec<String> {
        let read = |at: [f64; 2]| reading.and_then(|r| Some((&r.axis, (r.value)(at)?)));
        let line = |mark: &str, parts: Vec<String>| format!("{mark}:  {}", parts.join("   "));
        let cursor_words = |k: usize| {
            let at = self.at[k];
            let mut parts = vec![said(&figure.x, at[0]), said(&figure.y, at[1])];
            parts.extend(read(at).map(|(axis, value)| said(axis, value)));
            line(&(k + 1).to_string(), parts)
        };
        let mut lines: Vec<String> = (0..self.at.len()).map(cursor_words).collect();
        if let [a, b] = self.at[..] {
            let axes = [(&figure.x, a[0], b[0]), (&figure.y, a[1], b[1])];
            let measured = axes.into_iter().filter(|(axis, ..)| !matches!(axis.ticks, Ticks::Names(_)));
            let mut parts: Vec<String> = measured.map(|(axis, a, b)| between(axis, a, b)).collect();
            parts.extend(read(a).zip(read(b)).map(|((axis, a), (_, b))| between(axis, a, b)));
            if !parts.is_empty() {
                lines.push(line("Δ", parts));
            }
            if figure.x.unit == "s" && b[0] != a[0] {
                let inverse = if units::now().frequency == Frequency::Hertz { "1/Δ" } else { "2π/Δ" };
                lines.push(format!("{inverse}:  {}", with_unit(1.0 / (b[0] - a[0]).abs(), "Hz")));
            }
        }
        lines
    }
}

fn id(plot: &str) -> Id {
    Id::NULL.with(("cursors", plot))
}

fn said(axis: &Axis, value: f64) -> String {
    if let Ticks::Names(names) = &axis.ticks {
        let name = names.get(value.round().max(0.0) as usize).map_or("", String::as_str);
        return format!("{} {name}", tr(&axis.name)).trim().to_owned();
    }
    format!("{} {}", significant(axis.factor * value, 5), pretty_unit(&axis.unit)).trim_end().to_owned()
}

/// The difference of two values; on a logarithmic axis their ratio in decibels beside it.
fn between(axis: &Axis, a: f64, b: f64) -> String {
    let plain = said(axis, b - a);
    if axis.scale == Scale::Log && a > 0.0 && b > 0.0 {
        format!("{plain}   {} dB", significant(20.0 * (b / a).log10(), 4))
    } else {
        plain
    }
}

/// Sets a cursor where the plot was clicked with Shift, and draws those that there are.
pub(crate) fn show(plot: &mut PlotUi<'_>, name: &str, figure: &Figure, palette: &Palette) -> Cursors {
    let ctx = plot.ctx().clone();
    let mut cursors = Cursors::of(&ctx, name);
    let clicked = plot.response().clicked() && ctx.input(|i| i.modifiers.shift);
    if let (true, Some(at)) = (clicked, plot.pointer_coordinate()) {
        let free = [figure.x.value(at.x), figure.y.value(at.y)];
        cursors.set(nearest(plot, figure, at).unwrap_or(free));
        cursors.keep(&ctx, name);
    }
    for (k, at) in cursors.places().iter().enumerate() {
        let (Some(x), Some(y)) = (figure.x.place(at[0]), figure.y.place(at[1])) else { continue };
        let line = VLine::new(format!("cursor {}", k + 1), x).color(palette.accent).width(1.0);
        plot.vline(line.style(LineStyle::dashed_loose()).allow_hover(false));
        let mark = Points::new("", vec![[x, y]]).shape(MarkerShape::Diamond).radius(4.5).color(palette.accent);
        plot.points(mark.allow_hover(false));
        let text = RichText::new((k + 1).to_string()).size(theme::size::SMALL).color(palette.accent);
        let word = egui_plot::Text::new("", PlotPoint::new(x, y), text).anchor(Align2::LEFT_BOTTOM);
        plot.text(word.allow_hover(false));
    }
    cursors
}

/// The point of the curves that is nearest on the screen, within reach.
fn nearest(plot: &PlotUi<'_>, figure: &Figure, at: PlotPoint) -> Option<[f64; 2]> {
    let pointer = plot.screen_from_plot(at);
    let bounds = plot.plot_bounds();
    let [from, to] = [bounds.min()[0], bounds.max()[0]].map(|v| figure.x.value(v));
    let columns = plot.transform().frame().width().max(1.0) as usize;
    let curves =
        figure.series.iter().filter(|s| !matches!(s.look, Look::Uprights(_) | Look::Levels(_) | Look::Bars(_)));
    let distance = |point: [f64; 2]| {
        let place = PlotPoint::new(figure.x.place(point[0])?, figure.y.place(point[1])?);
        Some((plot.screen_from_plot(place).distance(pointer), point))
    };
    let points = curves.flat_map(|s| s.points(from, to, columns)).filter_map(distance);
    let best = points.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (best.0 <= REACH).then_some(best.1)
}

/// Size of the box of these lines, points.
pub(crate) fn size(painter: &egui::Painter, lines: &[String]) -> Vec2 {
    let sizes = lines.iter().map(|line| laid_out(painter, line).size());
    sizes.fold(Vec2::ZERO, |s, line| vec2(s.x.max(line.x), s.y + line.y)) + vec2(12.0, 8.0)
}

/// Lines of what is read, in a box with this upper left corner.
pub(crate) fn paint(painter: &egui::Painter, lines: &[String], palette: &Palette, corner: Pos2) {
    if lines.is_empty() {
        return;
    }
    let ground = Rect::from_min_size(corner, size(painter, lines));
    painter.rect(ground, 4.0, palette.pane, theme::hair(palette.line), egui::StrokeKind::Inside);
    let mut at = ground.min + vec2(6.0, 4.0);
    for galley in lines.iter().map(|line| laid_out(painter, line)) {
        let height = galley.size().y;
        painter.galley(at, galley, palette.ink);
        at = pos2(at.x, at.y + height);
    }
}

fn laid_out(painter: &egui::Painter, line: &str) -> Arc<Galley> {
    painter.layout_no_wrap(tr(line), theme::font(theme::size::SMALL), Color32::PLACEHOLDER)
}

#[cfg(test)]
mod tests {
    use super::{Cursors, Reading};
    use crate::plots::figure::{Axis, Figure, Ticks};

    #[test]
    fn two_cursors_read_their_difference_and_a_third_takes_them_away() {
        let figure = Figure::new("", Axis::new("Time", "s"), Axis::log("Receptance", "m/N"));
        let mut cursors = Cursors::default();
        cursors.set([0.1, 1e-3]);
        cursors.set([0.6, 1e-2]);
        let words = cursors.words(&figure, None);
        assert_eq!(words[0], "1:  0.10000 s   0.0010000 m/N");
        assert_eq!(words[2], "Δ:  0.50000 s   0.0090000 m/N   20.00 dB");
        assert_eq!(words[3], "1/Δ:  2.000 Hz");
        cursors.set([0.7, 1.0]);
        assert!(cursors.words(&figure, None).is_empty());
    }

    #[test]
    fn cells_have_names_and_values_and_only_values_differ() {
        let names = || Ticks::Names(["a", "b", "c"].map(str::to_owned).into());
        let (x, y) = (Axis::new("Column", "").ticks(names()), Axis::new("", "").ticks(names()));
        let figure = Figure::new("", x, y);
        let value = |[x, y]: [f64; 2]| (y < 2.0).then_some(10.0 * y + x);
        let reading = Reading { axis: Axis::new("", "N s/m"), value: &value };
        let mut cursors = Cursors::default();
        cursors.set([0.0, 1.0]);
        cursors.set([2.0, 0.0]);
        let words = cursors.words(&figure, Some(&reading));
        assert_eq!(words, ["1:  Column a   b   10.000 N·s/m", "2:  Column c   a   2.0000 N·s/m", "Δ:  −8.0000 N·s/m"]);
    }
}
