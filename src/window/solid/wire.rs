//! The wire model of a structure in space: lines as tubes, nodes as balls, coloured by a share of each node.

use super::mesh::Mesh;
use super::paint::Solid;
use super::pick::{Ray, nearest};
use crate::window::appearance::theme::Palette;
use crate::window::schematic::Scene;
use crate::window::schematic::layout::Space;
use egui::{Color32, Id, Painter, Rect};
use nalgebra::Vector3;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

/// A structure in space with the share of every node.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wire<'a> {
    /// Lines and nodes.
    pub scene: &'a Scene,
    /// Where they stand.
    pub space: &'a Space,
    /// Share of each DOF, 0 to 1; its colours go before those of the motion.
    pub shares: Option<&'a [f32]>,
    /// Whether the shares are those of the model's error.
    pub errors: bool,
}

impl Wire<'_> {
    /// Radius of a line in points on the screen: thinner where there are many.
    fn thickness(&self) -> f32 {
        if self.scene.lines.len() > 300 { 1.0 } else { 1.9 }
    }

    /// Share of each node from 0 to 1: of the energy where it is known, else of the motion; `None` at rest.
    pub(crate) fn node_shares(&self) -> Option<Vec<f32>> {
        let raw = match self.shares {
            Some(shares) => {
                let mut sum = vec![0.0_f32; self.scene.nodes.len()];
                for (dof, share) in self.scene.dofs.iter().zip(shares) {
                    sum[dof.node] += share.max(0.0);
                }
                sum
            }
            None => self.space.moved.clone(),
        };
        let largest = raw.iter().copied().fold(0.0, f32::max);
        (largest > 0.0).then(|| raw.iter().map(|v| v / largest).collect())
    }

    /// Tubes and balls.
    pub(crate) fn mesh(&self, palette: &Palette) -> Mesh {
        let shares = self.node_shares();
        let strong = if self.errors { palette.missing } else { palette.model };
        let colour = |n: usize| match &shares {
            Some(shares) => palette.weak.lerp_to_gamma(strong, shares[n].powf(0.7)),
            None => palette.ink.lerp_to_gamma(palette.weak, 0.35),
        };
        let radius = self.thickness() / self.space.projection.scale;
        let sides = if self.scene.lines.len() > 300 { 5 } else { 10 };
        let mut mesh = Mesh::default();
        let nodes = &self.space.nodes;
        for &[a, b] in &self.scene.lines {
            mesh.tube([nodes[a], nodes[b]], radius, [colour(a), colour(b)], sides);
        }
        let rings = if nodes.len() > 300 { 4 } else { 8 };
        for (n, at) in nodes.iter().enumerate() {
            mesh.ball(*at, self.ball() / self.space.projection.scale, colour(n), rings);
        }
        mesh
    }

    /// Radius of a node in points on the screen.
    fn ball(&self) -> f32 {
        1.9 * self.thickness()
    }

    /// The node that a ray meets first, with `reach` points on the screen about it.
    pub(crate) fn pick(&self, ray: &Ray, reach: f32) -> Option<usize> {
        let radius = (self.ball() + reach) / self.space.projection.scale;
        nearest(self.space.nodes.iter().map(|at| ray.enters_ball(*at, radius)))
    }

    /// Radius about the middle of the view that holds every node.
    pub(crate) fn reach(&self) -> f32 {
        let p = &self.space.projection;
        let far = self.space.nodes.iter().map(|n| (n - p.middle).norm()).fold(1e-6, f32::max);
        far + 2.0 * self.ball() / p.scale
    }

    /// Paints it into `area`.
    pub(crate) fn paint(&self, painter: &Painter, palette: &Palette, id: Id, area: Rect) {
        let key = self.key(palette.ink);
        let kept = painter.ctx().data(|d| d.get_temp::<(u64, Arc<Mesh>)>(id));
        let mesh = match kept {
            Some((old, mesh)) if old == key => mesh,
            _ => Arc::new(self.mesh(palette)),
        };
        painter.ctx().data_mut(|d| d.insert_temp(id, (key, Arc::clone(&mesh))));
        Solid { id, mesh, projection: self.space.projection, viewport: area, reach: self.reach() }.paint(painter);
    }

    fn key(&self, ink: Color32) -> u64 {
        let mut hasher = DefaultHasher::new();
        (ink, self.errors).hash(&mut hasher);
        self.scene.lines.hash(&mut hasher);
        let numbers = self.space.nodes.iter().flat_map(|n: &Vector3<f32>| [n.x, n.y, n.z]);
        let shares = self.shares.into_iter().flatten().copied();
        numbers.chain(shares).chain([self.space.projection.scale]).for_each(|v| v.to_bits().hash(&mut hasher));
        hasher.finish()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::Wire;
    use crate::window::schematic::{Camera, Layout, Scene, samples};
    use egui::{Rect, pos2};

    const AREA: Rect = Rect { min: pos2(0.0, 0.0), max: pos2(800.0, 500.0) };

    #[test]
    fn a_node_is_picked_where_it_is_drawn_and_nowhere_else() {
        let scene = Scene::new(&samples::points(), &[], &[]);
        let layout = Layout::new(&scene, AREA, Camera::default(), None);
        let space = layout.space.as_ref().unwrap();
        let wire = Wire { scene: &scene, space, shares: None, errors: false };
        for n in 0..4 {
            let at = space.projection.at(space.nodes[n]);
            assert_eq!(wire.pick(&space.projection.ray(at, 10.0), 0.0), Some(n));
            let beside = at + egui::vec2(wire.ball() + 3.0, 0.0);
            assert_eq!(wire.pick(&space.projection.ray(beside, 10.0), 0.0), None);
            assert_eq!(wire.pick(&space.projection.ray(beside, 10.0), 4.0), Some(n));
        }
        assert_eq!(wire.node_shares(), None, "nothing moves");
    }

    #[test]
    fn nodes_are_coloured_by_energy_where_it_is_known_else_by_motion() {
        let scene = Scene::new(&samples::points(), &[], &[]);
        let shape = [0.0, 1.0, -0.5, 0.25];
        let layout = Layout::new(&scene, AREA, Camera::default(), Some(&shape));
        let space = layout.space.as_ref().unwrap();
        let moved = Wire { scene: &scene, space, shares: None, errors: false }.node_shares().unwrap();
        for (m, s) in moved.iter().zip(shape) {
            assert!((m - s.abs() as f32).abs() < 1e-4, "{moved:?}");
        }
        let energy =
            Wire { scene: &scene, space, shares: Some(&[0.1, 0.2, 0.4, 0.0]), errors: false }.node_shares().unwrap();
        assert_eq!(energy, [0.25, 0.5, 1.0, 0.0]);
    }
}
