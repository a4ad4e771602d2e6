//! A wire model in space: turned by yaw and pitch, projected in parallel by [`Projection`], fitted to the pane.

use super::{Camera, Ground, Handle, Layout, Part, PlacedSource, Space, beam::rank};
use crate::structure::Direction;
use crate::window::schematic::model::Scene;
use crate::window::solid::Projection;
use egui::{Pos2, Rect, Vec2, vec2};
use nalgebra::Vector3;

const MARGIN: f32 = 64.0;
const ARROW: f32 = 13.0;
const TO_GROUND: f32 = 46.0;
const DEFLECTION: f64 = 0.09;

struct Frame<'a> {
    scene: &'a Scene,
    projection: Projection,
    /// Nodes as they stand, deflected where there is a shape.
    nodes: Vec<Vector3<f32>>,
    /// Nodes at rest.
    rest: Vec<Vector3<f32>>,
    alone: Vec<bool>,
}

pub(super) fn place(scene: &Scene, area: Rect, camera: Camera, shape: Option<&[f64]>) -> Layout {
    let frame = Frame::new(scene, area, camera, shape);
    let line = |l: &[usize; 2], deflected: bool| l.map(|n| frame.node(n, deflected)).to_vec();
    let marked = |want: fn(&crate::window::schematic::model::SceneDof) -> bool| {
        (0..scene.dofs.len()).filter(move |&d| want(&scene.dofs[d]))
    };
    let tail = |d: usize| {
        let (p, dir) = (frame.handle(d).pos, frame.away(d));
        [p - dir * 44.0, p - dir * 8.0]
    };
    Layout {
        rest: if shape.is_some() { scene.lines.iter().map(|l| line(l, false)).collect() } else { Vec::new() },
        body: scene.lines.iter().map(|l| line(l, true)).collect(),
        space: Some(Space {
            projection: frame.projection,
            nodes: frame.nodes.clone(),
            moved: frame.nodes.iter().zip(&frame.rest).map(|(a, b)| (a - b).norm()).collect(),
        }),
        handles: (0..scene.dofs.len()).map(|d| frame.handle(d)).collect(),
        sources: (0..scene.sources.len()).map(|s| frame.source(s)).collect(),
        sensors: marked(|d| !d.sensors.is_empty()).map(|d| (d, frame.handle(d).pos + vec2(0.0, -9.0))).collect(),
        exciters: marked(|d| d.exciter).map(|d| (d, tail(d))).collect(),
        ..Layout::default()
    }
}

/// Nodes at rest.
fn at_rest(scene: &Scene) -> Vec<Vector3<f32>> {
    scene.nodes.iter().map(|n| Vector3::from(n.position.map(|v| v as f32))).collect()
}

/// The part of the pane that nodes may take; the rest is for symbols.
fn inner(area: Rect) -> Rect {
    Rect::from_center_size(area.center(), (area.size() - Vec2::splat(2.0 * MARGIN)).max(Vec2::splat(40.0)))
}

/// Of directions all around, the one at which the scale is largest; never along an axis, where lines hide each other.
pub(super) fn home(scene: &Scene, area: Rect) -> Camera {
    let nodes = at_rest(scene);
    let camera = |k: u8| Camera { yaw: 0.3 + 0.1 * f32::from(k), ..Camera::default() };
    let scale = |k: u8| Projection::fit(&nodes, camera(k), inner(area)).scale;
    let best = (0..62).max_by(|a, b| scale(*a).total_cmp(&scale(*b))).unwrap_or(0);
    camera(best)
}

impl<'a> Frame<'a> {
    fn new(scene: &'a Scene, area: Rect, camera: Camera, shape: Option<&'a [f64]>) -> Self {
        let alone = (0..scene.nodes.len()).map(|n| scene.dofs.iter().filter(|d| d.node == n).count() <= 1).collect();
        let rest = at_rest(scene);
        let projection = Projection::fit(&rest, camera, inner(area));
        let mut nodes = rest.clone();
        if let Some(shape) = shape {
            let size = (DEFLECTION * extent(scene)) as f32;
            for (row, dof) in scene.dofs.iter().enumerate() {
                if let Some(axis) = axis(dof.direction) {
                    nodes[dof.node][axis] += size * shape[row] as f32;
                }
            }
        }
        Self { scene, projection, nodes, rest, alone }
    }

    fn node(&self, node: usize, deflected: bool) -> Pos2 {
        self.projection.at(if deflected { self.nodes[node] } else { self.rest[node] })
    }

    /// Unit direction on the screen in which a DOF moves; up where it points at the eye.
    fn along(&self, dof: usize) -> Vec2 {
        let axis = match self.scene.dofs[dof].direction {
            Direction::X | Direction::Rx => Vector3::x(),
            Direction::Y | Direction::Ry => Vector3::y(),
            Direction::Z | Direction::Rz | Direction::Q => Vector3::z(),
        };
        let [right, up, _] = self.projection.camera.axes();
        let v = vec2(right.dot(&axis), -up.dot(&axis));
        if v.length() < 0.15 { Vec2::UP } else { v.normalized() }
    }

    /// The same, turned so that it never points up: towards where the ground is drawn.
    fn away(&self, dof: usize) -> Vec2 {
        let v = self.along(dof);
        if v.y < -1e-3 { -v } else { v }
    }

    fn handle(&self, dof: usize) -> Handle {
        let d = &self.scene.dofs[dof];
        let rotation = d.direction.is_rotation();
        let reach = if rotation { 1.7 * ARROW } else { ARROW };
        let shift = if self.alone[d.node] { Vec2::ZERO } else { self.along(dof) * reach };
        let pos = self.node(d.node, true) + shift;
        let few = self.scene.dofs.len() <= 24;
        // Marks of rotations stand beside the node: the label goes above them.
        let turns = self.scene.dofs.iter().any(|other| other.node == d.node && other.direction.is_rotation());
        let label = pos + vec2(8.0, if turns { -19.0 } else { -8.0 });
        Handle { dof, pos, radius: 4.0, rotation, label, labelled: few && !rotation }
    }

    fn source(&self, slot: usize) -> PlacedSource {
        let dofs = &self.scene.sources[slot].dofs;
        let parts = match dofs[..] {
            [dof] => vec![self.to_ground(slot, dof)],
            _ => dofs.windows(2).map(|d| self.between(slot, d[0], d[1])).collect(),
        };
        PlacedSource { slot, parts }
    }

    fn to_ground(&self, slot: usize, dof: usize) -> Part {
        let (start, away) = (self.handle(dof).pos, self.away(dof));
        let shifted = start + self.aside(slot, away);
        let foot = shifted + away * TO_GROUND;
        let leads = if shifted == start { Vec::new() } else { vec![[start, shifted]] };
        Part { leads, glyph: [shifted + away * 5.0, foot], ground: Some(Ground { pos: foot, into: away, width: 18.0 }) }
    }

    fn between(&self, slot: usize, a: usize, b: usize) -> Part {
        let (p, q) = (self.handle(a).pos, self.handle(b).pos);
        let shift = self.aside(slot, (q - p).normalized());
        let leads = if shift == Vec2::ZERO { Vec::new() } else { vec![[p, p + shift], [q, q + shift]] };
        Part { leads, glyph: [p + shift, q + shift], ground: None }
    }

    /// Sources at the same place stand side by side.
    fn aside(&self, slot: usize, along: Vec2) -> Vec2 {
        let (rank, count) = rank(self.scene, slot);
        along.rot90() * (rank as f32 - 0.5 * (count as f32 - 1.0)) * 18.0
    }
}

fn axis(direction: Direction) -> Option<usize> {
    match direction {
        Direction::X => Some(0),
        Direction::Y => Some(1),
        Direction::Z => Some(2),
        _ => None,
    }
}

/// Largest dimension of all nodes, m.
fn extent(scene: &Scene) -> f64 {
    let range = |k: usize| {
        let coordinates = || scene.nodes.iter().map(|n| n.position[k]);
        coordinates().fold(f64::NEG_INFINITY, f64::max) - coordinates().fold(f64::INFINITY, f64::min)
    };
    (0..3).map(range).fold(0.0, f64::max)
}
