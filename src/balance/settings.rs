//! What is chosen for an energy equation: expansion and weights.

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
