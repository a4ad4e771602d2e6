//! From measured harmonics to the energy equation `G c = e`.

pub mod action;
pub mod energy;
pub mod error;
pub mod expansion;
pub mod loops;
pub mod measured;
mod settings;
pub mod weights;
pub mod windows;

pub use energy::EnergyEquation;
pub use error::BalanceError;
pub use expansion::{Expanded, Expander};
pub use measured::Measured;
pub use settings::{Expansion, Weights};
