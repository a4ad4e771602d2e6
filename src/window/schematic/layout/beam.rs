//! A beam along x that bends up and down: ground sources hang below, relative ones span above, lane by lane.

use super::{Ground, Handle, Layout, Part, PlacedSource, PlacedSupport, lanes};
use crate::window::schematic::model::{Scene, Support};
use egui::{Pos2, Rect, Vec2, pos2, vec2};

const LEFT: f32 = 54.0;
const RIGHT: f32 = 40.0;
const DROP: f32 = 84.0;
const LANE: f32 = 30.0;
const HANDLE: f32 = 5.0;
const ROTATION_UP: f32 = 25.0;
const EXCITER_UP: f32 = 76.0;
const EXCITER_LEAST: f32 = 30.0;
/// Height of the line that says what is shown: nothing else stands there.
const CAPTION: f32 = 28.0;
const POINTS_PER_ELEMENT: usize = 8;
const DEFLECTION: f32 = 46.0;
/// Least distance of the axis from the caption, points.
const LEAST_ABOVE: f32 = 48.0;
/// The same where the ground had no room otherwise: marks of rotations then stand beside the caption.
const CRAMPED_ABOVE: f32 = 12.0;
/// Room that the mark of a rotation takes above its node, points.
const ABOVE_NODE: f32 = 34.0;
/// Room that a source to the ground takes below its node at least, points.
const BELOW_NODE: f32 = 30.0;
/// Length of the lead between node and symbol, and of the symbol at least, points.
const LEAD: f32 = 24.0;
const LEAST_LEAD: f32 = 8.0;
const LEAST_SYMBOL: f32 = 20.0;
/// Least depth of the ground under the axis, points.
const LEAST_DROP: f32 = 46.0;
/// Least room of the mark of the ground under its line, points.
const LEAST_BELOW: f32 = 10.0;
/// Room of a label: of each letter, and beside them, points.
const LETTER: f32 = 6.6;
const BESIDE_LABEL: f32 = 13.0;

struct Frame<'a> {
    scene: &'a Scene,
    shape: Option<&'a [f64]>,
    left: f32,
    scale: f32,
    least: f64,
    axis: f32,
    /// Length of the arrows of exciters: shorter where there is little room above.
    exciter: f32,
    ground: f32,
    /// Height of a deflection of one, points.
    deflection: f32,
    first_lane: f32,
}

pub(super) fn place(scene: &Scene, area: Rect, shape: Option<&[f64]>) -> Layout {
    let frame = Frame::new(scene, area, shape);
    let elements = || scene.lines.iter();
    Layout {
        rest: if shape.is_some() {
            elements().map(|l| l.map(|n| frame.rest(n)).to_vec()).collect()
        } else {
            Vec::new()
        },
        body: elements().map(|l| frame.element(*l)).collect(),
        supports: frame.supports(),
        handles: (0..scene.dofs.len()).map(|d| frame.handle(d)).collect(),
        sources: frame.sources(),
        sensors: frame.marks(|d| !d.sensors.is_empty()).map(|(d, p)| (d, p - vec2(0.0, 9.0))).collect(),
        exciters: frame
            .marks(|d| d.exciter)
            .map(|(d, p)| (d, [p - vec2(15.0, frame.exciter), p - vec2(15.0, 6.0)]))
            .collect(),
        ..Layout::default()
    }
}

impl<'a> Frame<'a> {
    fn new(scene: &'a Scene, area: Rect, shape: Option<&'a [f64]>) -> Self {
        let x = || scene.nodes.iter().map(|n| n.position[0]);
        let (least, greatest) = (x().fold(f64::INFINITY, f64::min), x().fold(f64::NEG_INFINITY, f64::max));
        let span = (greatest - least).max(1e-12);
        let has_exciter = scene.dofs.iter().any(|d| d.exciter);
        let torsion = scene.sources.iter().any(|s| s.dofs.len() == 1 && scene.dofs[s.dofs[0]].direction.is_rotation());
        let base = if has_exciter { EXCITER_UP + 8.0 } else { 46.0 } + if torsion { 30.0 } else { 0.0 };
        let lanes = relative_lanes(scene).iter().map(|&(_, lane)| lane + 1).max().unwrap_or(0) as f32;
        let above = base + lanes * LANE + 14.0;
        let below = DROP + 26.0;
        let top = area.top() + CAPTION;
        let spare = area.bottom() - top - above - below;
        // Where there is little room the ground comes nearer first, then the axis goes up.
        let nearer = (-spare).clamp(0.0, DROP - LEAST_DROP);
        let higher = (-spare - nearer).clamp(0.0, (above - LEAST_ABOVE).max(0.0));
        let foot = top + above - higher + LEAST_LEAD + LEAST_SYMBOL + LEAST_BELOW;
        let cramped = (foot - area.bottom()).clamp(0.0, (above - higher - CRAMPED_ABOVE).max(0.0));
        let axis = top + above - higher - cramped + (spare / 2.0).max(0.0);
        let drop = (DROP - nearer).min(area.bottom() - LEAST_BELOW - axis).max(LEAST_LEAD + LEAST_SYMBOL);
        // Neither caption nor ground are reached, whatever the phase of the motion.
        let room = (axis - top - ABOVE_NODE).min(drop - BELOW_NODE);
        let deflection = DEFLECTION.min(room.max(6.0));
        let deflected = shape.is_some();
        Self {
            scene,
            shape,
            left: area.left() + LEFT,
            scale: ((area.width() - LEFT - RIGHT).max(40.0)) / span as f32,
            least,
            axis,
            deflection,
            exciter: (axis - top - deflection * highest(scene, shape)).clamp(EXCITER_LEAST, EXCITER_UP),
            ground: axis + drop,
            first_lane: axis - base - if deflected { 8.0 } else { 0.0 },
        }
    }

    fn rest(&self, node: usize) -> Pos2 {
        pos2(self.left + (self.scene.nodes[node].position[0] - self.least) as f32 * self.scale, self.axis)
    }

    /// Displacement (up is positive) and slope of a node in units of the largest translation.
    fn motion(&self, node: usize, rotation: bool) -> f32 {
        let Some(shape) = self.shape else { return 0.0 };
        let dof = self.scene.dofs.iter().position(|d| d.node == node && d.direction.is_rotation() == rotation);
        dof.map_or(0.0, |d| shape[d] as f32)
    }

    fn node(&self, node: usize) -> Pos2 {
        self.rest(node) - vec2(0.0, self.deflection * self.motion(node, false))
    }

    /// The Hermite cubic between two nodes, from their displacements and slopes.
    fn element(&self, [a, b]: [usize; 2]) -> Vec<Pos2> {
        let (p, q) = (self.rest(a), self.rest(b));
        if self.shape.is_none() {
            return vec![p, q];
        }
        let length = (self.scene.nodes[b].position[0] - self.scene.nodes[a].position[0]) as f32;
        let (wa, wb) = (self.motion(a, false), self.motion(b, false));
        let (sa, sb) = (self.motion(a, true) * length, self.motion(b, true) * length);
        let point_at = |k: usize| {
            let t = k as f32 / POINTS_PER_ELEMENT as f32;
            let (t2, t3) = (t * t, t * t * t);
            let w = wa * (1.0 - 3.0 * t2 + 2.0 * t3)
                + sa * (t - 2.0 * t2 + t3)
                + wb * (3.0 * t2 - 2.0 * t3)
                + sb * (t3 - t2);
            pos2(p.x + t * (q.x - p.x), self.axis - self.deflection * w)
        };
        (0..=POINTS_PER_ELEMENT).map(point_at).collect()
    }

    fn supports(&self) -> Vec<PlacedSupport> {
        let last = self.scene.nodes.len().saturating_sub(1);
        let place = |(k, node): (usize, &crate::window::schematic::model::SceneNode)| {
            let support = node.support?;
            let into = match support {
                Support::Pinned => Vec2::DOWN,
                Support::Clamped if k == last && k > 0 => Vec2::RIGHT,
                Support::Clamped => Vec2::LEFT,
            };
            Some(PlacedSupport { pos: self.rest(k), into, support })
        };
        self.scene.nodes.iter().enumerate().filter_map(place).collect()
    }

    fn handle(&self, dof: usize) -> Handle {
        let d = &self.scene.dofs[dof];
        let node = self.node(d.node);
        let rotation = d.direction.is_rotation();
        if rotation {
            let pos = node - vec2(0.0, ROTATION_UP);
            Handle { dof, pos, radius: HANDLE, rotation, label: pos + vec2(9.0, 0.0), labelled: false }
        } else {
            Handle {
                dof,
                pos: node,
                radius: HANDLE,
                rotation,
                label: node + self.label_offset(&d.label),
                labelled: self.has_label(d.node),
            }
        }
    }

    /// Whether the label of a node is shown: of so many that each has room, the last among them.
    fn has_label(&self, node: usize) -> bool {
        let last = self.scene.nodes.len().saturating_sub(1);
        let every = (self.label_room() / self.pitch().max(1.0)).ceil().max(1.0) as usize;
        (last - node.min(last)).is_multiple_of(every)
    }

    /// Room that a label wants beside its node.
    fn label_room(&self) -> f32 {
        let longest = self.scene.dofs.iter().map(|d| d.label.chars().count()).max().unwrap_or(1) as f32;
        BESIDE_LABEL + LETTER * longest
    }

    /// Left centre of a label from its node: beside it above the beam, or below the beam where the neighbour's sensor is too near.
    fn label_offset(&self, label: &str) -> Vec2 {
        let crowded = self.label_room() > self.pitch();
        if crowded { vec2(-0.5 * LETTER * label.chars().count() as f32, 15.0) } else { vec2(8.0, -11.0) }
    }

    /// Distance between neighbouring nodes on the screen, points.
    fn pitch(&self) -> f32 {
        self.scale * self.span() / self.scene.nodes.len().saturating_sub(1).max(1) as f32
    }

    /// Length along x, m.
    fn span(&self) -> f32 {
        let greatest = self.scene.nodes.iter().map(|n| n.position[0]).fold(f64::NEG_INFINITY, f64::max);
        (greatest - self.least) as f32
    }

    fn marks(
        &self,
        want: impl Fn(&crate::window::schematic::model::SceneDof) -> bool,
    ) -> impl Iterator<Item = (usize, Pos2)> {
        let marks: Vec<(usize, Pos2)> = self
            .scene
            .dofs
            .iter()
            .enumerate()
            .filter(|(_, d)| want(d))
            .map(|(dof, d)| (dof, self.node(d.node)))
            .collect();
        marks.into_iter()
    }

    fn sources(&self) -> Vec<PlacedSource> {
        let lanes = relative_lanes(self.scene);
        let place = |slot: usize| {
            let source = &self.scene.sources[slot];
            let parts = if source.dofs.len() == 1 {
                vec![self.to_ground(slot, source.dofs[0])]
            } else {
                let lane = lanes.iter().find(|(s, _)| *s == slot).map_or(0, |(_, lane)| *lane);
                source.dofs.windows(2).map(|d| self.between(d[0], d[1], lane)).collect()
            };
            PlacedSource { slot, parts }
        };
        (0..self.scene.sources.len()).map(place).collect()
    }

    fn to_ground(&self, slot: usize, dof: usize) -> Part {
        let (rank, count) = rank(self.scene, slot);
        let pitch = 24.0_f32.min(0.8 * self.scale * self.step() / count as f32);
        let shift = (rank as f32 - 0.5 * (count as f32 - 1.0)) * pitch;
        let node = self.handle(dof).pos;
        if self.scene.dofs[dof].direction.is_rotation() {
            // It goes with its node: the ground of a rotation is drawn beside it, not at a place in space.
            let foot = pos2(node.x + shift, node.y - 40.0);
            let start = pos2(node.x + shift, node.y - 8.0);
            let leads = if shift == 0.0 { Vec::new() } else { vec![[node, start]] };
            return Part {
                leads,
                glyph: [start, foot],
                ground: Some(Ground { pos: foot, into: Vec2::UP, width: 16.0 }),
            };
        }
        let lead = (self.ground - node.y - LEAST_SYMBOL).clamp(LEAST_LEAD, LEAD);
        let start = pos2(node.x + shift, node.y + lead);
        let foot = pos2(node.x + shift, self.ground);
        let elbow = pos2(node.x + shift, node.y + 0.5 * lead);
        let leads = if shift == 0.0 { vec![[node, start]] } else { vec![[node, elbow], [elbow, start]] };
        Part {
            leads,
            glyph: [start, foot],
            ground: Some(Ground { pos: foot, into: Vec2::DOWN, width: 20.0_f32.min(pitch) }),
        }
    }

    fn between(&self, a: usize, b: usize, lane: usize) -> Part {
        let (p, q) = (self.handle(a).pos, self.handle(b).pos);
        let y = self.first_lane - lane as f32 * LANE;
        let (above_p, above_q) = (pos2(p.x, y), pos2(q.x, y));
        Part { leads: vec![[p, above_p], [q, above_q]], glyph: [above_p, above_q], ground: None }
    }

    /// Distance between neighbouring nodes, m.
    fn step(&self) -> f32 {
        let span = self.scene.nodes.iter().map(|n| n.position[0] - self.least).fold(0.0, f64::max);
        (span / (self.scene.nodes.len().max(2) - 1) as f64) as f32
    }
}

/// How far the shape lifts the highest exciter, in deflections of one.
fn highest(scene: &Scene, shape: Option<&[f64]>) -> f32 {
    let Some(shape) = shape else { return 0.0 };
    let lifted = scene.dofs.iter().zip(shape).filter(|(d, _)| d.exciter).map(|(_, u)| *u as f32);
    lifted.fold(0.0, f32::max)
}

/// Which of the sources on the same DOF to the ground this one is, and how many there are.
pub(super) fn rank(scene: &Scene, slot: usize) -> (usize, usize) {
    let same = |s: &crate::window::schematic::model::SceneSource| s.dofs == scene.sources[slot].dofs;
    let before = scene.sources[..slot].iter().filter(|s| same(s)).count();
    (before, scene.sources.iter().filter(|s| same(s)).count())
}

/// Slot and lane of every source between DOFs.
fn relative_lanes(scene: &Scene) -> Vec<(usize, usize)> {
    let slots: Vec<usize> = (0..scene.sources.len()).filter(|&s| scene.sources[s].dofs.len() > 1).collect();
    let x = |d: &usize| scene.nodes[scene.dofs[*d].node].position[0] as f32;
    let interval = |slot: &usize| {
        let xs = || scene.sources[*slot].dofs.iter().map(x);
        [xs().fold(f32::INFINITY, f32::min), xs().fold(f32::NEG_INFINITY, f32::max)]
    };
    let intervals: Vec<[f32; 2]> = slots.iter().map(interval).collect();
    slots.into_iter().zip(lanes::assign(&intervals)).collect()
}
