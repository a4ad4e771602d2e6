//! Where everything stands on the screen: pure geometry, tested with numbers.

mod beam;
mod lanes;
mod placed;
mod row;
mod wire;

pub(crate) use crate::window::solid::Camera;
pub(crate) use placed::{Ground, Handle, Layout, MassBox, Part, PlacedSource, PlacedSupport, Space};

use super::model::Scene;
use crate::structure::StructureKind;
use egui::Rect;

impl Layout {
    /// Places a scene in `area`; `shape` is a displacement per DOF of any scale, drawn with its largest translation at a
    /// fixed size.
    pub fn new(scene: &Scene, area: Rect, camera: Camera, shape: Option<&[f64]>) -> Self {
        let largest = shape.map_or(0.0, |s| largest(scene, s));
        Self::at_scale(scene, area, camera, shape, largest)
    }

    /// The same where the translation that is drawn at the fixed size is given: one moment of a motion that is larger at
    /// others.
    pub fn at_scale(scene: &Scene, area: Rect, camera: Camera, shape: Option<&[f64]>, largest: f64) -> Self {
        let shape = shape.filter(|s| s.len() == scene.dofs.len());
        let scale = if largest > 0.0 { 1.0 / largest } else { 0.0 };
        let unit = shape.map(|s| s.iter().map(|v| v * scale).collect::<Vec<f64>>());
        let unit = unit.as_deref();
        match scene.kind {
            StructureKind::Beam => beam::place(scene, area, unit),
            StructureKind::Chain => row::place(scene, area, unit),
            _ if row::fits(scene) => row::place(scene, area, unit),
            _ => wire::place(scene, area, camera, unit),
        }
    }

    /// The direction from which a scene in space fills `area` best; the default for all others.
    pub fn home(scene: &Scene, area: Rect) -> Camera {
        if Self::turns(scene) { wire::home(scene, area) } else { Camera::default() }
    }

    /// Whether the mouse can turn it.
    pub fn turns(scene: &Scene) -> bool {
        !matches!(scene.kind, StructureKind::Beam | StructureKind::Chain) && !row::fits(scene)
    }
}

/// The largest translation of a shape.
pub(crate) fn largest(scene: &Scene, shape: &[f64]) -> f64 {
    scene.translations().iter().filter_map(|&d| shape.get(d)).map(|v| v.abs()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests;
