//! Two cursors of a plot and their differences: Shift and click sets them on the nearest point, a third click takes them
//! away.

use crate::display::format::{pretty_unit, significant, with_unit};
use crate::display::units::{self, Frequency};
use crate::plots::figure::{Axis, Figure, Look, Scale};
use crate::window::language::tr;
use crate::window::theme::{self, Palette};
use egui::{Align2, Color32, Context, Id, Rect, RichText, Vec2, pos2, vec2};
use egui_plot::{LineStyle, MarkerShape, PlotPoint, PlotUi, Points, VLine};

/// Distance within which a cursor takes the place of a point, points.
const REACH: f32 = 24.0;

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

    fn keep(&self, ctx: &Context, plot: &str) {
        ctx.data_mut(|d| d.insert_temp(id(plot), self.clone()));
    }

    /// One more cursor; a third takes them all away.
    fn set(&mut self, at: [f64; 2]) {
        if self.at.len() == 2 {
            self.at.clear();
        } else {
            self.at.push(at);
        }
    }

    /// What is read at the cursors, line by line: each, and their difference.
    pub(crate) fn words(&self, figure: &Figure) -> Vec<String> {
        let one =
            |k: usize| format!("{}:  {}   {}", k + 1, said(&figure.x, self.at[k][0]), said(&figure.y, self.at[k][1]));
        let mut lines: Vec<String> = (0..self.at.len()).map(one).collect();
        if let [a, b] = self.at[..] {
            lines.push(format!("Δ:  {}   {}", said(&figure.x, b[0] - a[0]), between(&figure.y, a[1], b[1])));
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
    for (k, at) in cursors.at.iter().enumerate() {
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

/// Lines of what is read, in the upper left corner of the plot.
pub(crate) fn paint(painter: &egui::Painter, frame: Rect, lines: &[String], palette: &Palette) {
    let font = theme::font(theme::size::SMALL);
    let galleys: Vec<_> =
        lines.iter().map(|line| painter.layout_no_wrap(tr(line), font.clone(), palette.ink)).collect();
    let size = galleys.iter().fold(Vec2::ZERO, |s, g| vec2(s.x.max(g.size().x), s.y + g.size().y));
    if size == Vec2::ZERO {
        return;
    }
    let corner = frame.left_top() + Vec2::splat(6.0);
    let ground = Rect::from_min_size(corner, size + vec2(12.0, 8.0));
    painter.rect(ground, 4.0, palette.pane, theme::hair(palette.line), egui::StrokeKind::Inside);
    let mut at = corner + vec2(6.0, 4.0);
    for galley in galleys {
        let height = galley.size().y;
        painter.galley(at, galley, Color32::PLACEHOLDER);
        at = pos2(at.x, at.y + height);
    }
}

#[cfg(test)]
mod tests {
    use super::Cursors;
    use crate::plots::figure::{Axis, Figure};

    #[test]
    fn two_cursors_read_their_difference_and_a_third_takes_them_away() {
        let figure = Figure::new("", Axis::new("Time", "s"), Axis::log("Receptance", "m/N"));
        let mut cursors = Cursors::default();
        cursors.set([0.1, 1e-3]);
        cursors.set([0.6, 1e-2]);
        let words = cursors.words(&figure);
        assert_eq!(words[0], "1:  0.10000 s   0.0010000 m/N");
        assert_eq!(words[2], "Δ:  0.50000 s   0.0090000 m/N   20.00 dB");
        assert_eq!(words[3], "1/Δ:  2.000 Hz");
        cursors.set([0.7, 1.0]);
        assert!(cursors.words(&figure).is_empty());
    }
}
