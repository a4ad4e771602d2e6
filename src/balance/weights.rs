//! Weights of the rows of the energy equation.
//!
//! `noise`: one over the standard deviation of `e_r - sum_j c_j G_rj` under the noise of all channels, at the present
//! coefficients: the gradients of `e` and `G` by the measured coefficients, added before they are squared, because the
//! same sensors enter both.

use super::action;
use super::energy::add_input_gradient;
use super::expansion::Expanded;
use super::measured::Measured;
use super::settings::Weights;
use crate::effects::Source;
use crate::structure::Structure;
use faer::{Mat, c64};

/// Standard deviation of the energy residual of one run, J, with `sources` at their values (known ones included).
pub(crate) fn residual_deviation(
    structure: &Structure,
    measured: &Measured,
    expanded: &Expanded,
    sources: &[Source],
) -> f64 {
    let harmonics = measured.harmonics();
    let mut by_motion = Mat::zeros(structure.len(), harmonics);
    let mut by_sensors = Mat::zeros(measured.sensors.len(), harmonics);
    let mut by_forces = Mat::zeros(measured.forces.len(), harmonics);
    add_input_gradient(measured, expanded, &mut by_motion, &mut by_sensors, &mut by_forces);
    for source in sources {
        action::add_energy_gradient(source, structure, expanded.field(measured), -1.0, &mut by_motion);
    }
    for k in 0..harmonics {
        expanded.from_sensors[k].add_adjoint(&by_motion, k, &mut by_sensors);
        expanded.from_forces[k].add_adjoint(&by_motion, k, &mut by_forces);
    }
    let variance = |gradient: &Mat<c64>, deviations: &Mat<f64>| -> f64 {
        let term = |s: usize, k: usize| gradient[(s, k)].norm_sqr() * deviations[(s, k)].powi(2);
        (0..gradient.nrows()).map(|s| (0..harmonics).map(|k| term(s, k)).sum::<f64>()).sum()
    };
    (variance(&by_sensors, &measured.sensors.deviations) + variance(&by_forces, &measured.forces.deviations)).sqrt()
}

/// Resolves `Auto`: `Noise` where deviations are known, else `Energy`.
pub(crate) fn resolve(weights: Weights, runs: &[(Measured, Expanded)]) -> Weights {
    match weights {
        Weights::Auto if runs.iter().all(|(measured, _)| measured.noisy) => Weights::Noise,
        Weights::Auto => Weights::Energy,
        other => other,
    }
}

/// Factor of each row. `e` are the input energies, J; `sources` all that act, at their values.
pub(crate) fn factors(
    weights: Weights,
    structure: &Structure,
    runs: &[(Measured, Expanded)],
    input: &[f64],
    sources: &[Source],
) -> Vec<f64> {
    match resolve(weights, runs) {
        Weights::Noise => runs
            .iter()
            .map(|(measured, expanded)| residual_deviation(structure, measured, expanded, sources))
            .map(inverse)
            .collect(),
        Weights::Energy => input.iter().map(|e| inverse(e.abs())).collect(),
        Weights::None | Weights::Auto => vec![1.0; input.len()],
    }
}

fn inverse(value: f64) -> f64 {
    if value > 0.0 { 1.0 / value } else { 1.0 }
}
