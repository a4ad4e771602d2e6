//! A picture as lines, areas and words with places: painted on the screen, written as SVG, or drawn into a PNG; the same in
//! all three.

use ecolor::Color32;
use emath::{Align2, Pos2, Rect, Vec2};

/// A line's width and colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Width, points.
    pub width: f32,
    /// Colour.
    pub color: Color32,
}

impl Stroke {
    /// Draws nothing.
    pub const NONE: Self = Self { width: 0.0, color: Color32::TRANSPARENT };

    /// A line of a width and colour.
    pub const fn new(width: f32, color: Color32) -> Self {
        Self { width, color }
    }
}

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
    pub fn line(&mut self, points: impl Into<Vec<Pos2>>, stroke: impl Into<Stroke>) {
        self.marks.push(Mark::Line { points: points.into(), stroke: stroke.into(), dashed: false });
    }

    /// Adds a closed convex area.
    pub fn area(&mut self, points: impl Into<Vec<Pos2>>, fill: Color32, stroke: impl Into<Stroke>) {
        self.marks.push(Mark::Area { points: points.into(), fill, stroke: stroke.into() });
    }

    /// Adds a rectangle.
    pub fn rect(&mut self, rect: Rect, fill: Color32, stroke: impl Into<Stroke>) {
        self.area([rect.left_top(), rect.right_top(), rect.right_bottom(), rect.left_bottom()], fill, stroke);
    }

    /// Adds words that read from left to right.
    pub fn words(&mut self, at: Pos2, align: Align2, text: impl Into<String>, size: f32, colour: Color32) {
        self.marks.push(Mark::Words { at, align, text: text.into(), size, colour, upright: false });
    }
}
