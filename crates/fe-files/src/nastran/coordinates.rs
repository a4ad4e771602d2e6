//! Coordinate systems given by three points (`CORD2R`, `CORD2C`, `CORD2S`): origin A, a point B of the z axis, a point C of the
//! x-z plane, all in a reference system.

use super::cards::Card;
use crate::error::Problem;
use crate::number::{real, whole};
use std::collections::HashMap;

/// Deepest chain of reference systems.
const DEEPEST: usize = 100;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Rectangular,
    Cylindrical,
    Spherical,
}

#[derive(Debug, Clone, Copy)]
struct System {
    kind: Kind,
    reference: i64,
    points: [[f64; 3]; 3],
}

/// All systems of a file.
#[derive(Debug, Default)]
pub(super) struct Systems(HashMap<i64, System>);

impl Systems {
    pub(super) fn add(&mut self, card: &Card<'_>) -> Result<(), Problem> {
        let number = |k: usize| if card.field(k).is_empty() { Ok(0.0) } else { real(card.field(k)) };
        let mut points = [[0.0; 3]; 3];
        for (p, point) in points.iter_mut().enumerate() {
            for (k, value) in point.iter_mut().enumerate() {
                *value = number(2 + 3 * p + k)?;
            }
        }
        let kind = match card.name.as_str() {
            "CORD2R" => Kind::Rectangular,
            "CORD2C" => Kind::Cylindrical,
            _ => Kind::Spherical,
        };
        let reference = if card.field(1).is_empty() { 0 } else { whole(card.field(1), "a coordinate system number")? };
        self.0.insert(whole(card.field(0), "a coordinate system number")?, System { kind, reference, points });
        Ok(())
    }

    /// A position in the basic system.
    pub(super) fn basic(&self, id: i64, position: [f64; 3]) -> Result<[f64; 3], Problem> {
        self.turned(id, position, 0)
    }

    fn turned(&self, id: i64, position: [f64; 3], depth: usize) -> Result<[f64; 3], Problem> {
        if id == 0 {
            return Ok(position);
        }
        let system = self.0.get(&id).filter(|_| depth < DEEPEST).ok_or(Problem::System { id })?;
        let mut points = system.points;
        for point in &mut points {
            *point = self.turned(system.reference, *point, depth + 1)?;
        }
        let [origin, along, plane] = points;
        let z = unit(sub(along, origin)).ok_or(Problem::FlatSystem { id })?;
        let y = unit(cross(z, sub(plane, origin))).ok_or(Problem::FlatSystem { id })?;
        let x = cross(y, z);
        let local = system.kind.rectangular(position);
        Ok([0, 1, 2].map(|k| origin[k] + x[k] * local[0] + y[k] * local[1] + z[k] * local[2]))
    }
}

impl Kind {
    /// Angles are in degrees.
    fn rectangular(self, [a, b, c]: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Rectangular => [a, b, c],
            Self::Cylindrical => {
                let (sin, cos) = b.to_radians().sin_cos();
                [a * cos, a * sin, c]
            }
            Self::Spherical => {
                let ((st, ct), (sp, cp)) = (b.to_radians().sin_cos(), c.to_radians().sin_cos());
                [a * st * cp, a * st * sp, a * ct]
            }
        }
    }
}

fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    (length > 0.0).then(|| v.map(|x| x / length))
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
