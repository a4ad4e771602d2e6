//! Triangles with a normal and a colour at each corner: boxes, tubes and balls.

use egui::Color32;
use nalgebra::Vector3;
use std::f32::consts::{PI, TAU};

/// A corner, as the shader reads it.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct Vertex {
    /// Place.
    pub position: [f32; 3],
    /// Outward unit vector.
    pub normal: [f32; 3],
    /// Red, green, blue and opacity, 0 to 255.
    pub colour: [u8; 4],
}

/// Triangles.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Mesh {
    /// Corners.
    pub vertices: Vec<Vertex>,
    /// Three corners a triangle, counterclockwise from outside.
    pub indices: Vec<u32>,
}

impl Mesh {
    fn vertex(&mut self, position: Vector3<f32>, normal: Vector3<f32>, colour: Color32) {
        self.vertices.push(Vertex { position: position.into(), normal: normal.into(), colour: colour.to_array() });
    }

    fn next(&self) -> u32 {
        self.vertices.len() as u32
    }

    /// Adds a box between two corners, one colour.
    pub(crate) fn cuboid(&mut self, low: Vector3<f32>, high: Vector3<f32>, colour: Color32) {
        for axis in 0..3 {
            for side in [false, true] {
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let mut normal = Vector3::zeros();
                normal[axis] = if side { 1.0 } else { -1.0 };
                let start = self.next();
                for (a, b) in [(false, false), (true, false), (true, true), (false, true)] {
                    let mut p = Vector3::zeros();
                    p[axis] = if side { high[axis] } else { low[axis] };
                    p[u] = if a { high[u] } else { low[u] };
                    p[v] = if b { high[v] } else { low[v] };
                    self.vertex(p, normal, colour);
                }
                let order = if side { [0, 1, 2, 0, 2, 3] } else { [0, 2, 1, 0, 3, 2] };
                self.indices.extend(order.map(|k| start + k));
            }
        }
    }

    /// Adds a tube from `ends[0]` to `ends[1]`, its colour running from one to the other; open at both ends.
    pub(crate) fn tube(&mut self, ends: [Vector3<f32>; 2], radius: f32, colours: [Color32; 2], sides: u32) {
        let along = ends[1] - ends[0];
        if along.norm() < 1e-12 {
            return;
        }
        let axis = along.normalize();
        let helper = if axis.z.abs() < 0.9 { Vector3::z() } else { Vector3::x() };
        let u = axis.cross(&helper).normalize();
        let v = axis.cross(&u);
        let start = self.next();
        for k in 0..sides {
            let (s, c) = (TAU * k as f32 / sides as f32).sin_cos();
            let normal = u * c + v * s;
            for (end, colour) in ends.iter().zip(colours) {
                self.vertex(end + normal * radius, normal, colour);
            }
        }
        for k in 0..sides {
            let (a, b) = (start + 2 * k, start + 2 * ((k + 1) % sides));
            self.indices.extend([a, b, a + 1, b, b + 1, a + 1]);
        }
    }

    /// Adds a ball of `rings` rings from pole to pole and twice as many meridians.
    pub(crate) fn ball(&mut self, centre: Vector3<f32>, radius: f32, colour: Color32, rings: u32) {
        let start = self.next();
        let round = 2 * rings;
        for i in 0..=rings {
            let (st, ct) = (PI * i as f32 / rings as f32).sin_cos();
            for j in 0..=round {
                let (sp, cp) = (TAU * j as f32 / round as f32).sin_cos();
                let normal = Vector3::new(st * cp, st * sp, ct);
                self.vertex(centre + normal * radius, normal, colour);
            }
        }
        for i in 0..rings {
            for j in 0..round {
                let a = start + i * (round + 1) + j;
                let b = a + round + 1;
                self.indices.extend([a, b, b + 1, a, b + 1, a + 1]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Mesh;
    use egui::Color32;
    use nalgebra::Vector3;

    /// Volume by the divergence theorem: every triangle with the origin; right only where all face outwards.
    fn volume(mesh: &Mesh) -> f32 {
        let vertex = |k: u32| Vector3::from(mesh.vertices[k as usize].position);
        mesh.indices.chunks(3).map(|t| vertex(t[0]).dot(&vertex(t[1]).cross(&vertex(t[2]))) / 6.0).sum()
    }

    #[test]
    fn a_box_faces_outwards_and_has_its_volume() {
        let mut mesh = Mesh::default();
        mesh.cuboid(Vector3::new(1.0, -2.0, 0.5), Vector3::new(3.0, 1.0, 4.5), Color32::RED);
        assert_eq!((mesh.vertices.len(), mesh.indices.len()), (24, 36));
        assert!((volume(&mesh) - 24.0).abs() < 1e-4, "{}", volume(&mesh));
    }

    #[test]
    fn a_ball_faces_outwards_and_nears_its_volume() {
        let mut mesh = Mesh::default();
        mesh.ball(Vector3::new(0.3, 0.1, -2.0), 1.5, Color32::RED, 24);
        let exact = 4.0 / 3.0 * std::f32::consts::PI * 3.375;
        assert!((volume(&mesh) / exact - 1.0).abs() < 0.01, "{}", volume(&mesh) / exact);
    }

    #[test]
    fn the_sides_of_a_tube_face_outwards() {
        let mut mesh = Mesh::default();
        let ends = [Vector3::new(0.0, 0.0, 1.0), Vector3::new(2.0, 1.0, -1.0)];
        mesh.tube(ends, 0.2, [Color32::RED, Color32::BLUE], 8);
        let axis = (ends[1] - ends[0]).normalize();
        for t in mesh.indices.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|k| Vector3::from(mesh.vertices[t[k] as usize].position));
            let face = (b - a).cross(&(c - a)).normalize();
            let middle = (a + b + c) / 3.0 - ends[0];
            let out = middle - axis * middle.dot(&axis);
            assert!(face.dot(&out.normalize()) > 0.9, "{face:?} {out:?}");
        }
    }
}
