//! What a ray from the eye meets first: boxes and balls, on the processor.

use nalgebra::Vector3;

/// A half line in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub start: Vector3<f32>,
    /// Unit vector along it.
    pub direction: Vector3<f32>,
}

impl Ray {
    /// Distance at which it enters the box between two corners; `None` where it misses it. Inside, the distance is 0.
    pub fn enters_box(&self, low: Vector3<f32>, high: Vector3<f32>) -> Option<f32> {
        let (mut near, mut far) = (0.0_f32, f32::INFINITY);
        for axis in 0..3 {
            let (s, d) = (self.start[axis], self.direction[axis]);
            if d == 0.0 {
                if s < low[axis] || s > high[axis] {
                    return None;
                }
                continue;
            }
            let (a, b) = ((low[axis] - s) / d, (high[axis] - s) / d);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        (near <= far).then_some(near)
    }

    /// Distance at which it enters a ball; `None` where it misses it.
    pub fn enters_ball(&self, centre: Vector3<f32>, radius: f32) -> Option<f32> {
        let to = centre - self.start;
        let along = to.dot(&self.direction);
        let aside = to.norm_squared() - along * along;
        let half = radius * radius - aside;
        if half < 0.0 || along + half.sqrt() < 0.0 {
            return None;
        }
        Some((along - half.sqrt()).max(0.0))
    }
}

/// The index with the least distance.
pub(crate) fn nearest(distances: impl Iterator<Item = Option<f32>>) -> Option<usize> {
    distances.enumerate().filter_map(|(k, d)| Some((k, d?))).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, _)| k)
}

#[cfg(test)]
mod tests {
    use super::{Ray, nearest};
    use nalgebra::Vector3;

    fn v(x: f32, y: f32, z: f32) -> Vector3<f32> {
        Vector3::new(x, y, z)
    }

    #[test]
    fn a_ray_enters_a_box_where_it_should() {
        let (low, high) = (v(1.0, 1.0, 1.0), v(2.0, 3.0, 4.0));
        let along_x = |y: f32| Ray { start: v(-1.0, y, 2.0), direction: v(1.0, 0.0, 0.0) };
        assert_eq!(along_x(2.0).enters_box(low, high), Some(2.0));
        assert_eq!(along_x(3.5).enters_box(low, high), None);
        let back = Ray { start: v(5.0, 2.0, 2.0), direction: v(1.0, 0.0, 0.0) };
        assert_eq!(back.enters_box(low, high), None, "it lies behind");
        let inside = Ray { start: v(1.5, 2.0, 2.0), direction: v(0.0, 0.0, 1.0) };
        assert_eq!(inside.enters_box(low, high), Some(0.0));
        let slanted = Ray { start: v(0.0, 0.0, 0.0), direction: v(1.0, 1.0, 1.0).normalize() };
        let entry = slanted.enters_box(low, high).unwrap_or(f32::NAN);
        assert!((entry - 3f32.sqrt()).abs() < 1e-6);
    }

    #[test]
    fn a_ray_enters_a_ball_where_it_should() {
        let ray = Ray { start: v(0.0, 0.0, 10.0), direction: v(0.0, 0.0, -1.0) };
        assert_eq!(ray.enters_ball(v(0.0, 0.0, 0.0), 2.0), Some(8.0));
        assert_eq!(ray.enters_ball(v(3.0, 0.0, 0.0), 2.0), None);
        assert_eq!(ray.enters_ball(v(0.0, 0.0, 20.0), 2.0), None, "it lies behind");
        let grazed = ray.enters_ball(v(1.2, 0.0, 0.0), 2.0).unwrap_or(f32::NAN);
        assert!((grazed - (10.0 - 1.6)).abs() < 1e-5, "sqrt(4 - 1.44) = 1.6: {grazed}");
    }

    #[test]
    fn the_nearest_of_what_is_met_wins() {
        assert_eq!(nearest([Some(3.0), None, Some(1.0), Some(2.0)].into_iter()), Some(2));
        assert_eq!(nearest([None, None].into_iter()), None);
    }
}
