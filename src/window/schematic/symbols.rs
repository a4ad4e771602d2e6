//! Engineering symbols of the laws: the marks that each law lists, drawn between two points, the body of fixed size in the
//! middle.

use crate::effects::Effect;
use crate::effects::symbol::{HALF_WIDTH, Mark, Tone};
use egui::{Color32, Painter, Pos2, Shape, Stroke, Vec2};

/// Length of a symbol's body, points.
pub(crate) const BODY: f32 = 28.0;

/// A pen in the frame of one symbol: `x` along it from -1/2 to 1/2 of its body, `y` across in points.
struct Pen<'a> {
    painter: &'a Painter,
    middle: Pos2,
    along: Vec2,
    across: Vec2,
    stroke: Stroke,
}

/// Draws the symbol of `effect` from `from` to `to`.
pub(crate) fn draw(painter: &Painter, effect: Effect, [from, to]: [Pos2; 2], stroke: Stroke) {
    let length = (to - from).length();
    if length < 4.0 {
        return;
    }
    let direction = (to - from) / length;
    let body = BODY.min(0.8 * length);
    let pen = Pen {
        painter,
        middle: from + (to - from) / 2.0,
        along: direction * body,
        across: direction.rot90() * (body / BODY),
        stroke,
    };
    painter.line_segment([from, pen.at(-0.5, 0.0)], stroke);
    painter.line_segment([pen.at(0.5, 0.0), to], stroke);
    effect.description().symbol.iter().for_each(|mark| pen.mark(mark));
}

impl Pen<'_> {
    fn at(&self, x: f32, y: f32) -> Pos2 {
        self.middle + self.along * x + self.across * y
    }

    fn line(&self, points: &[(f32, f32)]) {
        let points = points.iter().map(|&(x, y)| self.at(x, y)).collect();
        self.painter.add(Shape::line(points, self.stroke));
    }

    fn fill(&self, points: &[(f32, f32)], colour: Color32) {
        let points = points.iter().map(|&(x, y)| self.at(x, y)).collect();
        self.painter.add(Shape::convex_polygon(points, colour, self.stroke));
    }

    fn mark(&self, mark: &Mark) {
        match *mark {
            Mark::Line(points) => self.line(points),
            Mark::Area(points, tone) => self.fill(points, self.shade(tone)),
            Mark::Dashpot(from, to) => self.dashpot(from, to),
            Mark::Pads(from, to, tone) => self.pads(from, to, self.shade(tone)),
            Mark::Spring { ends: (from, to), coils, y, height } => self.zigzag(from, to, usize::from(coils), y, height),
            Mark::Ring(width, height) => self.ring(width, height),
            Mark::Letter(text) => self.letter(text),
            Mark::Arrow => self.arrow(),
        }
    }

    fn shade(&self, tone: Tone) -> Color32 {
        match tone {
            Tone::Full => self.stroke.color,
            Tone::Faint => self.stroke.color.gamma_multiply(0.28),
        }
    }

    fn ring(&self, width: f32, height: f32) {
        let point = |k: i32| {
            let (sin, cos) = (std::f32::consts::TAU * k as f32 / 24.0).sin_cos();
            (width * cos, height * sin)
        };
        self.line(&(0..=24).map(point).collect::<Vec<_>>());
    }

    fn letter(&self, text: &str) {
        let font = crate::window::appearance::theme::font(crate::window::appearance::theme::size::SMALL - 1.5);
        let at = self.middle - Vec2::new(0.0, 12.0);
        self.painter.text(at, egui::Align2::CENTER_CENTER, text, font, self.stroke.color);
    }

    /// Cup and piston between `a` and `b`.
    fn dashpot(&self, a: f32, b: f32) {
        let along = |t: f32| a + (b - a) * t;
        self.line(&[(along(0.0), 0.0), (along(0.55), 0.0)]);
        self.line(&[(along(0.55), 1.0 - HALF_WIDTH), (along(0.55), HALF_WIDTH - 1.0)]);
        self.line(&[
            (along(0.28), -HALF_WIDTH),
            (along(0.8), -HALF_WIDTH),
            (along(0.8), HALF_WIDTH),
            (along(0.28), HALF_WIDTH),
        ]);
        self.line(&[(along(0.8), 0.0), (along(1.0), 0.0)]);
    }

    /// A rod that slides between two pressed pads.
    fn pads(&self, a: f32, b: f32, fill: Color32) {
        let along = |t: f32| a + (b - a) * t;
        self.line(&[(a, 0.0), (along(0.72), 0.0)]);
        for side in [-1.0, 1.0] {
            let (near, far) = (2.5 * side, 7.5 * side);
            self.fill(&[(along(0.25), near), (along(0.75), near), (along(0.75), far), (along(0.25), far)], fill);
            self.line(&[(along(0.5), far), (along(0.5), 9.5 * side), (along(0.9), 9.5 * side), (along(0.9), 0.0)]);
        }
        self.line(&[(along(0.9), 0.0), (b, 0.0)]);
    }

    fn zigzag(&self, a: f32, b: f32, coils: usize, y: f32, height: f32) {
        let n = 2 * coils;
        let mut points = vec![(a, y)];
        for k in 0..n {
            let side = if k % 2 == 0 { -height } else { height };
            points.push((a + (b - a) * (k as f32 + 0.5) / n as f32, y + side));
        }
        points.push((b, y));
        self.line(&points);
    }

    /// A slanted arrow across the body: the sign for a variable element.
    fn arrow(&self) {
        self.line(&[(-0.4, 10.0), (0.4, -10.0)]);
        self.line(&[(0.22, -9.5), (0.4, -10.0), (0.38, -4.5)]);
    }
}

/// The ground: a line with hatches.
pub(crate) fn ground(painter: &Painter, pos: Pos2, into: Vec2, width: f32, stroke: Stroke) {
    let across = into.rot90();
    let half = width / 2.0;
    painter.line_segment([pos - across * half, pos + across * half], stroke);
    let thin = Stroke::new(stroke.width * 0.7, stroke.color);
    let count = (width / 5.0).floor().max(2.0);
    for k in 0..count as usize {
        let start = pos + across * (-half + width * (k as f32 + 0.75) / count);
        painter.line_segment([start, start + into * 5.0 - across * 4.0], thin);
    }
}

/// An arrow with a filled head.
pub(crate) fn arrow(painter: &Painter, [tail, tip]: [Pos2; 2], stroke: Stroke) {
    let direction = (tip - tail).normalized();
    let base = tip - direction * 9.0;
    painter.line_segment([tail, base], stroke);
    let side = direction.rot90() * 4.5;
    painter.add(Shape::convex_polygon(vec![tip, base + side, base - side], stroke.color, Stroke::NONE));
}
