//! A picture as lines, areas and words with places: painted on the screen, written as SVG, or drawn into a PNG; the same in
//! all three.

use crate::window::theme;
use egui::{Align2, Color32, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2};

/// One thing in a drawing.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
    /// A line through points.
    Line {
        /// Its points.
        points: Vec<Pos2>,
        /// Width and colour.
        stroke: Stroke,
        /// Broken into dashes.
        dashed: bool,
    },
    /// A closed convex area.
    Area {
        /// Its corners.
        points: Vec<Pos2>,
        /// Inside.
        fill: Color32,
        /// Outline.
        stroke: Stroke,
    },
    /// A disc.
    Disc {
        /// Its centre.
        centre: Pos2,
        /// Its radius.
        radius: f32,
        /// Inside.
        fill: Color32,
        /// Outline.
        stroke: Stroke,
    },
    /// Words.
    Words {
        /// The point that `align` refers to.
        at: Pos2,
        /// Where the words lie about it.
        align: Align2,
        /// The words.
        text: String,
        /// Size of type.
        size: f32,
        /// Colour.
        colour: Color32,
        /// Read from bottom to top.
        upright: bool,
    },
    /// What is inside a rectangle of what follows, up to [`Mark::Whole`]; named for the reader of an SVG.
    Inside(Rect, String),
    /// Ends [`Mark::Inside`].
    Whole,
}

/// Marks on a ground.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// Width and height, points.
    pub size: Vec2,
    /// Ground.
    pub ground: Color32,
    /// What it shows, in words.
    pub title: String,
    /// From back to front.
    pub marks: Vec<Mark>,
}

impl Drawing {
    /// An empty one.
    pub fn new(size: Vec2, ground: Color32, title: &str) -> Self {
        Self { size, ground, title: title.to_owned(), marks: Vec::new() }
    }

    /// Adds a line.
    pub fn line(&mut self, points: impl Into<Vec<Pos2>>, stroke: Stroke) {
        self.marks.push(Mark::Line { points: points.into(), stroke, dashed: false });
    }

    /// Adds a closed convex area.
    pub fn area(&mut self, points: impl Into<Vec<Pos2>>, fill: Color32, stroke: Stroke) {
        self.marks.push(Mark::Area { points: points.into(), fill, stroke });
    }

    /// Adds a rectangle.
    pub fn rect(&mut self, rect: Rect, fill: Color32, stroke: Stroke) {
        self.area([rect.left_top(), rect.right_top(), rect.right_bottom(), rect.left_bottom()], fill, stroke);
    }

    /// Adds words that read from left to right.
    pub fn words(&mut self, at: Pos2, align: Align2, text: impl Into<String>, size: f32, colour: Color32) {
        self.marks.push(Mark::Words { at, align, text: text.into(), size, colour, upright: false });
    }

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
        Mark::Line { points, stroke, dashed: false } => drop(painter.add(Shape::line(moved(points), *stroke))),
        Mark::Line { points, stroke, .. } => painter.extend(Shape::dashed_line(&moved(points), *stroke, 6.0, 4.0)),
        Mark::Area { points, fill, stroke } => drop(painter.add(Shape::convex_polygon(moved(points), *fill, *stroke))),
        Mark::Disc { centre, radius, fill, stroke } => drop(painter.circle(*centre + by, *radius, *fill, *stroke)),
        Mark::Words { at, align, text, size, colour, upright: false } => {
            painter.text(*at + by, *align, text, theme::font(*size), *colour);
        }
        Mark::Words { at, text, size, colour, .. } => {
            let galley = painter.layout_no_wrap(text.clone(), theme::font(*size), *colour);
            let (w, h) = (galley.size().x, galley.size().y);
            let start = *at + by + Vec2::new(-0.5 * h, 0.5 * w);
            let shape = egui::epaint::TextShape::new(start, galley, *colour).with_angle(-std::f32::consts::FRAC_PI_2);
            painter.add(shape);
        }
        Mark::Inside(..) | Mark::Whole => {}
    }
}

/// Corners of a rectangle whose sides are parallel to the screen.
pub fn corners(rect: Rect) -> [Pos2; 4] {
    [rect.left_top(), rect.right_top(), rect.right_bottom(), rect.left_bottom()].map(|p| pos2(p.x, p.y))
}
