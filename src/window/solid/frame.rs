//! The ruled box about bars: floor, the two walls behind, a scale of values, labels along the two edges in front.

use super::camera::Projection;
use crate::plots::drawing::Drawing;
use crate::plots::ticks::tick;
use crate::window::appearance::theme::{self, Palette, size};
use egui::{Align2, Pos2, Vec2};
use nalgebra::Vector3;

/// A box of `count` x `count` cells, `height` high.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RuledBox<'a> {
    /// Cells along each side.
    pub count: usize,
    /// Height in cells.
    pub height: f32,
    /// Values at the floor and at the lid.
    pub values: [f64; 2],
    /// Distance of the lines of the scale.
    pub step: f64,
    /// Label of each row and column.
    pub labels: &'a [String],
    /// Title of the scale.
    pub unit: &'a str,
}

impl RuledBox<'_> {
    /// All eight corners.
    pub(crate) fn corners(&self) -> Vec<Vector3<f32>> {
        let n = self.count as f32;
        let corner =
            |k: usize| Vector3::new((k & 1) as f32 * n, ((k >> 1) & 1) as f32 * n, (k >> 2) as f32 * self.height);
        (0..8).map(corner).collect()
    }

    /// Height of a value above the floor.
    pub(crate) fn height_of(&self, value: f64) -> f32 {
        let [low, high] = self.values;
        ((value - low) / (high - low)) as f32 * self.height
    }

    /// Side of the box that is turned away from the eye, along an axis: 0 or `count`.
    fn behind(&self, p: &Projection, axis: usize) -> f32 {
        if p.camera.axes()[2][axis] > 0.0 { 0.0 } else { self.count as f32 }
    }

    fn in_front(&self, p: &Projection, axis: usize) -> f32 {
        self.count as f32 - self.behind(p, axis)
    }

    fn levels(&self) -> impl Iterator<Item = f64> + use<> {
        let ([low, high], step) = (self.values, self.step);
        let (first, last) = ((low / step - 1e-6).ceil() as i64, (high / step + 1e-6).floor() as i64);
        (first..=last).map(move |k| k as f64 * step)
    }

    /// Floor, walls and their lines: what stands behind the bars.
    pub(crate) fn back(&self, drawing: &mut Drawing, p: &Projection, palette: &Palette) {
        let n = self.count as f32;
        let floor = if p.camera.pitch >= 0.0 { 0.0 } else { self.height };
        let projected = |x: f32, y: f32, z: f32| p.at(Vector3::new(x, y, z));
        let (bx, by) = (self.behind(p, 0), self.behind(p, 1));
        let thin = theme::hair(palette.line);
        let fill = palette.pane;
        drawing.area(
            [projected(0., 0., floor), projected(n, 0., floor), projected(n, n, floor), projected(0., n, floor)],
            fill,
            thin,
        );
        let h = self.height;
        drawing.area(
            [projected(bx, 0., 0.), projected(bx, n, 0.), projected(bx, n, h), projected(bx, 0., h)],
            fill,
            thin,
        );
        drawing.area(
            [projected(0., by, 0.), projected(n, by, 0.), projected(n, by, h), projected(0., by, h)],
            fill,
            thin,
        );
        if self.count <= 40 {
            for k in 1..self.count {
                let k = k as f32;
                drawing.line([projected(k, 0., floor), projected(k, n, floor)], thin);
                drawing.line([projected(0., k, floor), projected(n, k, floor)], thin);
            }
        }
        for value in self.levels() {
            let z = self.height_of(value);
            let zero = value.abs() < 1e-9 * self.step;
            let line = if zero { theme::hair(palette.weak) } else { thin };
            drawing.line([projected(bx, 0., z), projected(bx, n, z)], line);
            drawing.line([projected(0., by, z), projected(n, by, z)], line);
        }
    }

    /// Scale and labels.
    pub(crate) fn rulers(
        &self,
        drawing: &mut Drawing,
        p: &Projection,
        palette: &Palette,
        stressed: Option<[usize; 2]>,
    ) {
        self.scale(drawing, p, palette);
        let n = self.count as f32;
        let (fx, fy) = (self.in_front(p, 0), self.in_front(p, 1));
        let stress = |k: usize| stressed.map(|s| s[k]);
        let column = |k: f32| Vector3::new(k + 0.5, fy, 0.0);
        let row = |k: f32| Vector3::new(fx, n - k - 0.5, 0.0);
        let out = |v: Vector3<f32>| (p.at(v) - p.at(Vector3::zeros())).normalized();
        let away_y = out(Vector3::y() * if fy > 0.0 { 1.0 } else { -1.0 });
        let away_x = out(Vector3::x() * if fx > 0.0 { 1.0 } else { -1.0 });
        self.edge(drawing, palette, |k| p.at(column(k)), away_y, stress(1));
        self.edge(drawing, palette, |k| p.at(row(k)), away_x, stress(0));
    }

    /// Labels along an edge, as many as there is room for.
    fn edge(
        &self,
        drawing: &mut Drawing,
        palette: &Palette,
        place_of: impl Fn(f32) -> Pos2,
        away: Vec2,
        stressed: Option<usize>,
    ) {
        let gap = (place_of(1.0) - place_of(0.0)).length();
        let longest = self.labels.iter().map(String::len).max().unwrap_or(1) as f32;
        let every = ((6.0 * longest + 6.0).min(24.0) / gap.max(0.5)).ceil().max(1.0) as usize;
        for (k, label) in self.labels.iter().enumerate() {
            let stress = stressed == Some(k);
            if k % every == 0 || stress {
                let colour = if stress { palette.accent } else { palette.weak };
                let place = place_of(k as f32) + away * 13.0;
                drawing.words(place, Align2::CENTER_CENTER, label.clone(), size::SMALL, colour);
            }
        }
        let middle = place_of(0.5 * self.count as f32 - 0.5) + away * (20.0 + 5.0 * longest.min(4.0));
        drawing.words(middle, Align2::CENTER_CENTER, "DOF", size::SMALL, palette.weak);
    }

    /// Values along the upright edge that stands furthest to the left.
    fn scale(&self, drawing: &mut Drawing, p: &Projection, palette: &Palette) {
        let n = self.count as f32;
        let foot = |k: usize, z: f32| p.at(Vector3::new((k & 1) as f32 * n, (k >> 1) as f32 * n, z));
        let Some(left) = (0..4).min_by(|a, b| foot(*a, 0.0).x.total_cmp(&foot(*b, 0.0).x)) else { return };
        let length = (foot(left, 0.0) - foot(left, self.height)).length();
        if length < 30.0 {
            return;
        }
        let room = length / (self.levels().count().max(2) - 1) as f32;
        let every = (13.0 / room).ceil().max(1.0) as usize;
        for (k, value) in self.levels().enumerate() {
            let at = foot(left, self.height_of(value));
            drawing.line([at, at - Vec2::new(4.0, 0.0)], theme::hair(palette.weak));
            if k % every == 0 {
                let place = at - Vec2::new(7.0, 0.0);
                drawing.words(place, Align2::RIGHT_CENTER, tick(value, self.step), size::SMALL, palette.weak);
            }
        }
        let top = foot(left, self.height) - Vec2::new(0.0, 15.0);
        drawing.words(top, Align2::CENTER_CENTER, self.unit, size::SMALL, palette.weak);
    }
}

#[cfg(test)]
mod tests {
    use super::RuledBox;

    #[test]
    fn steps_are_round_and_values_have_their_heights() {
        let b = RuledBox { count: 3, height: 2.0, values: [-1.0, 3.0], step: 1.0, labels: &[], unit: "" };
        assert_eq!([b.height_of(-1.0), b.height_of(0.0), b.height_of(3.0)], [0.0, 0.5, 2.0]);
        assert_eq!(b.levels().collect::<Vec<_>>(), [-1.0, 0.0, 1.0, 2.0, 3.0]);
        assert_eq!(b.corners().len(), 8);
    }
}
