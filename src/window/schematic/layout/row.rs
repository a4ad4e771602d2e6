//! Masses in a row that move sideways: springs and sources side by side in the gaps, the ground at the walls and below.

use super::{Ground, Handle, Layout, MassBox, Part, PlacedSource, lanes};
use crate::structure::StructureKind;
use crate::window::schematic::model::Scene;
use egui::{Pos2, Rect, Vec2, pos2, vec2};

const PITCH: f32 = 26.0;
const BOX: f32 = 46.0;
const POINT: f32 = 30.0;
const WALL: f32 = 34.0;
const LANE: f32 = 28.0;
const DROP: f32 = 74.0;
/// Least depth of the ground below a mass, and its hatches.
const LEAST_DROP: f32 = 40.0;
const HATCH: f32 = 12.0;
/// Room above the masses for sensors, arrows and the line that says what is shown.
const ABOVE: f32 = 44.0;

/// Whether a structure without a shape of its own stands in a row: one DOF a node, all nodes on a line.
pub(super) fn fits(scene: &Scene) -> bool {
    let one_each = scene.dofs.len() == scene.nodes.len() && scene.dofs.iter().enumerate().all(|(i, d)| d.node == i);
    let y_and_z = |n: &crate::window::schematic::model::SceneNode| [n.position[1], n.position[2]];
    one_each && scene.nodes.iter().all(|n| y_and_z(n) == y_and_z(&scene.nodes[0]))
}

/// Where a leg is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Slot {
    LeftWall,
    RightWall,
    Gap(usize),
    Below(usize),
    Above,
}

/// A leg of a spring (`source` is `None`) or of a source.
struct Leg {
    source: Option<usize>,
    first: usize,
    second: Option<usize>,
    slot: Slot,
}

struct Frame<'a> {
    scene: &'a Scene,
    shape: Option<&'a [f64]>,
    legs: Vec<Leg>,
    left: f32,
    right: f32,
    first: f32,
    gap: f32,
    axis: f32,
    /// Depth of the ground below the masses.
    drop: f32,
    size: Vec2,
}

pub(super) fn place(scene: &Scene, area: Rect, shape: Option<&[f64]>) -> Layout {
    let frame = Frame::new(scene, area, shape);
    let lanes = frame.lanes();
    let parts: Vec<(Option<usize>, Part)> =
        (0..frame.legs.len()).map(|i| (frame.legs[i].source, frame.part(i, lanes[i]))).collect();
    let source = |slot: usize| PlacedSource {
        slot,
        parts: parts.iter().filter(|(s, _)| *s == Some(slot)).map(|(_, p)| p.clone()).collect(),
    };
    let top = |d: usize| frame.mass(d).rect.center_top();
    let marked = |want: fn(&crate::window::schematic::model::SceneDof) -> bool| {
        (0..scene.dofs.len()).filter(move |&d| want(&scene.dofs[d]))
    };
    Layout {
        rest: if shape.is_some() { frame.ghosts() } else { Vec::new() },
        masses: (0..scene.dofs.len()).map(|d| frame.mass(d)).collect(),
        springs: parts.iter().filter(|(s, _)| s.is_none()).map(|(_, p)| p.clone()).collect(),
        handles: (0..scene.dofs.len()).map(|d| frame.handle(d)).collect(),
        sources: (0..scene.sources.len()).map(source).collect(),
        sensors: marked(|d| !d.sensors.is_empty()).map(|d| (d, top(d) + vec2(0.25 * frame.size.x, -5.0))).collect(),
        exciters: marked(|d| d.exciter)
            .map(|d| (d, [top(d) + vec2(-44.0, -14.0), top(d) + vec2(-4.0, -14.0)]))
            .collect(),
        ..Layout::default()
    }
}

impl<'a> Frame<'a> {
    fn new(scene: &'a Scene, area: Rect, shape: Option<&'a [f64]>) -> Self {
        let legs = legs(scene);
        let n = scene.dofs.len();
        let count = |slot: Slot| legs.iter().filter(|l| l.slot == slot).count();
        let side_by_side = (0..n).map(|i| count(Slot::Gap(i))).chain([count(Slot::LeftWall), count(Slot::RightWall)]);
        let stack = side_by_side.max().unwrap_or(0).max(1) as f32;
        let base = if scene.kind == StructureKind::Chain { BOX } else { POINT };
        let height = base.max(stack * PITCH + 4.0).min((area.height() - 150.0).max(base));
        let walls = [count(Slot::LeftWall) > 0, count(Slot::RightWall) > 0];
        let left = area.left() + WALL;
        let right = area.right() - WALL;
        let share = |wall: bool| if wall { 1.0 } else { 0.25 };
        let gaps = (n.max(1) - 1) as f32 + share(walls[0]) + share(walls[1]);
        let gap = ((right - left - base * n as f32) / gaps).clamp(26.0, 190.0) + base;
        let used = gap * (n.max(1) - 1) as f32 + (gap - base) * (share(walls[0]) + share(walls[1])) + base;
        let start = left + ((right - left - used) / 2.0).max(0.0);
        let first = start + (gap - base) * share(walls[0]) + base / 2.0;
        let last = first + gap * (n.max(1) - 1) as f32;
        let below = legs.iter().any(|l| matches!(l.slot, Slot::Below(_)));
        let axis = area.center().y - 6.0;
        // Where the ground below has no room the row goes up, then the ground comes nearer.
        let lacks = |axis: f32| (axis + 0.5 * height + DROP + HATCH - area.bottom()).max(0.0);
        let free = (axis - 0.5 * height - ABOVE - area.top()).max(0.0);
        let axis = axis - if below { lacks(axis).min(free) } else { 0.0 };
        Self {
            scene,
            shape,
            left: start,
            right: last + base / 2.0 + (gap - base) * share(walls[1]),
            legs,
            first,
            gap,
            axis,
            drop: (DROP - lacks(axis)).max(LEAST_DROP),
            size: vec2(base, height),
        }
    }

    fn rest(&self, dof: usize) -> Pos2 {
        pos2(self.first + self.gap * dof as f32, self.axis)
    }

    fn mass(&self, dof: usize) -> MassBox {
        let shift = self.shape.map_or(0.0, |s| s[dof] as f32) * 0.32 * (self.gap - self.size.x);
        let round = self.scene.kind != StructureKind::Chain;
        let size = if round { Vec2::splat(POINT) } else { self.size };
        MassBox { dof, rect: Rect::from_center_size(self.rest(dof) + vec2(shift, 0.0), size), round }
    }

    fn ghosts(&self) -> Vec<Vec<Pos2>> {
        let ghost = |d: usize| {
            let r = Rect::from_center_size(self.rest(d), self.mass(d).rect.size());
            vec![r.left_top(), r.right_top(), r.right_bottom(), r.left_bottom(), r.left_top()]
        };
        (0..self.scene.dofs.len()).map(ghost).collect()
    }

    fn handle(&self, dof: usize) -> Handle {
        let rect = self.mass(dof).rect;
        let radius = 0.5 * rect.width().min(rect.height());
        Handle { dof, pos: rect.center(), radius, rotation: false, label: rect.center(), labelled: true }
    }

    /// Lane of every leg that spans more than one gap; 0 for the others.
    fn lanes(&self) -> Vec<usize> {
        let above: Vec<usize> = (0..self.legs.len()).filter(|&i| self.legs[i].slot == Slot::Above).collect();
        let interval = |&i: &usize| {
            let (a, b) = (self.legs[i].first as f32, self.legs[i].second.unwrap_or(0) as f32);
            [a.min(b), a.max(b)]
        };
        let assigned = lanes::assign(&above.iter().map(interval).collect::<Vec<_>>());
        let mut lanes = vec![0; self.legs.len()];
        for (i, lane) in above.into_iter().zip(assigned) {
            lanes[i] = lane;
        }
        lanes
    }

    fn part(&self, i: usize, lane: usize) -> Part {
        let leg = &self.legs[i];
        let rank = self.legs[..i].iter().filter(|l| l.slot == leg.slot).count() as f32;
        let count = self.legs.iter().filter(|l| l.slot == leg.slot).count() as f32;
        let pitch = PITCH.min(self.size.y / count.max(1.0));
        let y = self.axis + (rank - 0.5 * (count - 1.0)) * pitch;
        match leg.slot {
            Slot::LeftWall => {
                let wall = pos2(self.left, y);
                let face = pos2(self.mass(leg.first).rect.left(), y);
                Part { leads: Vec::new(), glyph: [face, wall], ground: Some(wall_at(wall, Vec2::LEFT, pitch)) }
            }
            Slot::RightWall => {
                let wall = pos2(self.right, y);
                let face = pos2(self.mass(leg.first).rect.right(), y);
                Part { leads: Vec::new(), glyph: [face, wall], ground: Some(wall_at(wall, Vec2::RIGHT, pitch)) }
            }
            Slot::Gap(k) => {
                let ends = [pos2(self.face(k, y, true), y), pos2(self.face(k + 1, y, false), y)];
                Part { leads: Vec::new(), glyph: ends, ground: None }
            }
            Slot::Below(k) => self.below(k, rank, count),
            Slot::Above => self.above(leg, lane),
        }
    }

    /// Where a horizontal line at `y` meets the right or left face of a mass; points are round.
    fn face(&self, dof: usize, y: f32, right: bool) -> f32 {
        let m = self.mass(dof);
        let half = if m.round {
            let r = 0.5 * m.rect.width();
            (r * r - (y - self.axis).powi(2)).max(0.0).sqrt()
        } else {
            0.5 * m.rect.width()
        };
        m.rect.center().x + if right { half } else { -half }
    }

    fn below(&self, dof: usize, rank: f32, count: f32) -> Part {
        let rect = self.mass(dof).rect;
        let pitch = 26.0_f32.min(0.9 * self.gap / count);
        let x = rect.center().x + (rank - 0.5 * (count - 1.0)) * pitch;
        let start = pos2(x.clamp(rect.left() - self.gap, rect.right() + self.gap), rect.bottom() + 8.0);
        let foot = pos2(start.x, rect.bottom() + self.drop);
        let shoulder = pos2(start.x.clamp(rect.left() + 2.0, rect.right() - 2.0), rect.bottom());
        Part {
            leads: vec![[shoulder, start]],
            glyph: [start, foot],
            ground: Some(Ground { pos: foot, into: Vec2::DOWN, width: 20.0_f32.min(pitch) }),
        }
    }

    fn above(&self, leg: &Leg, lane: usize) -> Part {
        let (a, b) = (self.mass(leg.first).rect, self.mass(leg.second.unwrap_or(leg.first)).rect);
        let y = a.top() - 42.0 - lane as f32 * LANE;
        let (p, q) = (pos2(a.center().x, y), pos2(b.center().x, y));
        Part { leads: vec![[a.center_top(), p], [b.center_top(), q]], glyph: [p, q], ground: None }
    }
}

fn wall_at(pos: Pos2, into: Vec2, pitch: f32) -> Ground {
    Ground { pos, into, width: pitch }
}

fn legs(scene: &Scene) -> Vec<Leg> {
    let n = scene.dofs.len();
    let chain = scene.kind == StructureKind::Chain;
    let slot = |first: usize, second: Option<usize>| match second {
        None if first == 0 && chain => Slot::LeftWall,
        None if first + 1 == n && n > 1 && chain => Slot::RightWall,
        None => Slot::Below(first),
        Some(second) if first.abs_diff(second) == 1 => Slot::Gap(first.min(second)),
        Some(_) => Slot::Above,
    };
    let spring = |s: &crate::window::schematic::model::Spring| Leg {
        source: None,
        first: s.first,
        second: s.second,
        slot: slot(s.first, s.second),
    };
    let mut legs: Vec<Leg> = scene.springs.iter().map(spring).collect();
    for (k, source) in scene.sources.iter().enumerate() {
        if let [first] = source.dofs[..] {
            legs.push(Leg { source: Some(k), first, second: None, slot: slot(first, None) });
        }
        for pair in source.dofs.windows(2) {
            let (first, second) = (pair[0], Some(pair[1]));
            legs.push(Leg { source: Some(k), first, second, slot: slot(first, second) });
        }
    }
    legs
}
