//! What is shown of the accepted set: matrices, energy shares, damped modes.

mod input;
pub(crate) mod matrices;
pub(crate) mod modes;
pub(crate) mod shares;

use faer::Mat;

pub(crate) use input::ResultsInput;
pub(crate) use matrices::{EquivalentViscous, LawMatrix};
pub(crate) use modes::ModeResult;

/// Results of the accepted set with the known sources.
#[derive(Debug, Clone, PartialEq)]
pub struct Results {
    /// Identified viscous damping matrix, n x n, N s/m.
    pub viscous: Mat<f64>,
    /// One matrix for each other law: its coefficient times `sum L L^T` (or the structure's matrix).
    pub others: Vec<LawMatrix>,
    /// Viscous coefficients that take out as much energy as each acting source.
    pub equivalent: EquivalentViscous,
    /// Energy-equivalent viscous matrix over all runs, n x n, N s/m.
    pub equivalent_viscous: Mat<f64>,
    /// Share of all dissipated energy at each DOF, per cent; adds up to 100.
    pub energy_percent: Vec<f64>,
    /// Damped modes (above 600 DOFs those in the band of the runs); empty without mass and stiffness.
    pub modes: Vec<ModeResult>,
}

/// Computes all results.
pub(crate) fn results(input: &ResultsInput<'_>) -> Results {
    let equivalent = matrices::equivalent(input.structure, input.runs, input.acting);
    let equivalent_viscous = matrices::weighted_sum(input.structure, input.acting, &equivalent.overall);
    Results {
        viscous: matrices::viscous(input.structure, input.acting),
        others: matrices::others(input.structure, input.acting),
        energy_percent: shares::by_dof(input.structure, input.runs, input.acting),
        modes: modes::damped(input, &equivalent),
        equivalent,
        equivalent_viscous,
    }
}
