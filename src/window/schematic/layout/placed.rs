//! What stands on the screen, with its place.

use crate::window::schematic::model::Support;
use crate::window::solid::Projection;
use egui::{Pos2, Rect, Vec2};
use nalgebra::Vector3;

/// Half the breadth of the symbols of springs, sources and sensors, points.
const HALF_SYMBOL: f32 = 6.0;

/// A DOF that can be pointed at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Handle {
    /// Row of the DOF.
    pub dof: usize,
    /// Centre.
    pub pos: Pos2,
    /// Half its size.
    pub radius: f32,
    /// Whether it is a rotation.
    pub rotation: bool,
    /// Left centre of its label.
    pub label: Pos2,
    /// Whether the label is shown unless asked for.
    pub labelled: bool,
}

/// The end of something that is fixed to the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground {
    /// Middle of the ground line.
    pub pos: Pos2,
    /// Direction into the ground, unit length.
    pub into: Vec2,
    /// Length of the ground line.
    pub width: f32,
}

/// One leg of a source: leads from its DOFs and the symbol between `glyph[0]` and `glyph[1]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Thin lines from the DOFs to the symbol.
    pub leads: Vec<[Pos2; 2]>,
    /// Ends of the symbol.
    pub glyph: [Pos2; 2],
    /// Where it meets the ground, if it does.
    pub ground: Option<Ground>,
}

/// A source with all its legs.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedSource {
    /// Index into [`crate::window::schematic::model::Scene::sources`].
    pub slot: usize,
    /// Its legs.
    pub parts: Vec<Part>,
}

/// A mass of a chain, or a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassBox {
    /// Row of its DOF.
    pub dof: usize,
    /// Outline.
    pub rect: Rect,
    /// Round for a point without a mass matrix.
    pub round: bool,
}

/// A support of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedSupport {
    /// Node.
    pub pos: Pos2,
    /// Direction into the ground.
    pub into: Vec2,
    /// How it holds.
    pub support: Support,
}

/// A wire model in space, as it stands on the screen.
#[derive(Debug, Clone, PartialEq)]
pub struct Space {
    /// How it is looked at.
    pub projection: Projection,
    /// Nodes as they are drawn, m.
    pub nodes: Vec<Vector3<f32>>,
    /// How far each node is drawn from its place at rest, m.
    pub moved: Vec<f32>,
}

/// Everything with its place.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layout {
    /// The structure at rest, drawn faintly when it is deflected.
    pub rest: Vec<Vec<Pos2>>,
    /// The structure as it stands.
    pub body: Vec<Vec<Pos2>>,
    /// Masses.
    pub masses: Vec<MassBox>,
    /// Springs of the structure, as legs.
    pub springs: Vec<Part>,
    /// Supports of a beam.
    pub supports: Vec<PlacedSupport>,
    /// DOFs.
    pub handles: Vec<Handle>,
    /// Sources.
    pub sources: Vec<PlacedSource>,
    /// Accelerometers and the like: DOF row and place.
    pub sensors: Vec<(usize, Pos2)>,
    /// Exciters: tail and tip of the arrow of force.
    pub exciters: Vec<(usize, [Pos2; 2])>,
    /// Of a wire model.
    pub space: Option<Space>,
}

impl Layout {
    /// The handle of a DOF.
    pub fn handle(&self, dof: usize) -> Option<&Handle> {
        self.handles.iter().find(|h| h.dof == dof)
    }
    /// Whether a node, a mass, a sensor, a spring or a source stands in `rect`.
    pub fn covers(&self, rect: Rect) -> bool {
        let nodes = self.handles.iter().map(|h| Rect::from_center_size(h.pos, Vec2::splat(2.0 * h.radius)));
        let sensors = self.sensors.iter().map(|(_, at)| Rect::from_center_size(*at, Vec2::splat(2.0 * HALF_SYMBOL)));
        let parts = self.springs.iter().chain(self.sources.iter().flat_map(|source| &source.parts));
        let symbols = parts.map(|part| Rect::from_two_pos(part.glyph[0], part.glyph[1]).expand(HALF_SYMBOL));
        let masses = self.masses.iter().map(|mass| mass.rect);
        nodes.chain(sensors).chain(symbols).chain(masses).any(|drawn| drawn.intersects(rect))
    }
}
