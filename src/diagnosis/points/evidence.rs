//! What fits of energies leave, and what their parameters cost.

use super::balance::Fitted;
use crate::effects::Source;
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
    bayesian_information(fit.chi_square, fit.parameters, n) + extra(fit)
}

/// The part of it that parameters of laws beyond their first cost.
fn extra(fit: &Fitted) -> f64 {
    let count: usize = fit.added.iter().map(|a| a.source.parameters.len() - 1).sum();
    EXTRA * count as f64
}

/// Evidence of a fit beside the best one, of which `scale` of the squared residual is noise: that a law has more parameters counts
/// against it where it contains the best one, which then is a case of it; of two laws neither of which contains the other none is the
/// likelier for its number of parameters.
pub(super) fn beside(fit: &Fitted, best: &Fitted, n: usize, scale: f64) -> f64 {
    let contains = |a: &Source, b: &Source| a.effect.contains(b.effect) && a.place.is_same(&b.place);
    let contained = |a: &Source| best.added.iter().any(|b| a.is_same(&b.source) || contains(a, &b.source));
    let own = if fit.added.iter().all(|a| contained(&a.source)) { 0.0 } else { extra(fit) };
    criterion(fit, n) - own - fit.chi_square * (1.0 - scale.recip())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::result::Added;
    use crate::effects::{Effect, Place};

    fn fit(effect: Effect, parameters: &[f64], chi_square: f64) -> Fitted {
        let source = Source::known(effect, Place::Dofs(vec![0, 1]), parameters);
        let added = vec![Added { source, deviations: vec![0.1; parameters.len()] }];
        Fitted { added, chi_square, parameters: parameters.len(), error: 0.02, held_out: 0.02 }
    }

    /// A law that contains the best one must be asked for by the data; one of another kind is as likely as they say.
    #[test]
    fn parameters_count_against_laws_that_contain_the_best() {
        let best = fit(Effect::Viscous, &[3.0], 20.0);
        let plain = |f: &Fitted| bayesian_information(f.chi_square, f.parameters, 20);
        let maxwell = fit(Effect::Maxwell, &[1e4, 3.0], 20.0);
        assert!((beside(&maxwell, &best, 20, 1.0) - plain(&maxwell) - EXTRA).abs() < 1e-9);
        let hysteretic = fit(Effect::Hysteretic, &[3.0], 20.0);
        assert!((beside(&maxwell, &hysteretic, 20, 1.0) - plain(&maxwell)).abs() < 1e-9);
        // What even the best leaves beyond the noise counts as less.
        let own = beside(&best, &best, 20, 2.0);
        assert!((plain(&best) - own - 10.0).abs() < 1e-9);
    }
}
