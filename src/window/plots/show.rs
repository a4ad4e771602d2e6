//! Plots on the screen: drag pans, right drag zooms a box, double click shows all, the pointer reads out values, the context
//! menu copies and exports.

use super::corner::{AxesCorner, with_unit};
use super::polyline::Polyline;
use super::zoom::{Sight, Zoom};
use super::{axis, cursors, curve, export, frame};
use crate::display::format::significant;
use crate::plots::figure::{Axis, Data, Figure, Label, Look, Scale, Series, Ticks};
use crate::plots::sheet::{Panel, Sheet};
use crate::plots::{grid, ticks};
use crate::window::appearance::theme;
use crate::window::appearance::widgets::{UiExt, width};
use crate::window::language::{tf, tr};
use egui::{Align2, Id, Rangef, RichText, Role, ScrollArea, Sense, Shape, Ui, Vec2, WidgetInfo, vec2};
use egui_plot::{
    AxisHints, Bar, BarChart, CoordinatesFormatter, Corner, HLine, HPlacement, HoverPosition, Line, LineStyle,
    MarkerShape, PlotBounds, PlotPoint, PlotPoints, PlotResponse, PlotUi, Points, Text, VLine,
};

/// Breadth of the axis of y, points.
const NUMBERS_OF_Y: f32 = 62.0;
/// Least height of a plot in a stack without the axis of x, points; below it the stack scrolls.
const LEAST: f32 = 42.0;
/// Room that the largest marks take at the edge of a plot, points.
const MARK: f32 = 12.0;
/// Height of a pane below which keys stand close, and of a key, points.
const CRAMPED: f32 = 220.0;
const KEY: f32 = 14.0;
/// Height of a row of keys, points.
const KEYS: f32 = 26.0;
/// Height of the axis of x with its name, points.
pub(crate) const RULER: f32 = 36.0;
/// The same of numbers alone, and least height of a plot above them, points: before a plot is cut off by its pane, plots are lower and
/// the axis has no name, which the values under the pointer tell.
const NUMBERS: f32 = 18.0;
const LOWEST: f32 = 34.0;

/// Plots of one sheet: its title, and each plot with its share of the height.
#[derive(Debug)]
pub(crate) struct Stack<'a> {
    /// Tells it from others on the screen; another one starts with fresh axes.
    pub id: &'a str,
    /// Title of what is exported.
    pub title: &'a str,
    /// Plots from top to bottom with their shares of the height; they share the axis of x.
    pub figures: Vec<(Figure, f32)>,
    /// Whether a row of keys stands above.
    pub keys: bool,
}

impl Stack<'_> {
    /// Shows the plots under each other in the room there is.
    pub(crate) fn show(self, ui: &mut Ui) {
        let [least, lowest] =
            [[LEAST, RULER], [LOWEST, NUMBERS]].map(|[plot, axis]| plot * self.figures.len() as f32 + axis);
        // Before a plot is cut off, its keys give way: the pointer tells the name of a curve.
        let in_all = ui.available_height() - 4.0;
        if self.keys && !(lowest..lowest + KEYS).contains(&in_all) {
            key_row(ui, self.figures.iter().map(|(f, _)| f));
        }
        let room = ui.available_height() - 4.0;
        if room >= least {
            return self.plots(ui, room, RULER);
        }
        if room >= lowest {
            return self.plots(ui, room, NUMBERS);
        }
        ScrollArea::vertical().id_salt(("stack", self.id)).auto_shrink(false).show(ui, |ui| {
            // The uppermost number stands half above the plot.
            ui.add_space(theme::space::XS + 2.0);
            self.plots(ui, least, RULER);
        });
    }

    /// The plots in `height` points, `below` of which the axis of x takes.
    fn plots(self, ui: &mut Ui, height: f32, below: f32) {
        let group = (self.figures.len() > 1).then(|| Id::unique(("stack", self.id)));
        let last = self.figures.len().saturating_sub(1);
        let zoom = Zoom::begin(ui.ctx(), self.id);
        let mut panels = Vec::new();
        let mut responses = Vec::new();
        for (k, (figure, share)) in self.figures.into_iter().enumerate() {
            let figure = figure.displayed();
            let ruler = if k == last { below } else { 0.0 };
            // The axis of x takes room from the plots in proportion, not from the last one alone.
            let own = share * (height - below) + ruler;
            let place = Place { id: &format!("{} {k}", self.id), height: own, group, ruler };
            let out = place.draw(ui, &figure, &zoom, k);
            panels.push(Panel { figure, bounds: sight(&out) });
            responses.push(out.response);
        }
        let shown: Vec<_> = responses.iter().zip(&panels).map(|(r, p)| (r, &p.figure, p.bounds)).collect();
        zoom.end(ui, &shown);
        let sheet = Sheet { title: self.title.to_owned(), columns: 1, panels };
        export::offer_sheet(ui, &responses, sheet);
    }
}

/// A row of keys to all series that have a name, each with the mark it is drawn with.
pub(crate) fn key_row<'a>(ui: &mut Ui, figures: impl Iterator<Item = &'a Figure>) {
    let mut entries: Vec<&Series> = Vec::new();
    for series in figures.flat_map(|f| &f.series) {
        if !series.name.is_empty() && entries.iter().all(|e| e.name != series.name) {
            entries.push(series);
        }
    }
    // Where the plot is low and the keys wrap, their rows stand closer.
    let (low, room) = (ui.available_height() < CRAMPED, ui.available_width());
    let total: f32 = entries.iter().map(|series| key_size(ui, series).x + theme::space::XS).sum();
    ui.scope(|ui| {
        if low && total > room {
            ui.spacing_mut().interact_size.y = KEY;
        }
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = vec2(theme::space::XS, 1.0);
            entries.into_iter().for_each(|series| key(ui, series));
        });
    });
    ui.add_space(theme::space::XS);
}

/// Room of a mark and its name.
fn key_size(ui: &Ui, series: &Series) -> Vec2 {
    vec2(22.0 + width(ui, &series.name, theme::font(theme::size::SMALL)) + theme::space::S, KEY)
}

/// A mark and a name that stay together where the row wraps.
fn key(ui: &mut Ui, series: &Series) {
    let palette = ui.palette();
    let text = ui.painter().layout_no_wrap(tr(&series.name), theme::font(theme::size::SMALL), palette.weak);
    let size = key_size(ui, series).max(vec2(0.0, text.size().y));
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, tr(&series.name)));
    let (left, middle) = (rect.left_center(), rect.left_center() + vec2(8.0, 0.0));
    let painter = ui.painter();
    match series.look {
        Look::Dots(_) => drop(painter.circle_filled(middle, 3.5, series.colour)),
        Look::Rings(_) => drop(painter.circle_stroke(middle, 4.0, theme::pen(series.colour))),
        Look::Dashed(_) | Look::Dotted(_) | Look::Levels(_) => {
            let ends = [left, left + vec2(16.0, 0.0)];
            painter.extend(Shape::dashed_line(&ends, theme::pen(series.colour), 4.0, 3.0));
        }
        _ => drop(painter.line_segment([left, left + vec2(16.0, 0.0)], theme::bold(series.colour))),
    }
    painter.galley(rect.left_center() + vec2(22.0, -0.5 * text.size().y), text, palette.weak);
}

/// Where and how a plot stands on the screen.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place<'a> {
    /// Tells it from others.
    pub id: &'a str,
    /// Height, points.
    pub height: f32,
    /// Plots whose axes of x and cursors move together.
    pub group: Option<Id>,
    /// Height of the axis of x, points: none, numbers alone, or with its name ([`RULER`]).
    pub ruler: f32,
}

/// What is in sight of a plot.
pub(crate) fn sight(out: &PlotResponse<()>) -> Sight {
    let (low, high) = (out.transform.bounds().min(), out.transform.bounds().max());
    [[low[0], high[0]], [low[1], high[1]]]
}

impl Place<'_> {
    /// Shows a plot that stands alone.
    pub(crate) fn show(&self, ui: &mut Ui, figure: &Figure) -> PlotResponse<()> {
        let zoom = Zoom::begin(ui.ctx(), self.id);
        let out = self.draw(ui, figure, &zoom, 0);
        zoom.end(ui, &[(&out.response, figure, sight(&out))]);
        out
    }

    /// Axes of a plot: their names where there is room, numbers that give way to each other in the corner.
    fn axes(&self, ui: &Ui, figure: &Figure, corner: &AxesCorner) -> (AxisHints<'static>, AxisHints<'static>) {
        let palette = ui.palette();
        let (x, y) = (figure.x.clone(), figure.y.clone());
        let (along_x, along_y) = (corner.clone(), corner.clone());
        let named = self.ruler >= RULER;
        let x_label = if named { fitting(ui, &x, ui.available_width() - 80.0) } else { String::new() };
        let y_label = fitting(ui, &y, self.height - self.ruler);
        // An axis without a name tells its unit beside a number.
        let unit = if !named && x.scale == Scale::Linear { tr(&x.unit) } else { String::new() };
        let breadth = f64::from(ui.available_width() - NUMBERS_OF_Y);
        let spacing = if x.ticks == Ticks::Whole { Rangef::new(12.0, 18.0) } else { Rangef::new(22.0, 34.0) };
        let x_axis = axis(AxisHints::new_x(), palette, &x_label)
            .min_thickness(if named { 32.0 } else { 14.0 })
            .label_spacing(spacing)
            .formatter(move |mark, range| {
                let label = along_x.across(tr(ticks::label(&x, own(mark))), mark.value, range);
                with_unit(label, &unit, mark.value, mark.step_size, range, breadth)
            });
        let y_axis = axis(AxisHints::new_y(), palette, &y_label)
            .placement(HPlacement::Left)
            .min_thickness(NUMBERS_OF_Y)
            // Lines of text lie closer than words beside each other.
            .label_spacing(Rangef::new(13.0, 20.0))
            .formatter(move |mark, range| along_y.upwards(tr(ticks::label(&y, own(mark))), mark.value, range));
        (x_axis, y_axis)
    }

    /// Draws a plot, the one of that number in its history of zooms.
    fn draw(&self, ui: &mut Ui, figure: &Figure, zoom: &Zoom, number: usize) -> PlotResponse<()> {
        let palette = ui.palette();
        let (x, y) = (figure.x.clone(), figure.y.clone());
        let clear = self.height - self.ruler;
        let size = [ui.available_width() - NUMBERS_OF_Y, clear];
        let corner = AxesCorner::of(ui, self.id, size, figure.square && self.ruler > 0.0);
        let (x_axis, y_axis) = self.axes(ui, figure, &corner);
        let mut plot = frame(ui, self.id)
            .custom_x_axes(vec![x_axis])
            .custom_y_axes(vec![y_axis])
            .height(self.height)
            .show_axes([self.ruler > 0.0, true])
            .coordinates_formatter(Corner::RightTop, read_out(&figure.x, &figure.y))
            .set_margin_fraction(vec2(figure.margin, (MARK / clear.max(1.0)).max(0.08)))
            .label_formatter(near(figure));
        plot = plot.x_grid_spacer(move |input| marks(&x, input, ticks::ACROSS));
        plot = plot.y_grid_spacer(move |input| marks(&y, input, ticks::UPWARDS));
        if let Some(group) = self.group {
            plot = plot.link_axis(group, [true, false]).link_cursor(group, [true, false]);
        }
        if figure.square {
            plot = plot.data_aspect(1.0);
        }
        if let Some([from, to]) = figure.start.map(|range| range.map(|v| figure.x.factor * v)) {
            plot = plot.default_x_bounds(from, to);
        } else {
            // A record gives no more than what is in sight: its ends are told.
            for v in figure.spans().into_iter().flatten().filter_map(|v| figure.x.place(v)) {
                plot = plot.include_x(v);
            }
        }
        for v in figure.x.include.iter().filter_map(|v| figure.x.place(*v)) {
            plot = plot.include_x(v);
        }
        for v in figure.y.include.iter().filter_map(|v| figure.y.place(*v)) {
            plot = plot.include_y(v);
        }
        let mut read = Vec::new();
        let out = plot.show(ui, |plot| {
            reset(plot, figure);
            zoom.apply(plot, number);
            figure.series.iter().for_each(|s| series(plot, figure, s));
            figure.labels.iter().for_each(|l| words(plot, figure, l));
            read = cursors::show(plot, self.id, figure, palette).words(figure, None);
        });
        corner.keep(ui);
        let frame = *out.transform.frame();
        cursors::paint(&ui.painter_at(frame), &read, palette, frame.left_top() + Vec2::splat(6.0));
        out
    }
}

/// Names of axes and how they are cut short where a plot is low.
const SHORT: [(&str, &str); 12] = [
    ("Acceleration", "Acc."),
    ("Amplitude", "Ampl."),
    ("Damping ratio", "Damping"),
    ("Displacement", "Displ."),
    ("Frequency", "Freq."),
    ("Imaginary part", "Imag."),
    ("Magnitude", "Mag."),
    ("Phase", "φ"),
    ("Real part", "Real"),
    ("Residual", "Res."),
    ("Rotation", "Rot."),
    ("Velocity", "Vel."),
];

/// Name and unit of an axis where there is room for both, else a short name and the unit, else both in two lines, else the unit,
/// else nothing: a name that runs into another says less than none.
fn fitting(ui: &Ui, axis: &Axis, room: f32) -> String {
    let width = |text: &str| {
        let font = theme::font(theme::size::SMALL);
        ui.painter().layout_no_wrap(tr(text), font, egui::Color32::PLACEHOLDER).size().x
    };
    let short = SHORT.iter().find(|(name, _)| *name == axis.name).map_or(axis.name.as_str(), |(_, short)| short);
    let short = Axis { name: tr(short), ..axis.clone() };
    let folded = if axis.unit.is_empty() { short.name.clone() } else { format!("{},\n{}", short.name, axis.unit) };
    let choices = [axis.label(), short.label(), folded, axis.unit.clone()];
    choices.into_iter().find(|text| width(text) + 6.0 <= room).unwrap_or_default()
}

/// Grid lines in the terms of the plot.
fn marks(axis: &Axis, input: egui_plot::GridInput, room: f64) -> Vec<egui_plot::GridMark> {
    let input = grid::GridInput { bounds: input.bounds, base_step_size: input.base_step_size };
    let plots = |m: grid::GridMark| egui_plot::GridMark { value: m.value, step_size: m.step_size };
    ticks::marks(axis, &input, room).into_iter().map(plots).collect()
}

fn own(mark: egui_plot::GridMark) -> grid::GridMark {
    grid::GridMark { value: mark.value, step_size: mark.step_size }
}

/// A double click shows all of a plot that starts with a part, and where all is in sight that part again; the plot's own
/// reset knows the part only.
fn reset(plot: &mut PlotUi<'_>, figure: &Figure) {
    let start = figure.start.map(|range| range.map(|v| figure.x.factor * v));
    let (Some(part), true) = (start, plot.response().double_clicked()) else { return };
    let all = figure.bounds()[0];
    let now = plot.plot_bounds();
    let whole = now.width() >= 0.98 * (all[1] - all[0]);
    let [from, to] = if whole { part } else { all };
    plot.set_plot_bounds_x(from..=to);
}

/// The values under the pointer, in the corner.
fn read_out<'a>(x: &Axis, y: &Axis) -> CoordinatesFormatter<'a> {
    let (x, y) = (x.clone(), y.clone());
    let read_out_at = |axis: &Axis, place: f64| match &axis.ticks {
        Ticks::Names(names) => names.get(place.round().max(0.0) as usize).cloned().unwrap_or_default(),
        Ticks::Whole => format!("{} {:.0}", axis.name, place),
        _ => format!("{} {}", significant(axis.read(place), 4), axis.unit),
    };
    CoordinatesFormatter::new(move |p: &PlotPoint, _: &PlotBounds| {
        tf!("{}   {}", read_out_at(&x, p.x), read_out_at(&y, p.y))
    })
}

/// The values of the point that the pointer is near to.
fn near<'a>(figure: &Figure) -> impl Fn(&HoverPosition<'_>) -> Option<String> + use<'a> {
    let (x, y) = (figure.x.clone(), figure.y.clone());
    let deviations: Vec<(String, Vec<f64>)> =
        figure.series.iter().map(|s| (s.name.clone(), s.deviation.clone())).collect();
    move |hover| match hover {
        HoverPosition::NearDataPoint { plot_name, position, index } => {
            let own = deviations.iter().find(|(name, _)| name == plot_name);
            let deviation = own.and_then(|(_, d)| d.get(*index)).copied().unwrap_or(0.0);
            let (u, v) = (x.read(position.x), y.read(position.y));
            let value = crate::display::format::with_deviation(v, y.factor * deviation, "");
            Some(tf!("{plot_name}\n{} {}\n{value} {}", significant(u, 5), x.unit, y.unit))
        }
        HoverPosition::Elsewhere { .. } => None,
    }
}

/// Words at a point, ending there.
fn words(plot: &mut PlotUi<'_>, figure: &Figure, label: &Label) {
    let (Some(x), Some(y)) = (figure.x.place(label.at[0]), figure.y.place(label.at[1])) else { return };
    let text = RichText::new(tr(&label.text)).size(theme::size::SMALL).color(label.colour);
    // Where a line leaves the plot at the top its name stands below the edge.
    let (top, height) = (plot.plot_bounds().max()[1], plot.plot_bounds().height());
    let room = f64::from(theme::size::SMALL + 6.0) / f64::from(plot.transform().frame().height()).max(1.0);
    let (y, anchor) = if y > top - room * height { (y.min(top), Align2::RIGHT_TOP) } else { (y, Align2::RIGHT_BOTTOM) };
    plot.text(Text::new("", PlotPoint::new(x, y), text).anchor(anchor).allow_hover(false));
}

fn series(plot: &mut PlotUi<'_>, figure: &Figure, series: &Series) {
    let bounds = plot.plot_bounds();
    let columns = f64::from(plot.transform().frame().width()).max(1.0);
    let [from, to] = [bounds.min()[0], bounds.max()[0]].map(|v| figure.x.value(v));
    let points = series.points(from, to, columns as usize);
    let places: Vec<[f64; 2]> =
        points.iter().filter_map(|p| Some([figure.x.place(p[0])?, figure.y.place(p[1])?])).collect();
    let name = series.name.as_str();
    let markers = |radius: f32, filled: bool, places: Vec<[f64; 2]>| {
        let points = Points::new(name, PlotPoints::from(places)).shape(MarkerShape::Circle);
        points.radius(radius).filled(filled).color(series.colour)
    };
    match series.look {
        Look::Line(width) if matches!(series.data, Data::Record(_)) => {
            plot.line(curve(name, places, series.colour, width));
        }
        Look::Line(width) => plot.add(Polyline::new(name, &places, egui::Stroke::new(width, series.colour))),
        Look::Dashed(width) => plot.line(curve(name, places, series.colour, width).style(LineStyle::dashed_dense())),
        Look::Dotted(width) => plot.line(curve(name, places, series.colour, width).style(LineStyle::dotted_dense())),
        Look::Dots(radius) => plot.points(markers(radius, true, places)),
        Look::Rings(radius) => plot.points(markers(radius, false, places)),
        Look::Bars(width) => {
            let width = figure.x.factor * width;
            let bar = |p: &[f64; 2]| Bar::new(p[0], p[1]).width(width).fill(series.colour);
            plot.bar_chart(BarChart::new(name, places.iter().map(bar).collect()).allow_hover(false));
        }
        Look::Uprights(width) => places.iter().for_each(|p| {
            plot.vline(VLine::new(name, p[0]).color(series.colour).width(width).allow_hover(false));
        }),
        Look::Levels(width) => points.iter().filter_map(|p| figure.y.place(p[1])).for_each(|y| {
            let line = HLine::new(name, y).color(series.colour).width(width).style(LineStyle::dashed_loose());
            plot.hline(line.allow_hover(false));
        }),
    }
    let least = figure.least();
    for (&point, &d) in points.iter().zip(&series.deviation) {
        let ends = figure.deviation_bar(point, d, least);
        if let [Some(a), Some(b)] = ends.map(|p| Some([figure.x.place(p[0])?, figure.y.place(p[1])?])) {
            plot.line(Line::new(name, vec![a, b]).color(series.colour).width(1.4).allow_hover(false));
        }
    }
}
