//! A curve through its points as they are. The line of `egui_plot` becomes a band where points are dense, which is right
//! for records and draws steep, smooth curves in steps.

use egui::{Color32, Pos2, Shape, Stroke, Ui};
use egui_plot::{PlotBounds, PlotGeometry, PlotItem, PlotItemBase, PlotPoint, PlotTransform};
use std::ops::RangeInclusive;

/// Points on the screen nearer than this are one.
const NEAR: f32 = 0.3;

/// A curve.
pub(crate) struct Polyline {
    base: PlotItemBase,
    places: Vec<PlotPoint>,
    stroke: Stroke,
}

impl Polyline {
    /// Through places on the axes.
    pub(crate) fn new(name: &str, places: &[[f64; 2]], stroke: Stroke) -> Self {
        let places = places.iter().map(|p| PlotPoint::new(p[0], p[1])).collect();
        Self { base: PlotItemBase::new(name.to_owned()), places, stroke }
    }
}

/// Runs of points between `left` and `right`, with one point beyond on each side, without points that fall on the last.
fn runs(points: impl Iterator<Item = Pos2>, left: f32, right: f32) -> Vec<Vec<Pos2>> {
    let mut runs: Vec<Vec<Pos2>> = Vec::new();
    let mut open = false;
    let mut before: Option<Pos2> = None;
    for at in points {
        let crosses = before.is_some_and(|b| b.x.max(at.x) >= left && b.x.min(at.x) <= right);
        if !crosses {
            open = false;
        } else if let (true, Some(run)) = (open, runs.last_mut()) {
            if run.last().is_none_or(|last| last.distance(at) > NEAR) {
                run.push(at);
            }
        } else {
            runs.push(before.into_iter().chain([at]).collect());
            open = true;
        }
        before = Some(at);
    }
    runs
}

impl PlotItem for Polyline {
    fn shapes(&self, _ui: &Ui, transform: &PlotTransform, shapes: &mut Vec<Shape>) {
        let frame = transform.frame();
        let points = self.places.iter().map(|p| transform.position_from_point(p));
        shapes.extend(runs(points, frame.left(), frame.right()).into_iter().map(|run| Shape::line(run, self.stroke)));
    }

    fn initialize(&mut self, _x_range: RangeInclusive<f64>) {}

    fn color(&self) -> Color32 {
        self.stroke.color
    }

    fn allow_hover(&self) -> bool {
        false
    }

    fn geometry(&self) -> PlotGeometry<'_> {
        PlotGeometry::None
    }

    fn bounds(&self) -> PlotBounds {
        let mut bounds = PlotBounds::NOTHING;
        for p in &self.places {
            bounds.extend_with(p);
        }
        bounds
    }

    fn base(&self) -> &PlotItemBase {
        &self.base
    }

    fn base_mut(&mut self) -> &mut PlotItemBase {
        &mut self.base
    }
}

#[cfg(test)]
mod tests {
    use super::runs;
    use egui::pos2;

    #[test]
    fn a_curve_reaches_over_both_edges_and_no_further() {
        let points = (0..100).map(|k| pos2(k as f32 * 10.0, (k * k) as f32));
        let found = runs(points, 205.0, 395.0);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0][0].x, found[0][found[0].len() - 1].x), (200.0, 400.0));
    }

    #[test]
    fn a_curve_that_leaves_and_returns_is_two() {
        let x = [0.0, 50.0, 150.0, 160.0, 50.0, 0.0];
        let found = runs(x.into_iter().map(|x| pos2(x, 0.0)), 0.0, 100.0);
        assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [3, 3]);
    }

    #[test]
    fn points_that_fall_together_are_one() {
        let points = (0..1000).map(|k| pos2(k as f32 * 0.01, 0.0));
        let found = runs(points, 0.0, 10.0);
        assert!((30..40).contains(&found[0].len()), "{}", found[0].len());
    }
}
