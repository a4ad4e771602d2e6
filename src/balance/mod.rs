//! From measured harmonics to the energy equation `G c = e`.

pub mod action;
pub mod energy;
pub mod error;
pub mod expansion;
pub mod loops;
pub mod measured;
pub mod weights;
pub mod windows;

pub use energy::EnergyEquation;
pub use error::BalanceError;
pub use expansion::{Expanded, Expander};
pub use measured::Measured;

use serde::{Deserialize, Serialize};

/// How the sensors' harmonics are expanded to every DOF.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Expansion {
    /// `dynamic` with mass and stiffness, else `none`.
    #[default]
    Auto,
    /// What is measured is all that is asked for.
    None,
    /// The mode nearest to the run's frequency (4.23-4.31).
    SingleMode,
    /// Least squares on the in-band mode shapes.
    Modes,
    /// Minimum dynamic residual, iterated with the identified damping.
    Dynamic,
}

/// Weights of the rows of the energy equation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Weights {
    /// `noise` where deviations are known, else `energy`.
    #[default]
    Auto,
    /// None, as in the thesis.
    None,
    /// Each row divided by its input energy.
    Energy,
    /// Each row divided by the standard deviation of its residual.
    Noise,
}
