//! A drawing in a PDF. Colours that let the ground through are mixed with it: pages need no transparency.

use super::face::{FACE, Face};
use crate::plots::drawing::{Drawing, Mark, Stroke};
use ecolor::Color32;
use emath::{Align, Align2, Pos2};
use pdf_writer::types::LineJoinStyle;
use pdf_writer::{Content, Str};

/// Share of the radius that the handles of four cubic curves stand off a circle.
const HANDLE: f32 = 0.552_284_8;

/// Draws with the upper left corner at `corner` (from the lower left of the page, y upwards), `scale` times as large.
pub(super) fn draw(content: &mut Content, face: &Face, drawing: &Drawing, corner: [f32; 2], scale: f32) {
    content.save_state();
    // From here on y points down, as in the drawing.
    content.transform([scale, 0.0, 0.0, -scale, corner[0], corner[1]]);
    content.set_line_join(LineJoinStyle::RoundJoin);
    let (w, h) = (drawing.size.x, drawing.size.y);
    fill(content, drawing.ground, drawing.ground);
    content.rect(0.0, 0.0, w, h).fill_nonzero();
    drawing.marks.iter().for_each(|m| mark(content, face, m, drawing.ground));
    content.restore_state();
}

fn mark(content: &mut Content, face: &Face, mark: &Mark, ground: Color32) {
    match mark {
        Mark::Line { points, stroke, dashed } => {
            if points.len() < 2 || !pen(content, *stroke, ground) {
                return;
            }
            content.set_dash_pattern(if *dashed { vec![6.0, 4.0] } else { Vec::new() }, 0.0);
            path(content, points);
            content.stroke();
            content.set_dash_pattern([], 0.0);
        }
        Mark::Area { points, fill: inside, stroke } => {
            if points.len() < 3 {
                return;
            }
            path(content, points);
            content.close_path();
            finish(content, *inside, *stroke, ground);
        }
        Mark::Disc { centre, radius, fill: inside, stroke } => {
            circle(content, *centre, *radius);
            finish(content, *inside, *stroke, ground);
        }
        Mark::Words { at, align, text, size, colour, upright } => {
            fill(content, *colour, ground);
            words(content, face, *at, *align, text, *size, *upright);
        }
        Mark::Inside(rect, _) => {
            content.save_state();
            content.rect(rect.left(), rect.top(), rect.width(), rect.height()).clip_nonzero().end_path();
        }
        Mark::Whole => {
            content.restore_state();
        }
    }
}

fn path(content: &mut Content, points: &[Pos2]) {
    content.move_to(points[0].x, points[0].y);
    for p in &points[1..] {
        content.line_to(p.x, p.y);
    }
}

fn circle(content: &mut Content, c: Pos2, r: f32) {
    let k = HANDLE * r;
    content.move_to(c.x + r, c.y);
    content.cubic_to(c.x + r, c.y + k, c.x + k, c.y + r, c.x, c.y + r);
    content.cubic_to(c.x - k, c.y + r, c.x - r, c.y + k, c.x - r, c.y);
    content.cubic_to(c.x - r, c.y - k, c.x - k, c.y - r, c.x, c.y - r);
    content.cubic_to(c.x + k, c.y - r, c.x + r, c.y - k, c.x + r, c.y);
    content.close_path();
}

/// Fills and outlines the path.
fn finish(content: &mut Content, inside: Color32, stroke: Stroke, ground: Color32) {
    let filled = inside.a() > 0;
    if filled {
        fill(content, inside, ground);
    }
    match (filled, pen(content, stroke, ground)) {
        (true, true) => content.fill_nonzero_and_stroke(),
        (true, false) => content.fill_nonzero(),
        (false, true) => content.stroke(),
        (false, false) => content.end_path(),
    };
}

/// Words about a point, as in the SVG: the baseline by hand, upright ones turned about the point.
fn words(content: &mut Content, face: &Face, at: Pos2, align: Align2, text: &str, size: f32, upright: bool) {
    let back = face.width(text, size)
        * match align.x() {
            Align::Min => 0.0,
            Align::Center => 0.5,
            Align::Max => 1.0,
        };
    let down = match align.y() {
        Align::Min => 0.8,
        Align::Center => 0.34,
        Align::Max => -0.2,
    } * size;
    let matrix = if upright {
        [0.0, -1.0, -1.0, 0.0, at.x + down, at.y + back]
    } else {
        [1.0, 0.0, 0.0, -1.0, at.x - back, at.y + down]
    };
    show(content, face, text, size, matrix);
}

/// One line of text with its place and direction.
pub(super) fn show(content: &mut Content, face: &Face, text: &str, size: f32, matrix: [f32; 6]) {
    let glyphs = face.encode(text);
    content.begin_text().set_font(FACE, size).set_text_matrix(matrix).show(Str(&glyphs)).end_text();
}

/// Sets a line; whether there is anything to draw with it.
fn pen(content: &mut Content, stroke: Stroke, ground: Color32) -> bool {
    let there = stroke.width > 0.0 && stroke.color.a() > 0;
    if there {
        let [r, g, b] = mixed(stroke.color, ground);
        content.set_stroke_rgb(r, g, b).set_line_width(stroke.width);
    }
    there
}

/// Sets the colour of areas and words.
pub(super) fn fill(content: &mut Content, colour: Color32, ground: Color32) {
    let [r, g, b] = mixed(colour, ground);
    content.set_fill_rgb(r, g, b);
}

fn mixed(colour: Color32, ground: Color32) -> [f32; 3] {
    let [r, g, b, a] = colour.to_srgba_unmultiplied().map(|v| f32::from(v) / 255.0);
    let [s, t, u, _] = ground.to_srgba_unmultiplied().map(|v| f32::from(v) / 255.0);
    [(r, s), (g, t), (b, u)].map(|(over, under)| a * over + (1.0 - a) * under)
}
