//! What fits of energies leave, and what their parameters cost.

use super::balance::Fitted;
use crate::math::statistics::bayesian_information;

/// What every parameter of a law beyond its first costs besides the information criterion: the simpler law wins unless the
/// data demand the other.
const EXTRA: f64 = 8.0;

/// Whether a squared residual is that of noise.
pub(super) fn agrees(chi_square: f64, n: usize, parameters: usize) -> bool {
    let freedom = n.saturating_sub(parameters) as f64;
    chi_square <= 1.15 * (freedom + 3.0 * (2.0 * freedom).sqrt())
}

/// Evidence of a fit to `n` energies, the smaller the better.
pub(super) fn criterion(fit: &Fitted, n: usize) -> f64 {
    let extra: usize = fit.added.iter().map(|a| a.source.parameters.len() - 1).sum();
    bayesian_information(fit.chi_square, fit.parameters, n) + EXTRA * extra as f64
}
