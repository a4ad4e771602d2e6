//! Drawings on the screen: the same marks as in a file, by a painter of egui.

use crate::plots::drawing::{Drawing, Mark, Stroke};
use crate::window::appearance::theme;
use crate::window::language::tr;
use egui::{Painter, Pos2, Shape, Vec2};

impl From<Stroke> for egui::Stroke {
    fn from(stroke: Stroke) -> Self {
        Self::new(stroke.width, stroke.color)
    }
}

impl From<egui::Stroke> for Stroke {
    fn from(stroke: egui::Stroke) -> Self {
        Self::new(stroke.width, stroke.color)
    }
}

impl Drawing {
    /// Paints it with its top left corner at `origin`, without the ground.
    pub fn paint(&self, painter: &Painter, origin: Pos2) {
        let mut painter = painter.clone();
        let whole = painter.clip_rect();
        for mark in &self.marks {
            match mark {
                Mark::Inside(rect, _) => painter.set_clip_rect(rect.translate(origin.to_vec2()).intersect(whole)),
                Mark::Whole => painter.set_clip_rect(whole),
                _ => paint(&painter, mark, origin.to_vec2()),
            }
        }
    }
}

fn paint(painter: &Painter, mark: &Mark, by: Vec2) {
    let moved = |points: &[Pos2]| points.iter().map(|p| *p + by).collect::<Vec<_>>();
    match mark {
        Mark::Line { points, stroke, dashed: false } => {
            painter.add(Shape::line(moved(points), egui::Stroke::from(*stroke)));
        }
        Mark::Line { points, stroke, .. } => painter.extend(Shape::dashed_line(&moved(points), *stroke, 6.0, 4.0)),
        Mark::Area { points, fill, stroke } => {
            painter.add(Shape::convex_polygon(moved(points), *fill, egui::Stroke::from(*stroke)));
        }
        Mark::Disc { centre, radius, fill, stroke } => drop(painter.circle(*centre + by, *radius, *fill, *stroke)),
        Mark::Words { at, align, text, size, colour, upright: false } => {
            painter.text(*at + by, *align, tr(text), theme::font(*size), *colour);
        }
        Mark::Words { at, text, size, colour, .. } => {
            let galley = painter.layout_no_wrap(tr(text), theme::font(*size), *colour);
            let (w, h) = (galley.size().x, galley.size().y);
            let start = *at + by + Vec2::new(-0.5 * h, 0.5 * w);
            let shape = egui::epaint::TextShape::new(start, galley, *colour).with_angle(-std::f32::consts::FRAC_PI_2);
            painter.add(shape);
        }
        Mark::Inside(..) | Mark::Whole => {}
    }
}
