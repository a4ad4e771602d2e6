//! Paints a layout; decides nothing.

use super::hit::Target;
use super::layout::{Handle, Layout, Part};
use super::model::{Scene, Support};
use super::symbols;
use crate::effects::{Effect, State};
use crate::window::appearance::theme::{self, Palette};
use egui::{Align2, Color32, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, Vec2, pos2, vec2};

/// What is to stand out.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Marks<'a> {
    /// Under the pointer.
    pub hovered: Option<Target>,
    /// Selected.
    pub selected: Option<Target>,
    /// Share of every DOF, 0 to 1, drawn as a halo.
    pub shares: Option<&'a [f32]>,
    /// Whether the shares are those of the model's error.
    pub errors: bool,
    /// Rubber line of a drag, with the law that would be drawn.
    pub rubber: Option<(Effect, [Pos2; 2])>,
    /// Rectangle of a sweep.
    pub span: Option<Rect>,
    /// Whether states of sources are told apart (pattern) or only what was identified stands out.
    pub editing: bool,
    /// Whether the structure is drawn in space beneath; lines and halos are then left out here.
    pub in_space: bool,
}

/// Paints everything.
pub(crate) fn paint(painter: &Painter, palette: &Palette, scene: &Scene, layout: &Layout, marks: &Marks<'_>) {
    if marks.in_space {
        at_rest(painter, palette, layout);
    } else {
        halos(painter, palette, scene, layout, marks);
        structure(painter, palette, scene, layout);
    }
    for source in &layout.sources {
        let s = &scene.sources[source.slot];
        let target = Some(Target::Source(source.slot));
        let stroke = if s.suggested {
            Stroke::new(2.4, palette.missing)
        } else {
            source_stroke(palette, s.state, s.identified.is_some(), marks.editing)
        };
        if target == marks.selected || target == marks.hovered {
            glow(painter, palette, &source.parts, target == marks.selected);
        }
        for part in &source.parts {
            paint_part(painter, palette, s.effect, part, stroke, s.state == State::Candidate && s.identified.is_none());
        }
    }
    for handle in &layout.handles {
        paint_handle(painter, palette, scene, handle, marks);
        name(painter, palette, scene, layout, handle, marks);
    }
    instruments(painter, palette, layout);
    drag(painter, palette, marks);
}

/// Share below which nothing is drawn.
const FAINT: f32 = 0.001;
/// How far a share of one reaches beyond a node, and beyond a mass, whose neighbours are near, points.
const DISC: f32 = 14.0;
const RIM: f32 = 8.0;
/// Distance of the sign of a moving base from its support, and half its height, points.
const BESIDE_WALL: f32 = 26.0;
const HALF_ARROW: f32 = 24.0;

/// Ground of a DOF whose share is not nothing: about a node a disc, about a mass a rim, which its springs pass through.
fn halos(painter: &Painter, palette: &Palette, scene: &Scene, layout: &Layout, marks: &Marks<'_>) {
    let Some(shares) = marks.shares else { return };
    let strong = if marks.errors { palette.missing } else { palette.model };
    for handle in &layout.handles {
        let share = shares.get(handle.dof).copied().unwrap_or(0.0);
        if share <= FAINT {
            continue;
        }
        let colour = strong.gamma_multiply(0.16 + 0.3 * share);
        let about = if scene_mass(scene, handle).is_some() { RIM } else { DISC };
        let radius = handle.radius + 4.0 + about * share.sqrt();
        if scene_mass(scene, handle) == Some(false) {
            painter.rect_filled(Rect::from_center_size(handle.pos, Vec2::splat(2.0 * radius)), 7.0, colour);
        } else {
            painter.circle_filled(handle.pos, radius, colour);
        }
    }
}

fn at_rest(painter: &Painter, palette: &Palette, layout: &Layout) {
    for line in &layout.rest {
        painter.extend(Shape::dashed_line(line, theme::hair(palette.weak.gamma_multiply(0.7)), 5.0, 4.0));
    }
}

fn structure(painter: &Painter, palette: &Palette, scene: &Scene, layout: &Layout) {
    at_rest(painter, palette, layout);
    let width = if scene.dofs.len() > 60 { theme::pen(palette.ink) } else { Stroke::new(4.0, palette.ink) };
    for line in &layout.body {
        painter.add(Shape::line(line.clone(), width));
    }
    for spring in &layout.springs {
        paint_part(painter, palette, Effect::SPRING, spring, theme::pen(palette.ink), false);
    }
    for support in &layout.supports {
        if scene.on_moving_base {
            moving(painter, palette, support.pos + support.into * BESIDE_WALL);
        }
        match support.support {
            Support::Clamped => {
                let wall = Stroke::new(2.4, palette.ink);
                symbols::ground(painter, support.pos, support.into, 54.0, wall);
            }
            Support::Pinned => {
                let foot = support.pos + support.into * 18.0;
                let side = support.into.rot90() * 10.0;
                painter.add(Shape::closed_line(vec![support.pos, foot + side, foot - side], theme::pen(palette.ink)));
                symbols::ground(painter, foot, support.into, 30.0, theme::pen(palette.ink));
            }
        }
    }
}

/// The sign of a base that moves up and down.
fn moving(painter: &Painter, palette: &Palette, middle: Pos2) {
    for tip in [-HALF_ARROW, HALF_ARROW] {
        symbols::arrow(painter, [middle, middle + vec2(0.0, tip)], Stroke::new(2.2, palette.accent));
    }
}

/// The line of a source by its state.
pub(crate) fn source_stroke(palette: &Palette, state: State, identified: bool, editing: bool) -> Stroke {
    if identified {
        return Stroke::new(2.2, palette.model);
    }
    match state {
        State::Candidate if editing => Stroke::new(1.4, palette.weak),
        State::Candidate => Stroke::new(1.2, palette.weak.gamma_multiply(0.45)),
        State::Forced => Stroke::new(2.0, palette.accent),
        State::Known => Stroke::new(2.0, palette.ink),
        State::Off => Stroke::new(1.2, palette.line),
        State::Reference => Stroke::new(1.4, palette.missing),
    }
}

fn glow(painter: &Painter, palette: &Palette, parts: &[Part], strong: bool) {
    let colour = palette.accent.gamma_multiply(if strong { 0.26 } else { 0.13 });
    for part in parts {
        let [a, b] = part.glyph;
        painter.line_segment([a, b], Stroke::new(20.0, colour));
    }
}

fn paint_part(painter: &Painter, palette: &Palette, effect: Effect, part: &Part, stroke: Stroke, dashed: bool) {
    let thin = Stroke::new(1.0_f32.min(stroke.width), stroke.color);
    for lead in &part.leads {
        if dashed {
            painter.extend(Shape::dashed_line(lead, thin, 3.0, 3.0));
        } else {
            painter.line_segment(*lead, thin);
        }
    }
    symbols::draw(painter, effect, part.glyph, stroke);
    if let Some(ground) = part.ground {
        let colour = palette.canvas.lerp_to_gamma(stroke.color, 0.9);
        symbols::ground(painter, ground.pos, ground.into, ground.width, Stroke::new(1.4, colour));
    }
}

fn paint_handle(painter: &Painter, palette: &Palette, scene: &Scene, handle: &Handle, marks: &Marks<'_>) {
    let target = Some(Target::Dof(handle.dof));
    let (hovered, selected) = (target == marks.hovered, target == marks.selected);
    let mass = scene_mass(scene, handle);
    if let Some(round) = mass {
        mass_body(painter, palette, handle, round, hovered || selected);
    } else if handle.rotation {
        rotation(painter, palette, handle, hovered || selected);
    } else {
        let measured = !scene.dofs[handle.dof].sensors.is_empty();
        let fill = if measured { palette.measured } else { palette.canvas };
        let radius = if hovered || selected { handle.radius + 1.5 } else { handle.radius };
        painter.circle(handle.pos, radius, fill, theme::pen(if measured { palette.measured } else { palette.ink }));
    }
    if selected {
        painter.circle_stroke(handle.pos, handle.radius + 6.0, Stroke::new(2.0, palette.accent));
    } else if hovered {
        painter.circle_stroke(handle.pos, handle.radius + 5.0, Stroke::new(1.5, palette.accent.gamma_multiply(0.7)));
    }
}

/// The label of a DOF: in a mass, else at the right of its node, or at the left where an arrow stands at the right.
fn name(painter: &Painter, palette: &Palette, scene: &Scene, layout: &Layout, handle: &Handle, marks: &Marks<'_>) {
    let target = Some(Target::Dof(handle.dof));
    let lit = target == marks.hovered || target == marks.selected;
    if !handle.labelled && !lit {
        return;
    }
    let (text, font) = (scene.dofs[handle.dof].label.clone(), theme::font(theme::size::SMALL));
    if scene_mass(scene, handle).is_some() {
        painter.text(handle.label, Align2::CENTER_CENTER, text, font, palette.ink);
        return;
    }
    // On a halo small grey words could not be read, and a pale ground behind them would tear it.
    let haloed = marks.shares.and_then(|s| s.get(handle.dof)).is_some_and(|share| *share > FAINT);
    let colour = if lit {
        palette.accent
    } else if haloed {
        palette.ink
    } else {
        palette.weak
    };
    let words = painter.layout_no_wrap(text, font, colour);
    let rect = Align2::LEFT_CENTER.anchor_size(handle.label, words.size());
    let hidden = |ends: &[Pos2; 2]| Rect::from_two_pos(ends[0], ends[1]).expand2(vec2(4.0, 2.0)).intersects(rect);
    let mirrored = 2.0 * handle.pos.x - rect.right();
    // Lines behind a label fade, so that it can be read.
    let ground = |rect: Rect| {
        if !haloed {
            painter.rect_filled(rect.shrink2(vec2(0.0, 2.0)), 2.0, palette.canvas.gamma_multiply(0.7));
        }
    };
    if !layout.exciters.iter().any(|(_, ends)| hidden(ends)) {
        ground(rect);
        painter.galley(rect.min, words, colour);
        return;
    }
    // At the left no name may stand on its neighbour's.
    let beside = Rect::from_min_size(pos2(mirrored, rect.top()), rect.size()).expand(8.0);
    if !layout.handles.iter().any(|h| h.dof != handle.dof && !h.rotation && beside.contains(h.pos)) {
        ground(beside.shrink(8.0));
        painter.galley(pos2(mirrored, rect.top()), words, colour);
    }
}

/// Whether the handle is a mass of a row, and if so whether it is round.
fn scene_mass(scene: &Scene, handle: &Handle) -> Option<bool> {
    (handle.radius > 8.0).then_some(scene.springs.is_empty() && scene.kind != crate::structure::StructureKind::Chain)
}

fn mass_body(painter: &Painter, palette: &Palette, handle: &Handle, round: bool, lit: bool) {
    let stroke = theme::bold(if lit { palette.accent } else { palette.ink });
    if round {
        painter.circle(handle.pos, handle.radius, palette.raised, stroke);
    } else {
        let rect = Rect::from_center_size(handle.pos, vec2(2.0 * handle.radius, 2.0 * handle.radius));
        painter.rect(rect, 3.0, palette.raised, stroke, StrokeKind::Middle);
    }
}

/// A bent arrow.
fn rotation(painter: &Painter, palette: &Palette, handle: &Handle, lit: bool) {
    let colour = if lit { palette.accent } else { palette.weak.gamma_multiply(0.8) };
    let r = handle.radius + 0.5;
    let point_at = |degrees: f32| {
        let (s, c) = degrees.to_radians().sin_cos();
        handle.pos + vec2(r * c, -r * s)
    };
    let arc = (0..=10).map(|k| point_at(-40.0 + 25.0 * k as f32)).collect();
    painter.add(Shape::line(arc, Stroke::new(1.3, colour)));
    let tip = point_at(-40.0);
    painter.add(Shape::convex_polygon(
        vec![tip + vec2(-2.5, 2.5), tip + vec2(3.5, 0.5), tip + vec2(-0.5, -3.5)],
        colour,
        Stroke::NONE,
    ));
}

fn instruments(painter: &Painter, palette: &Palette, layout: &Layout) {
    for &(_, pos) in &layout.sensors {
        let body = Rect::from_center_size(pos, vec2(10.0, 7.0));
        painter.rect(body, 1.5, palette.measured, Stroke::NONE, StrokeKind::Middle);
    }
    for &(_, ends) in &layout.exciters {
        symbols::arrow(painter, ends, Stroke::new(2.2, palette.accent));
        let away = (ends[0] - ends[1]).normalized();
        // Beside an arrow that points up or down, behind one that points to a side.
        let at = ends[0] + if away.y.abs() > away.x.abs() { vec2(-9.0, -7.0 * away.y) } else { away * 8.0 };
        painter.text(at, Align2::CENTER_CENTER, "F", theme::font(theme::size::BODY), palette.accent);
    }
}

fn drag(painter: &Painter, palette: &Palette, marks: &Marks<'_>) {
    if let Some((effect, [from, to])) = marks.rubber {
        // Beside the structure, so that the symbol can be told from it.
        let along = (to - from).normalized();
        let across = if along.x < 0.0 { vec2(along.y, -along.x) } else { vec2(-along.y, along.x) } * 34.0;
        let ends = [from + across, to + across];
        painter.line_segment(ends, Stroke::new(22.0, palette.accent.gamma_multiply(0.10)));
        for (point, end) in [from, to].into_iter().zip(ends) {
            painter.extend(Shape::dashed_line(&[point, end], theme::hair(palette.accent), 3.0, 3.0));
        }
        symbols::draw(painter, effect, ends, theme::pen(palette.accent));
    }
    if let Some(span) = marks.span {
        let fill: Color32 = palette.accent.gamma_multiply(0.10);
        painter.rect(span, 3.0, fill, theme::hair(palette.accent), StrokeKind::Middle);
    }
}
