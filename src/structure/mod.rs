//! Mass, stiffness and geometry of what vibrates, and its modes.

mod assemble;
mod base;
pub mod beam;
pub mod chain;
pub mod component;
mod coupling;
pub mod damped_modes;
mod elastic_supports;
mod error;
pub(crate) mod factors;
mod geometry;
pub mod imported;
pub(crate) mod lowest_modes;
mod lumped_mass;
mod matrices;
mod modal_stiffness;
pub mod mode_damping;
pub mod modes;
mod pencil;
pub mod points;
pub(crate) mod reduction;
pub(crate) mod share;
mod system;
pub mod wing;

pub use assemble::MOST_DOFS;
pub use coupling::Coupled;
pub use error::StructureError;
pub(crate) use error::nearest;
pub use geometry::{Direction, Dof, Node};
pub use lumped_mass::LumpedMass;
pub use matrices::{Element, SystemMatrices};
pub use modal_stiffness::ModalStiffness;
pub use mode_damping::DampingOfMode;
pub use share::{HeldDof, Part};
pub use system::{Origin, Structure, StructureKind, TurnedNode};
