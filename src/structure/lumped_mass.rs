//! A mass on top of those of the elements.

use serde::{Deserialize, Serialize};

/// A mass added at one DOF.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LumpedMass {
    /// Label of the DOF.
    pub dof: String,
    /// Mass, kg (kg m^2 at a rotation).
    pub mass: f64,
}
