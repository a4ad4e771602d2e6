//! Small structures for the tests of the schematic.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::structure::Structure;
use crate::structure::beam::{BeamParameters, Supports};
use crate::structure::chain::ChainParameters;
use crate::structure::points::PointParameters;

/// A cantilever of `elements` elements, 1 m long.
pub(crate) fn cantilever(elements: usize) -> Structure {
    BeamParameters {
        length: 1.0,
        breadth: 0.04,
        depth: 0.004,
        youngs_modulus: 69e9,
        density: 2700.0,
        elements,
        supports: Supports::ClampedFree,
    }
    .build(&[])
    .unwrap()
}

/// Three masses, the first held to the ground.
pub(crate) fn chain() -> Structure {
    ChainParameters {
        masses: vec![1.0, 2.0, 1.0],
        ground_stiffness: vec![100.0, 0.0, 0.0],
        coupling_stiffness: vec![50.0, 80.0],
    }
    .build(&[])
    .unwrap()
}

/// Four points of a tetrahedron.
pub(crate) fn points() -> Structure {
    PointParameters {
        dofs: ["a", "b", "c", "d"].map(str::to_owned).to_vec(),
        positions: Some(vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    }
    .build()
    .unwrap()
}
