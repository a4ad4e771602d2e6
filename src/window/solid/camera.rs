//! The direction of view and the projection on the screen; the schematic, the bars and the pipeline share them.
//!
//! ```text
//! right  = ( cos yaw,            sin yaw,           0         )
//! up     = (-sin yaw sin pitch,  cos yaw sin pitch, cos pitch )
//! toward = right x up            to the eye
//! screen = origin + scale (right . (p - middle), -up . (p - middle))
//! ```
//!
//! The projection is parallel: equal heights stay equal wherever they stand, so that bars can be compared.

use super::pick::Ray;
use egui::{Pos2, Rect, Vec2, vec2};
use nalgebra::Vector3;

/// The direction from which something is looked at.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Camera {
    /// Turn about the vertical axis, rad.
    pub yaw: f32,
    /// Height of the eye above the horizon, rad.
    pub pitch: f32,
    /// Magnification; 1 fills the pane.
    pub zoom: f32,
}

impl Default for Camera {
    fn default() -> Self {
        Self { yaw: -0.6, pitch: 0.45, zoom: 1.0 }
    }
}

impl Camera {
    /// Turned by a drag of the mouse, in points: what is under the pointer follows it.
    pub fn turn(&mut self, drag: Vec2) {
        const PER_POINT: f32 = 0.008;
        self.yaw = (self.yaw - PER_POINT * drag.x).rem_euclid(std::f32::consts::TAU);
        self.pitch = (self.pitch + PER_POINT * drag.y).clamp(-std::f32::consts::FRAC_PI_2, std::f32::consts::FRAC_PI_2);
    }

    /// Magnified by a turn of the wheel, in points.
    pub fn zoom_by(&mut self, scroll: f32) {
        self.zoom = (self.zoom * (0.002 * scroll).exp()).clamp(0.3, 8.0);
    }

    /// Unit vectors to the right, upwards and towards the eye.
    pub fn axes(&self) -> [Vector3<f32>; 3] {
        let (sy, cy) = self.yaw.sin_cos();
        let (sp, cp) = self.pitch.sin_cos();
        let right = Vector3::new(cy, sy, 0.0);
        let up = Vector3::new(-sy * sp, cy * sp, cp);
        [right, up, right.cross(&up)]
    }
}

/// Where points in space stand on the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    /// Direction of view.
    pub camera: Camera,
    /// Point in space that stands at `origin`.
    pub middle: Vector3<f32>,
    /// Points on the screen a unit of length.
    pub scale: f32,
    /// Where the middle stands on the screen.
    pub origin: Pos2,
}

impl Projection {
    /// The largest scale at which all `points` fit into `room`, times the camera's zoom.
    pub fn fit(points: &[Vector3<f32>], camera: Camera, room: Rect) -> Self {
        let low = points.iter().fold(Vector3::repeat(f32::INFINITY), |a, p| a.inf(p));
        let high = points.iter().fold(Vector3::repeat(f32::NEG_INFINITY), |a, p| a.sup(p));
        let middle = if points.is_empty() { Vector3::zeros() } else { (low + high) / 2.0 };
        let plain = Self { camera, middle, scale: 1.0, origin: Pos2::ZERO };
        let mut seen = Rect::NOTHING;
        for p in points {
            seen.extend_with(plain.at(*p));
        }
        let size = if points.is_empty() { Vec2::splat(1.0) } else { seen.size().max(Vec2::splat(1e-9)) };
        let room_size = room.size().max(Vec2::splat(1.0));
        let scale = (room_size.x / size.x).min(room_size.y / size.y) * camera.zoom;
        let centre = if points.is_empty() { Vec2::ZERO } else { seen.center().to_vec2() };
        Self { scale, origin: room.center() - centre * scale, ..plain }
    }

    /// A point on the screen.
    pub fn at(&self, p: Vector3<f32>) -> Pos2 {
        let [right, up, _] = self.camera.axes();
        let d = p - self.middle;
        self.origin + vec2(right.dot(&d), -up.dot(&d)) * self.scale
    }

    /// Distance of a point in front of the middle, towards the eye, in units of length.
    pub fn depth(&self, p: Vector3<f32>) -> f32 {
        self.camera.axes()[2].dot(&(p - self.middle))
    }

    /// The ray from the eye through a point of the screen; it starts `reach` in front of the middle.
    pub fn ray(&self, at: Pos2, reach: f32) -> Ray {
        let [right, up, toward] = self.camera.axes();
        let d = (at - self.origin) / self.scale;
        Ray { start: self.middle + right * d.x - up * d.y + toward * reach, direction: -toward }
    }

    /// Columns of the matrix from space to the clip space of `viewport`: x and y from -1 to 1, depth from 0 (near) to 1 for
    /// what lies within `reach` of the middle.
    pub fn clip(&self, viewport: Rect, reach: f32) -> [[f32; 4]; 4] {
        let [right, up, toward] = self.camera.axes();
        let half = viewport.size() / 2.0;
        let shift = self.origin - viewport.center();
        let rows = [
            (right * (self.scale / half.x), shift.x / half.x),
            (up * (self.scale / half.y), -shift.y / half.y),
            (toward * (-0.5 / reach), 0.5),
        ];
        let mut columns = [[0.0; 4]; 4];
        for (k, (row, constant)) in rows.into_iter().enumerate() {
            for axis in 0..3 {
                columns[axis][k] = row[axis];
            }
            columns[3][k] = constant - row.dot(&self.middle);
        }
        columns[3][3] = 1.0;
        columns
    }
}

#[cfg(test)]
mod tests {
    use super::{Camera, Projection};
    use egui::{Pos2, Rect, pos2, vec2};
    use nalgebra::Vector3;

    const ROOM: Rect = Rect { min: pos2(100.0, 50.0), max: pos2(700.0, 450.0) };

    /// The point of a clip space on the screen; the inverse of what a graphics adapter does with [`Projection::clip`].
    fn on_screen(clip: [f32; 2], viewport: Rect) -> Pos2 {
        let half = viewport.size() / 2.0;
        pos2(viewport.center().x + clip[0] * half.x, viewport.center().y - clip[1] * half.y)
    }

    fn corners() -> Vec<Vector3<f32>> {
        (0..8).map(|k| Vector3::new((k & 1) as f32 * 3.0, ((k >> 1) & 1) as f32 * 2.0, (k >> 2) as f32)).collect()
    }

    #[test]
    fn axes_are_orthonormal_and_right_handed() {
        for k in 0..40 {
            let camera = Camera { yaw: 0.3 * k as f32, pitch: -1.5 + 0.075 * k as f32, zoom: 1.0 };
            let [r, u, t] = camera.axes();
            for (a, b) in [(r, u), (u, t), (t, r)] {
                assert!(a.dot(&b).abs() < 1e-6);
            }
            assert!((r.norm() - 1.0).abs() < 1e-6 && (u.norm() - 1.0).abs() < 1e-6);
            assert!((r.cross(&u) - t).norm() < 1e-6);
        }
    }

    #[test]
    fn everything_fits_from_every_side() {
        for k in 0..60 {
            let camera = Camera { yaw: 0.21 * k as f32, pitch: -1.4 + 0.05 * k as f32, zoom: 1.0 };
            let p = Projection::fit(&corners(), camera, ROOM);
            let seen: Vec<_> = corners().into_iter().map(|c| p.at(c)).collect();
            assert!(seen.iter().all(|s| ROOM.expand(0.01).contains(*s)), "{seen:?}");
            let tight = seen.iter().any(|s| (s.x - ROOM.left()).abs() < 0.1 || (s.y - ROOM.top()).abs() < 0.1);
            assert!(tight, "the room is used");
        }
    }

    #[test]
    fn the_matrix_for_the_adapter_and_the_projection_for_text_agree() {
        let camera = Camera { yaw: 0.7, pitch: 0.5, zoom: 1.3 };
        let p = Projection::fit(&corners(), camera, ROOM);
        let viewport = Rect::from_min_size(pos2(60.0, 10.0), vec2(720.0, 500.0));
        let m = p.clip(viewport, 5.0);
        for c in corners() {
            let clip: Vec<f32> = (0..4).map(|k| m[0][k] * c.x + m[1][k] * c.y + m[2][k] * c.z + m[3][k]).collect();
            assert!((on_screen([clip[0], clip[1]], viewport) - p.at(c)).length() < 1e-2);
            assert!((clip[2] - (0.5 - p.depth(c) / 10.0)).abs() < 1e-5 && (0.0..=1.0).contains(&clip[2]));
            assert_eq!(clip[3], 1.0);
        }
    }

    #[test]
    fn a_ray_passes_through_what_stands_under_it() {
        let p = Projection::fit(&corners(), Camera::default(), ROOM);
        for c in corners() {
            let ray = p.ray(p.at(c), 10.0);
            let along = (c - ray.start).dot(&ray.direction);
            assert!((ray.start + ray.direction * along - c).norm() < 1e-4);
            assert!((along - (10.0 - p.depth(c))).abs() < 1e-4);
        }
    }
}
