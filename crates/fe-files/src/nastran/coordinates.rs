//! Coordinate systems given by three points: origin A, a point B of the z axis, a point C of the x-z plane. `CORD2R`, `CORD2C`
//! and `CORD2S` state the points in a reference system, `CORD1R`, `CORD1C` and `CORD1S` name grid points.

use super::cards::Card;
use crate::error::Problem;
use crate::number::{real, whole};
use std::collections::HashMap;

/// Deepest chain of reference systems.
const DEEPEST: usize = 100;
/// Distance from the axis, relative to that from the origin, below which angles are taken as 0.
const ON_AXIS: f64 = 1e-9;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Rectangular,
    Cylindrical,
    Spherical,
}

#[derive(Debug, Clone, Copy)]
enum Points {
    Given { reference: i64, points: [[f64; 3]; 3] },
    Grids([i64; 3]),
}

#[derive(Debug, Clone, Copy)]
struct System {
    kind: Kind,
    points: Points,
}

/// Origin and the directions x, y and z of a system, in the basic one.
#[derive(Debug, Clone, Copy)]
struct Frame {
    origin: [f64; 3],
    axes: [[f64; 3]; 3],
}

/// All systems of a file, and the positions of its grid points with the systems that they are stated in.
#[derive(Debug, Default)]
pub(super) struct Systems {
    systems: HashMap<i64, System>,
    grids: HashMap<i64, (i64, [f64; 3])>,
}

impl Systems {
    pub(super) fn add(&mut self, card: &Card<'_>) -> Result<(), Problem> {
        let number = |k: usize| if card.field(k).is_empty() { Ok(0.0) } else { real(card.field(k)) };
        let mut points = [[0.0; 3]; 3];
        for (p, point) in points.iter_mut().enumerate() {
            for (k, value) in point.iter_mut().enumerate() {
                *value = number(2 + 3 * p + k)?;
            }
        }
        let reference = if card.field(1).is_empty() { 0 } else { system(card.field(1))? };
        let given = System { kind: kind(&card.name), points: Points::Given { reference, points } };
        self.systems.insert(system(card.field(0))?, given);
        Ok(())
    }

    /// Two systems by grid points may stand on one card.
    pub(super) fn add_by_grids(&mut self, card: &Card<'_>) -> Result<(), Problem> {
        for first in [0, 4].into_iter().filter(|&first| !card.field(first).is_empty()) {
            let mut grids = [0; 3];
            for (k, grid) in grids.iter_mut().enumerate() {
                *grid = whole(card.field(first + 1 + k), "a grid point number")?;
            }
            self.systems
                .insert(system(card.field(first))?, System { kind: kind(&card.name), points: Points::Grids(grids) });
        }
        Ok(())
    }

    /// States where a grid point is; those that systems name must be there before any is asked for.
    pub(super) fn place(&mut self, grid: i64, system: i64, position: [f64; 3]) {
        self.grids.entry(grid).or_insert((system, position));
    }

    /// A position in the basic system.
    pub(super) fn basic(&self, id: i64, position: [f64; 3]) -> Result<[f64; 3], Problem> {
        self.turned(id, position, 0)
    }

    /// The directions of displacement components 1, 2 and 3 at a point of the basic system, as unit vectors in it.
    pub(super) fn directions(&self, id: i64, at: [f64; 3]) -> Result<[[f64; 3]; 3], Problem> {
        let Frame { origin, axes } = self.frame(id, 0)?;
        let kind = self.systems.get(&id).map_or(Kind::Rectangular, |system| system.kind);
        let from_origin = sub(at, origin);
        let local = axes.map(|axis| dot(axis, from_origin));
        Ok(kind.directions(local).map(|own| [0, 1, 2].map(|k| (0..3).map(|i| own[i] * axes[i][k]).sum())))
    }

    fn turned(&self, id: i64, position: [f64; 3], depth: usize) -> Result<[f64; 3], Problem> {
        if id == 0 {
            return Ok(position);
        }
        let Frame { origin, axes } = self.frame(id, depth)?;
        let kind = self.systems.get(&id).map_or(Kind::Rectangular, |system| system.kind);
        let local = kind.rectangular(position);
        Ok([0, 1, 2].map(|k| origin[k] + (0..3).map(|i| axes[i][k] * local[i]).sum::<f64>()))
    }

    fn frame(&self, id: i64, depth: usize) -> Result<Frame, Problem> {
        if id == 0 {
            return Ok(Frame { origin: [0.0; 3], axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] });
        }
        let system = self.systems.get(&id).filter(|_| depth < DEEPEST).ok_or(Problem::System { id })?;
        let mut points = [[0.0; 3]; 3];
        for (k, point) in points.iter_mut().enumerate() {
            let (reference, position) = match system.points {
                Points::Given { reference, points } => (reference, points[k]),
                Points::Grids(grids) => *self.grids.get(&grids[k]).ok_or(Problem::SystemGrid { id, grid: grids[k] })?,
            };
            *point = self.turned(reference, position, depth + 1)?;
        }
        let [origin, along, plane] = points;
        let z = unit(sub(along, origin)).ok_or(Problem::FlatSystem { id })?;
        let y = unit(cross(z, sub(plane, origin))).ok_or(Problem::FlatSystem { id })?;
        Ok(Frame { origin, axes: [cross(y, z), y, z] })
    }
}

fn system(text: &str) -> Result<i64, Problem> {
    whole(text, "a coordinate system number")
}

/// By the last letter of the card.
fn kind(card: &str) -> Kind {
    match card.chars().last() {
        Some('R') => Kind::Rectangular,
        Some('C') => Kind::Cylindrical,
        _ => Kind::Spherical,
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

    /// Unit vectors of the coordinates at a point, all in the rectangular axes of the system; on the axis the angles are 0.
    fn directions(self, [x, y, z]: [f64; 3]) -> [[f64; 3]; 3] {
        let (radius, whole) = (x.hypot(y), x.hypot(y).hypot(z));
        let (cos, sin) = if radius > ON_AXIS * whole { (x / radius, y / radius) } else { (1.0, 0.0) };
        match self {
            Self::Rectangular => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            Self::Cylindrical => [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]],
            Self::Spherical => {
                // The angle theta is counted from z.
                let (st, ct) = if whole > 0.0 { (radius / whole, z / whole) } else { (0.0, 1.0) };
                [[st * cos, st * sin, ct], [ct * cos, ct * sin, -st], [-sin, cos, 0.0]]
            }
        }
    }
}

fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(v, v).sqrt();
    (length > 0.0).then(|| v.map(|x| x / length))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
