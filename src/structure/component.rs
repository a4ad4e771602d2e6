//! One component in a testing machine, say a damper: its displacement is imposed, its force measured. It has one degree of
//! freedom and no equation of motion; a mass only adds its inertia to the force.

use super::error::StructureError;
use super::points::PointParameters;
use super::system::{Structure, StructureKind};
use serde::{Deserialize, Serialize};

/// A component.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComponentParameters {
    /// Label of its degree of freedom.
    pub dof: String,
    /// Mass that moves with the force cell, kg.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub mass: f64,
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn is_zero(mass: &f64) -> bool {
    *mass == 0.0
}

impl ComponentParameters {
    /// Builds a structure of one degree of freedom without matrices.
    ///
    /// # Errors
    /// [`StructureError`] for an empty label or a mass that is negative or not finite.
    pub fn build(&self) -> Result<Structure, StructureError> {
        if !(self.mass >= 0.0 && self.mass.is_finite()) {
            return Err(StructureError::Negative { name: "mass".into(), value: self.mass, unit: "kg" });
        }
        let mut structure = PointParameters { dofs: vec![self.dof.clone()], positions: None }.build()?;
        structure.kind = StructureKind::Component;
        structure.origin.component_mass = self.mass;
        Ok(structure)
    }
}
