//! A plot as plain data: axes with units, series with names. The screen, the SVG, the PNG and the table of values are all
//! made of it.

pub(crate) use super::axis::{Axis, Scale, Ticks};
use super::pyramid::Pyramid;
use ecolor::Color32;
use std::fmt;
use std::sync::Arc;

/// A function that is drawn as a curve.
#[derive(Clone)]
pub struct Curve(pub Arc<dyn Fn(f64) -> f64 + Send + Sync>);

impl fmt::Debug for Curve {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Curve")
    }
}

/// What a series holds.
#[derive(Debug, Clone)]
pub enum Data {
    /// Points x, y.
    Points(Vec<[f64; 2]>),
    /// A long record.
    Record(Arc<Pyramid>),
    /// A function between two values of x.
    Function(Curve, [f64; 2]),
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Look {
    /// A line of a width.
    Line(f32),
    /// A broken line of a width.
    Dashed(f32),
    /// A dotted line of a width.
    Dotted(f32),
    /// Filled points of a radius.
    Dots(f32),
    /// Rings of a radius.
    Rings(f32),
    /// Bars of a width from zero.
    Bars(f64),
    /// Upright lines at x, through the whole plot.
    Uprights(f32),
    /// Level lines at y, through the whole plot.
    Levels(f32),
}

/// A series.
#[derive(Debug, Clone)]
pub struct Series {
    /// Name in the key; empty for what needs none.
    pub name: String,
    /// Colour.
    pub colour: Color32,
    /// How it is drawn.
    pub look: Look,
    /// What it holds.
    pub data: Data,
    /// Standard deviation in y of each point; empty where there is none.
    pub deviation: Vec<f64>,
}

impl Series {
    /// Whether it holds nothing and only stands in the row of keys.
    pub fn is_key(&self) -> bool {
        !self.name.is_empty() && matches!(&self.data, Data::Points(p) if p.is_empty())
    }

    /// Points x, y in sight between two values of x, at most about so many as there are `columns`.
    pub fn points(&self, from: f64, to: f64, columns: usize) -> Vec<[f64; 2]> {
        match &self.data {
            Data::Points(points) => points.clone(),
            Data::Record(pyramid) => pyramid.polyline(from, to, columns),
            Data::Function(curve, [start, end]) => {
                let (from, to) = (from.max(*start), to.min(*end));
                let n = 2 * columns.max(1);
                let abscissa = |k: usize| from + (to - from) * k as f64 / n as f64;
                if to > from { (0..=n).map(|k| [abscissa(k), (curve.0)(abscissa(k))]).collect() } else { Vec::new() }
            }
        }
    }
}

/// Words at a point of a plot.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// The point x, y at the lower right end of the words.
    pub at: [f64; 2],
    /// The words.
    pub text: String,
    /// Their colour.
    pub colour: Color32,
}

/// A plot.
#[derive(Debug, Clone)]
pub struct Figure {
    /// What it shows.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Series from back to front.
    pub series: Vec<Series>,
    /// Words at points.
    pub labels: Vec<Label>,
    /// Whether a unit is as long on both axes.
    pub square: bool,
    /// Free room at each side of the curves, as a share of the width.
    pub margin: f32,
    /// Range of x at first; `None` shows everything.
    pub start: Option<[f64; 2]>,
}

impl Figure {
    /// An empty plot.
    pub fn new(title: &str, x: Axis, y: Axis) -> Self {
        Self {
            title: title.into(),
            x,
            y,
            series: Vec::new(),
            labels: Vec::new(),
            square: false,
            margin: 0.0,
            start: None,
        }
    }

    /// With one more series.
    #[must_use]
    pub fn with(mut self, name: &str, colour: Color32, look: Look, data: Data) -> Self {
        self.series.push(Series { name: name.into(), colour, look, data, deviation: Vec::new() });
        self
    }

    /// In the units that are shown on the screen.
    #[must_use]
    pub fn displayed(mut self) -> Self {
        (self.x, self.y) = (self.x.displayed(), self.y.displayed());
        self
    }

    /// With one more series of points.
    #[must_use]
    pub fn points(self, name: &str, colour: Color32, look: Look, points: Vec<[f64; 2]>) -> Self {
        self.with(name, colour, look, Data::Points(points))
    }

    /// With a key to a mark or a colour that several series share.
    #[must_use]
    pub fn key(self, name: &str, colour: Color32, look: Look) -> Self {
        self.points(name, colour, look, Vec::new())
    }

    /// With standard deviations of the last series.
    #[must_use]
    pub fn deviation(mut self, deviation: Vec<f64>) -> Self {
        if let Some(last) = self.series.last_mut() {
            last.deviation = deviation;
        }
        self
    }

    /// Ends of the bar of a standard deviation; on a logarithmic axis it ends at the least value of all where it reaches zero.
    pub fn deviation_bar(&self, [x, y]: [f64; 2], deviation: f64, least: f64) -> [[f64; 2]; 2] {
        let foot = if self.y.scale == Scale::Log { (y - deviation).max(least.min(y)) } else { y - deviation };
        [[x, foot], [x, y + deviation]]
    }

    /// The least positive value of all series of points.
    pub fn least(&self) -> f64 {
        let points = self.series.iter().filter_map(|s| if let Data::Points(p) = &s.data { Some(p) } else { None });
        points.flatten().map(|p| p[1]).filter(|y| *y > 0.0).fold(f64::INFINITY, f64::min)
    }

    /// All values in sight as a table with tabs: a block a series, its head with names and units.
    pub fn table(&self, from: f64, to: f64) -> String {
        let mut text = String::new();
        for series in &self.series {
            let only_lines = matches!(series.look, Look::Uprights(_) | Look::Levels(_)) && series.name.is_empty();
            if only_lines || series.is_key() {
                continue;
            }
            let deviations = !series.deviation.is_empty();
            text += &format!("{} ({})\t{} ({})", self.x.name, self.x.unit, self.y.name, self.y.unit).replace(" ()", "");
            text += &format!(" {}", series.name);
            text += if deviations { "\tstandard deviation\n" } else { "\n" };
            for (k, [x, y]) in series.points(from, to, 2000).into_iter().enumerate() {
                text += &format!("{:e}\t{:e}", self.x.factor * x, self.y.factor * y);
                if deviations {
                    let deviation = series.deviation.get(k).copied().unwrap_or(f64::NAN);
                    text += &format!("\t{:e}", self.y.factor * deviation);
                }
                text.push('\n');
            }
            text.push('\n');
        }
        text
    }

    /// First and last value of x of every record in it.
    pub fn spans(&self) -> Vec<[f64; 2]> {
        let span = |series: &Series| match &series.data {
            Data::Record(pyramid) => Some(pyramid.span()),
            _ => None,
        };
        self.series.iter().filter_map(span).collect()
    }

    /// Places of least and greatest x and y with a margin, for a drawing that nobody has zoomed.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let mut take = |axis: usize, place: Option<f64>| {
            if let Some(v) = place {
                range[axis] = [range[axis][0].min(v), range[axis][1].max(v)];
            }
        };
        for series in &self.series {
            for [x, y] in series.points(f64::NEG_INFINITY, f64::INFINITY, 2000) {
                if !matches!(series.look, Look::Levels(_)) {
                    take(0, self.x.place(x));
                }
                if !matches!(series.look, Look::Uprights(_)) {
                    take(1, self.y.place(y));
                }
            }
            if matches!(series.look, Look::Bars(_)) {
                take(1, self.y.place(0.0));
            }
        }
        self.x.include.iter().for_each(|v| take(0, self.x.place(*v)));
        self.y.include.iter().for_each(|v| take(1, self.y.place(*v)));
        let widened = |[low, high]: [f64; 2], margin: f64| {
            if !low.is_finite() || !high.is_finite() {
                return [0.0, 1.0];
            }
            let span = if high > low { high - low } else { low.abs().max(1.0) };
            [low - margin * span, high + margin * span]
        };
        [widened(range[0], f64::from(self.margin).max(0.02)), widened(range[1], 0.08)]
    }
}

/// A table with tabs as CSV: fields that hold a comma or a quotation mark stand in quotation marks.
pub(crate) fn csv(table: &str) -> String {
    let field = |text: &str| {
        let plain = !text.contains([',', '"']);
        if plain { text.to_owned() } else { format!("\"{}\"", text.replace('"', "\"\"")) }
    };
    let line = |line: &str| line.split('\t').map(field).collect::<Vec<_>>().join(",") + "\n";
    table.lines().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::{Axis, Curve, Data, Figure, Look};
    use ecolor::Color32;
    use std::sync::Arc;

    fn figure() -> Figure {
        let points = vec![[1.0, 10.0], [2.0, 1000.0], [3.0, -1.0]];
        Figure::new("f", Axis::new("Frequency", "Hz"), Axis::log("Receptance", "m/N"))
            .points("measured", Color32::RED, Look::Dots(3.0), points)
            .deviation(vec![0.1, 0.2, 0.3])
            .points("limit", Color32::BLUE, Look::Levels(1.0), vec![[0.0, 1.0]])
    }

    #[test]
    fn axes_place_values_and_take_them_back() {
        let axis = Axis::log("A", "m");
        assert_eq!(axis.place(1000.0), Some(3.0));
        assert_eq!(axis.place(0.0), None);
        assert!((axis.value(-2.0) - 0.01).abs() < 1e-15);
        assert_eq!(Axis::of("Force, N").label(), "Force, N");
        assert_eq!(Axis::of("Run").label(), "Run");
    }

    #[test]
    fn bounds_hold_every_point_that_has_a_place() {
        let [x, y] = figure().bounds();
        assert!(x[0] < 1.0 && x[1] > 3.0 && x[0] > 0.9, "{x:?}");
        assert!(y[0] < 0.0 && y[1] > 3.0 && y[0] > -0.5, "the level line counts: {y:?}");
    }

    #[test]
    fn the_table_names_units_and_holds_deviations() {
        let table = figure().table(0.0, 9.0);
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(lines[0], "Frequency (Hz)\tReceptance (m/N) measured\tstandard deviation");
        assert_eq!(lines[2], "2e0\t1e3\t2e-1");
    }

    #[test]
    fn a_table_becomes_csv() {
        assert_eq!(super::csv("a, b\tc\n1e0\t\"x\""), "\"a, b\",c\n1e0,\"\"\"x\"\"\"\n");
    }

    #[test]
    fn a_function_is_sampled_where_it_lives() {
        let square = Curve(Arc::new(|x| x * x));
        let f = Figure::new("f", Axis::new("x", ""), Axis::new("y", "")).with(
            "square",
            Color32::RED,
            Look::Line(1.0),
            Data::Function(square, [0.0, 2.0]),
        );
        let points = f.series[0].points(-5.0, 1.0, 50);
        assert_eq!((points[0], points[100]), ([0.0, 0.0], [1.0, 1.0]));
    }
}
