//! A wire model in space: turned by yaw and pitch, projected in parallel, fitted to the pane.
//!
//! ```text
//! right = ( cos yaw, sin yaw, 0 )      up = ( -sin yaw sin pitch, cos yaw sin pitch, cos pitch )
//! ```

use super::{Camera, Ground, Handle, Layout, Part, PlacedSource, beam::rank};
use crate::structure::Direction;
use crate::window::schematic::model::Scene;
use egui::{Pos2, Rect, Vec2, vec2};

const MARGIN: f32 = 64.0;
const ARROW: f32 = 13.0;
const TO_GROUND: f32 = 46.0;
const DEFLECTION: f64 = 0.09;

struct Frame<'a> {
    scene: &'a Scene,
    shape: Option<&'a [f64]>,
    camera: Camera,
    middle: [f64; 3],
    extent: f64,
    scale: f32,
    origin: Pos2,
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
        handles: (0..scene.dofs.len()).map(|d| frame.handle(d)).collect(),
        sources: (0..scene.sources.len()).map(|s| frame.source(s)).collect(),
        sensors: marked(|d| !d.sensors.is_empty()).map(|d| (d, frame.handle(d).pos + vec2(0.0, -9.0))).collect(),
        exciters: marked(|d| d.exciter).map(|d| (d, tail(d))).collect(),
        ..Layout::default()
    }
}

impl<'a> Frame<'a> {
    fn new(scene: &'a Scene, area: Rect, camera: Camera, shape: Option<&'a [f64]>) -> Self {
        let (middle, extent) = bounds(scene);
        let alone = (0..scene.nodes.len()).map(|n| scene.dofs.iter().filter(|d| d.node == n).count() <= 1).collect();
        let mut frame = Self { scene, shape, camera, middle, extent, scale: 1.0, origin: area.center(), alone };
        frame.fit(area);
        frame
    }

    /// Chooses scale and origin so that all nodes at rest fit, whatever their number.
    fn fit(&mut self, area: Rect) {
        let mut seen = Rect::NOTHING;
        for node in &self.scene.nodes {
            seen.extend_with(self.flat(node.position).to_pos2());
        }
        let room = (area.size() - Vec2::splat(2.0 * MARGIN)).max(Vec2::splat(40.0));
        let size = seen.size().max(Vec2::splat(1e-9));
        self.scale = (room.x / size.x).min(room.y / size.y) * self.camera.zoom;
        self.origin = area.center() - seen.center().to_vec2() * self.scale;
    }

    /// Right and down, in metres, of a point seen from the camera.
    fn flat(&self, p: [f64; 3]) -> Vec2 {
        let [x, y, z] = [0, 1, 2].map(|k| (p[k] - self.middle[k]) as f32);
        let (sy, cy) = self.camera.yaw.sin_cos();
        let (sp, cp) = self.camera.pitch.sin_cos();
        vec2(cy * x + sy * y, -(-sy * sp * x + cy * sp * y + cp * z))
    }

    fn node(&self, node: usize, deflected: bool) -> Pos2 {
        let mut p = self.scene.nodes[node].position;
        if let Some(shape) = self.shape.filter(|_| deflected) {
            for (row, dof) in self.scene.dofs.iter().enumerate().filter(|(_, d)| d.node == node) {
                if let Some(axis) = axis(dof.direction) {
                    p[axis] += DEFLECTION * self.extent * shape[row];
                }
            }
        }
        self.origin + self.flat(p) * self.scale
    }

    /// Unit direction on the screen in which a DOF moves; up where it points at the eye.
    fn along(&self, dof: usize) -> Vec2 {
        let mut p = self.middle;
        match self.scene.dofs[dof].direction {
            Direction::X | Direction::Rx => p[0] += 1.0,
            Direction::Y | Direction::Ry => p[1] += 1.0,
            Direction::Z | Direction::Rz => p[2] += 1.0,
        }
        let v = self.flat(p);
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
        Handle { dof, pos, radius: 4.0, rotation, label: pos + vec2(8.0, -8.0), labelled: few && !rotation }
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

/// Middle and largest dimension of all nodes, m.
fn bounds(scene: &Scene) -> ([f64; 3], f64) {
    let range = |k: usize| {
        let at = || scene.nodes.iter().map(|n| n.position[k]);
        (at().fold(f64::INFINITY, f64::min), at().fold(f64::NEG_INFINITY, f64::max))
    };
    let ranges = [range(0), range(1), range(2)];
    (ranges.map(|(a, b)| 0.5 * (a + b)), ranges.iter().map(|(a, b)| b - a).fold(0.0, f64::max))
}
