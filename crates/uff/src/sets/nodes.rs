//! Data sets 15 and 2411: nodes.

use crate::body::Body;
use crate::error::{Error, Problem};
use crate::fields::{self, Kind, Layout};

/// A node. Coordinates are in the length unit of the file.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// Label.
    pub label: i64,
    /// Coordinate system in which it is defined.
    pub definition_system: i64,
    /// Coordinate system of its displacements.
    pub displacement_system: i64,
    /// Colour.
    pub color: i64,
    /// Coordinates.
    pub position: [f64; 3],
}

impl Node {
    /// A node in the global system.
    pub fn new(label: i64, position: [f64; 3]) -> Self {
        Self { label, definition_system: 0, displacement_system: 0, color: 0, position }
    }
}

const SINGLE: Layout = Layout {
    record: "node",
    columns: &[
        ("node label", 10, Kind::Integer),
        ("definition system", 10, Kind::Integer),
        ("displacement system", 10, Kind::Integer),
        ("color", 10, Kind::Integer),
        ("x", 13, Kind::Real),
        ("y", 13, Kind::Real),
        ("z", 13, Kind::Real),
    ],
    required: 1,
};

const LABELS: Layout = Layout {
    record: "node",
    columns: &[
        ("node label", 10, Kind::Integer),
        ("definition system", 10, Kind::Integer),
        ("displacement system", 10, Kind::Integer),
        ("color", 10, Kind::Integer),
    ],
    required: 1,
};

/// Data set 15: one line a node.
pub(crate) fn read_single(body: &mut Body<'_>) -> Result<Vec<Node>, Error> {
    let mut nodes = Vec::new();
    while let Some(line) = body.line() {
        let fields = fields::read(body, line, &SINGLE)?;
        nodes.push(node(&fields, [4, 5, 6].map(|i| fields.real(i))));
    }
    Ok(nodes)
}

/// Data set 2411: two lines a node.
pub(crate) fn read_double(body: &mut Body<'_>) -> Result<Vec<Node>, Error> {
    let mut nodes = Vec::new();
    while let Some(line) = body.line() {
        let fields = fields::read(body, line, &LABELS)?;
        let position = body.reals(3)?;
        let Ok(position) = <[f64; 3]>::try_from(position.as_slice()) else {
            let problem = Problem::Short { record: "the position of a node", needed: 3, found: position.len() };
            return Err(body.error(line, problem));
        };
        nodes.push(node(&fields, position));
    }
    Ok(nodes)
}

fn node(fields: &fields::Fields, position: [f64; 3]) -> Node {
    Node {
        label: fields.integer(0),
        definition_system: fields.integer(1),
        displacement_system: fields.integer(2),
        color: fields.integer(3),
        position,
    }
}
