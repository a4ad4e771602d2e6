//! From measured harmonics to the energy equation `G c = e`.

pub(crate) mod action;
pub(crate) mod energy;
pub(crate) mod error;
pub mod expansion;
pub mod loops;
pub(crate) mod measured;
mod settings;
pub(crate) mod weights;
pub mod windows;

pub use energy::EnergyEquation;
pub use error::BalanceError;
pub use expansion::{Expanded, Expander};
pub use measured::Measured;
pub use settings::{Expansion, Weights};
