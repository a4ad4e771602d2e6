//! The samples as cards: what each is for, with a picture.

use crate::effects::Effect;
use crate::window::appearance::theme::{self, Palette, size};
use crate::window::appearance::widgets::UiExt;
use crate::window::language::tr;
use crate::window::schematic::symbols;
use egui::{Align2, Painter, Rect, Role, Sense, Shape, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, pos2, vec2};
use std::path::Path;

/// A sample project.
pub(crate) struct Sample {
    /// Its folder among the samples.
    pub folder: &'static str,
    title: &'static str,
    sentence: &'static str,
    picture: fn(&Painter, &Palette, Rect),
}

/// Samples to find dampers in.
pub(crate) const DAMPERS: [Sample; 9] = [
    Sample {
        folder: "cantilever-case-2",
        title: "Cantilever, unequal dashpots",
        sentence: "Four dampers that differ a hundredfold, three accelerometers, 5 % noise. The tour is here.",
        picture: |p, c, r| beam(p, c, r, &[2, 3, 7, 9], &[], None),
    },
    Sample {
        folder: "cantilever-case-1",
        title: "Cantilever, equal dashpots",
        sentence: "Four equal dampers on an aluminium strip: find them among twenty candidates.",
        picture: |p, c, r| beam(p, c, r, &[2, 3, 7, 9], &[], None),
    },
    Sample {
        folder: "cantilever-case-1a",
        title: "Cantilever, one place known",
        sentence: "The place of one damper is known: it is forced and its value identified.",
        picture: |p, c, r| beam(p, c, r, &[2, 3, 7, 9], &[2], None),
    },
    Sample {
        folder: "cantilever-case-2-rounded",
        title: "Cantilever, beside resonances",
        sentence: "Driven at rounded frequencies, where one mode does not describe the shape.",
        picture: |p, c, r| beam(p, c, r, &[2, 3, 7, 9], &[], None),
    },
    Sample {
        folder: "five-masses",
        title: "Five masses",
        sentence: "Known dashpots to the ground, two unknown ones between masses; the classical methods beside.",
        picture: |p, c, r| chain(p, c, r, None),
    },
    Sample {
        folder: "five-masses-points",
        title: "Five points, no model",
        sentence: "Energy balance alone: no mass and no stiffness is known.",
        picture: points,
    },
    Sample {
        folder: "goland-wing",
        title: "Goland wing",
        sentence: "A wing box with fourteen dashpots, imported as matrices and drawn in space.",
        picture: wing,
    },
    Sample {
        folder: "hammer-frf",
        title: "Cantilever under a hammer",
        sentence: "Frequency responses out of a Universal File: the lines that say most become runs.",
        picture: |p, c, r| {
            beam(p, c, r, &[3, 7], &[], None);
            hammer(p, c, r);
        },
    },
    Sample {
        folder: "shaker-table",
        title: "Cantilever on a shaker table",
        sentence: "Driven at its foot: no force is measured, the motion of the table is.",
        picture: |p, c, r| {
            beam(p, c, r, &[5, 8], &[], None);
            table(p, c, r);
        },
    },
];

/// Samples of which the model lacks something.
pub(crate) const HIDDEN: [Sample; 5] = [
    Sample {
        folder: "cantilever-friction",
        title: "Something rubs",
        sentence: "A cantilever at four levels; viscous dashpots do not explain it.",
        picture: |p, c, r| beam(p, c, r, &[3, 9], &[], Some(7)),
    },
    Sample {
        folder: "five-masses-friction",
        title: "Two things are wrong",
        sentence: "Five masses: something rubs, and a mass is not what the drawing says.",
        picture: |p, c, r| chain(p, c, r, Some(2)),
    },
    Sample {
        folder: "five-masses-cubic",
        title: "Peaks lean over",
        sentence: "Five masses whose frequencies rise with the level.",
        picture: |p, c, r| chain(p, c, r, Some(4)),
    },
    Sample {
        folder: "cantilever-late-sensor",
        title: "A phase that is off",
        sentence: "Is it damping, or does a sensor deceive?",
        picture: |p, c, r| beam(p, c, r, &[3, 9], &[], Some(5)),
    },
    Sample {
        folder: "joint-laboratory",
        title: "A bolted joint, measured",
        sentence: "Model 2 % off, gains and drift as laboratories have them: what does the bolt do?",
        picture: |p, c, r| {
            beam(p, c, r, &[], &[], Some(7));
            bracket(p, c, r);
        },
    },
];

/// Samples whose records are not steady.
pub(crate) const RECORDS: [Sample; 4] = [
    Sample {
        folder: "decay-friction",
        title: "Released, and it stops dead",
        sentence: "A cantilever rings down from 3 mm: what takes the last of its motion?",
        picture: |p, c, r| {
            beam(p, c, r, &[], &[], Some(7));
            released(p, c, r);
        },
    },
    Sample {
        folder: "hammer-maxwell",
        title: "Five masses under a hammer",
        sentence: "Two blows, one of them double: between two masses energy is lost.",
        picture: |p, c, r| {
            chain(p, c, r, Some(2));
            hammer(p, c, r);
        },
    },
    Sample {
        folder: "sweep-cubic",
        title: "A sweep that jumps",
        sentence: "Swept upwards and downwards: the amplitude jumps at two different frequencies.",
        picture: |p, c, r| chain(p, c, r, Some(4)),
    },
    Sample {
        folder: "damper-loops",
        title: "A damper in a testing machine",
        sentence: "Loops of force over displacement at three amplitudes: which law is in it?",
        picture: loops,
    },
];

/// Height of a card, points; of one so narrow that its sentence takes a line more.
const HEIGHT: f32 = 176.0;
const NARROW: f32 = 250.0;
const MORE: f32 = 18.0;

/// Shows a card; true when it was clicked.
pub(crate) fn card(ui: &mut Ui, width: f32, sample: &Sample, file: Option<&Path>) -> bool {
    let palette = ui.palette();
    let present = file.is_some_and(Path::exists);
    let sense = if present { Sense::click() } else { Sense::hover() };
    let (rect, response) = ui.allocate_exact_size(vec2(width, HEIGHT + if width < NARROW { MORE } else { 0.0 }), sense);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, present, tr(sample.title)));
    let lit = response.hovered() && present || response.has_focus();
    let line = theme::hair(if lit { palette.accent } else { palette.line });
    ui.painter().rect(rect, 8.0, palette.pane, line, StrokeKind::Inside);
    let picture = Rect::from_min_max(rect.left_top() + vec2(12.0, 12.0), pos2(rect.right() - 12.0, rect.top() + 94.0));
    ui.painter().rect_filled(picture, 5.0, palette.canvas);
    (sample.picture)(&ui.painter_at(picture), palette, picture);
    let text =
        |size: f32, string: &str, colour| ui.painter().layout(tr(string), theme::font(size), colour, width - 28.0);
    let title = text(size::HEADING, sample.title, palette.ink);
    let sentence = text(size::BODY - 0.5, sample.sentence, palette.weak);
    let at = pos2(rect.left() + 14.0, picture.bottom() + 10.0);
    let below = at + vec2(0.0, title.size().y + 4.0);
    ui.painter().galley(at, title, palette.ink);
    ui.painter().galley(below, sentence, palette.weak);
    response.clicked()
}

/// Dashpots stand at nodes of ten; those whose place is known are drawn in ink.
fn beam(painter: &Painter, palette: &Palette, r: Rect, dashpots: &[usize], known: &[usize], lacks: Option<usize>) {
    let axis = r.top() + 40.0;
    let (left, right) = (r.left() + 34.0, r.right() - 24.0);
    let abscissa = |k: usize| left + (right - left) * k as f32 / 10.0;
    let lift = |k: f32| 15.0 * (k / 10.0).powi(2);
    let curve = (0..=40).map(|k| pos2(left + (right - left) * k as f32 / 40.0, axis - lift(k as f32 / 4.0))).collect();
    symbols::ground(painter, pos2(left, axis), Vec2::LEFT, 36.0, theme::bold(palette.ink));
    painter.add(Shape::line(curve, Stroke::new(4.0, palette.ink)));
    for &k in dashpots {
        let (top, foot) = (pos2(abscissa(k), axis - lift(k as f32)), pos2(abscissa(k), r.bottom() - 12.0));
        let colour = if known.contains(&k) { palette.accent } else { palette.model };
        symbols::draw(painter, Effect::DASHPOT, [top, foot], theme::pen(colour));
        symbols::ground(painter, foot, Vec2::DOWN, 20.0, theme::hair(colour));
    }
    if let Some(k) = lacks {
        question(painter, palette, pos2(abscissa(k), axis + 22.0));
    }
    for k in [4, 6, 10] {
        let body = Rect::from_center_size(pos2(abscissa(k), axis - lift(k as f32) - 6.0), vec2(10.0, 7.0));
        painter.rect_filled(body, 1.5, palette.measured);
    }
}

fn chain(painter: &Painter, palette: &Palette, r: Rect, lacks: Option<usize>) {
    let step = (r.width() - 30.0) / 5.2;
    let x = |k: f32| r.left() + 16.0 + step * k;
    let y = r.center().y;
    symbols::ground(painter, pos2(x(0.0), y), Vec2::LEFT, 40.0, theme::bold(palette.ink));
    for k in 0..5 {
        let k = k as f32;
        let (from, to) = (if k == 0.0 { x(0.0) } else { x(k) + 11.0 }, x(k + 1.0) - 13.0);
        symbols::draw(painter, Effect::SPRING, [pos2(from, y - 9.0), pos2(to, y - 9.0)], theme::pen(palette.ink));
        if lacks.is_none() && (k == 2.0 || k == 4.0) {
            symbols::draw(
                painter,
                Effect::DASHPOT,
                [pos2(from, y + 10.0), pos2(to, y + 10.0)],
                theme::pen(palette.model),
            );
        }
        let mass = Rect::from_center_size(pos2(x(k + 1.0) - 1.0, y), vec2(24.0, 40.0));
        painter.rect(mass, 3.0, palette.raised, theme::bold(palette.ink), StrokeKind::Middle);
    }
    if let Some(k) = lacks {
        question(painter, palette, pos2(x(k as f32 + 0.5), y + 14.0));
    }
}

/// A hammer above the tip.
fn hammer(painter: &Painter, palette: &Palette, r: Rect) {
    let head = pos2(r.right() - 44.0, r.top() + 11.0);
    painter.line_segment([head, head + vec2(-46.0, 8.0)], theme::bold(palette.weak));
    painter.rect_filled(Rect::from_center_size(head, vec2(10.0, 18.0)), 2.0, palette.accent);
}

/// The tip where it is let go from, and the way that it takes.
fn released(painter: &Painter, palette: &Palette, r: Rect) {
    let tip = pos2(r.right() - 24.0, r.top() + 25.0);
    painter.arrow(tip, vec2(0.0, 26.0), theme::bold(palette.accent));
}

/// Loops of three amplitudes, between the heads of a testing machine.
fn loops(painter: &Painter, palette: &Palette, r: Rect) {
    let (middle, column) = (pos2(r.center().x + 40.0, r.center().y), r.center().x - 90.0);
    for share in [0.4_f32, 0.7, 1.0] {
        let (half, rise, slip) = (52.0 * share, 24.0 * share, 9.0);
        let corner = |x: f32, y: f32| middle + vec2(x, -y);
        let path = vec![
            corner(-half, -rise - slip),
            corner(-half + 14.0, -rise + slip + 4.0),
            corner(half, rise + slip),
            corner(half - 14.0, rise - slip - 4.0),
        ];
        painter.add(Shape::closed_line(path, theme::pen(palette.measured)));
    }
    let ends = [pos2(column, r.top() + 14.0), pos2(column, r.bottom() - 14.0)];
    symbols::draw(painter, Effect::DASHPOT, ends, theme::pen(palette.model));
    symbols::ground(painter, ends[0], Vec2::UP, 34.0, theme::bold(palette.ink));
    symbols::ground(painter, ends[1], Vec2::DOWN, 34.0, theme::bold(palette.ink));
    question(painter, palette, pos2(column + 26.0, r.center().y));
}

/// A bracket under the beam with the head of its bolt.
fn bracket(painter: &Painter, palette: &Palette, r: Rect) {
    let x = r.left() + 34.0 + (r.width() - 58.0) * 0.62;
    let (top, foot) = (r.top() + 42.0, r.bottom() - 12.0);
    let body = Rect::from_min_max(pos2(x - 12.0, top), pos2(x - 4.0, foot));
    painter.rect(body, 1.0, palette.raised, theme::pen(palette.ink), StrokeKind::Middle);
    symbols::ground(painter, pos2(x - 8.0, foot), Vec2::DOWN, 26.0, theme::hair(palette.ink));
    painter.rect_filled(Rect::from_center_size(pos2(x - 8.0, top - 13.0), vec2(12.0, 5.0)), 1.5, palette.accent);
}

/// The arrows of a table that moves up and down under the clamped end.
fn table(painter: &Painter, palette: &Palette, r: Rect) {
    let (x, foot) = (r.left() + 18.0, r.top() + 40.0);
    painter.arrow(pos2(x, foot), vec2(0.0, -22.0), theme::bold(palette.accent));
    painter.arrow(pos2(x, foot), vec2(0.0, 22.0), theme::bold(palette.accent));
}

/// What is not known.
fn question(painter: &Painter, palette: &Palette, at: egui::Pos2) {
    painter.text(at, Align2::CENTER_CENTER, "?", theme::font(28.0), palette.missing);
}

/// Ribs and spars of a wing seen from above and behind.
fn wing(painter: &Painter, palette: &Palette, r: Rect) {
    let (root, span) = (pos2(r.left() + 36.0, r.center().y + 11.0), r.width() - 84.0);
    let on_wing = |rib: f32, chord: f32| pos2(root.x + span * rib + 26.0 * chord, root.y + 17.0 * chord - 24.0 * rib);
    let ends = |a, b, line| {
        painter.line_segment([a, b], line);
    };
    for chord in [-1.0, 0.0, 1.0] {
        ends(on_wing(0.0, chord), on_wing(1.0, chord), theme::bold(palette.ink));
    }
    for rib in 0..=7_u8 {
        let share = f32::from(rib) / 7.0;
        ends(on_wing(share, -1.0), on_wing(share, 1.0), theme::pen(palette.ink));
        let place = on_wing(share, if rib % 2 == 0 { 1.0 } else { -1.0 });
        painter.circle_filled(place, 3.5, palette.model);
    }
}

fn points(painter: &Painter, palette: &Palette, r: Rect) {
    let step = (r.width() - 60.0) / 4.0;
    let mass = |k: usize| pos2(r.left() + 30.0 + step * k as f32, r.center().y);
    for k in [1, 3] {
        symbols::draw(painter, Effect::DASHPOT, [mass(k), mass(k + 1)], theme::pen(palette.model));
    }
    for k in 0..5 {
        painter.circle(mass(k), 10.0, palette.raised, theme::bold(palette.measured));
    }
}
