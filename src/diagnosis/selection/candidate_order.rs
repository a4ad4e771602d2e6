//! The order of candidates that have models of their own, and their probabilities by how well they predict runs that are left out.

use super::cross_validation::exceeds;
use super::short_list::VOID;
use crate::diagnosis::candidates::special_cases::is_limit;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::effects::Source;
use crate::math::bootstrap::probabilities;

/// A candidate with the model that was updated beside it.
pub(super) struct Candidate<'a> {
    /// Its evidence, the smaller the better.
    pub cost: f64,
    pub reference: ReferenceModel<'a>,
    pub fit: FittedModel,
    /// Logarithms of its predictive densities of groups of runs that are left out.
    pub densities: Vec<f64>,
}

/// Squared residual per datum that is no noise.
pub(super) const COARSE: f64 = 3.0;
/// Share of the error of the first that another leaves where it comes before it.
const NEARER: f64 = 0.4;
/// Difference of the logarithms of predictive densities, summed over the groups, below which two laws say the same.
const SAME: f64 = 0.5;

/// Puts the simplest law first that the best contains as a limit, unless the best predicts runs that are left out better than it
/// by more than may be by chance.
pub(super) fn simplest_first(all: &mut [Candidate]) {
    while let Some(best) = all.first() {
        let simpler = |c: &Candidate| {
            c.fit.parameters < best.fit.parameters
                && is_limit(&c.fit.effects, &best.fit.effects)
                && !exceeds(&best.densities, &c.densities)
        };
        let Some(k) = all.iter().position(simpler) else { break };
        all[..=k].rotate_right(1);
    }
}

/// Puts the candidate first that comes nearest to the measurement, where what the first leaves is no noise. Returns the squared residual
/// per datum in units of which predictions are weighed: one, but of what is no noise all that the first leaves.
pub(super) fn nearest_first(all: &mut [Candidate]) -> f64 {
    let Some(first) = all.first() else { return 1.0 };
    let left = first.fit.chi_square / first.reference.count() as f64;
    let errors: Vec<f64> = all.iter().map(|c| c.fit.error).collect();
    let Some(k) = nearer(left, &errors) else { return 1.0 };
    all[..=k].rotate_right(1);
    left
}

/// Which of candidates with these errors, as `compare` shows them, comes before the first, which leaves so much of the squared residual
/// per datum. What is an error of the model is weighed by evidence as if it were noise: with all scales at their bounds, corrections and
/// what is free from run to run make any law fit.
fn nearer(left: f64, errors: &[f64]) -> Option<usize> {
    let first = errors.first().filter(|_| left > COARSE)?;
    let nearest = (1..errors.len()).min_by(|&a, &b| errors[a].total_cmp(&errors[b]))?;
    (errors[nearest] < NEARER * first).then_some(nearest)
}

/// Probability of each candidate: by how it predicts, and by the share of what its parameters might have been that explains the
/// data. A neighbour of the first that predicts as well shares with it, the less the more closely its parameters had to be
/// chosen; what contains the first and predicts the same, or has a parameter that the data do not know, is the first by another
/// name. Logarithms of densities count in units of `unit`.
fn probabilities_of(all: &[Candidate], unit: f64) -> Vec<f64> {
    let in_units = |c: &Candidate| c.densities.iter().map(|density| density / unit).collect();
    let densities: Vec<Vec<f64>> = all.iter().map(in_units).collect();
    let prior = |c: &Candidate| c.fit.descent.log_volume() - 0.5 * ReferenceModel::cost_beside_simpler(&c.fit);
    let mut list = probabilities(&densities, &all.iter().map(prior).collect::<Vec<f64>>());
    let Some(first) = all.first() else { return list };
    let differ = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f64>();
    for (k, other) in all.iter().enumerate().skip(1) {
        let open = || other.fit.effects.iter().zip(&other.fit.deviations).any(|(e, d)| is_open(d, e));
        let same = || open() || differ(&first.densities, &other.densities) < SAME;
        if is_limit(&first.fit.effects, &other.fit.effects) && same() {
            list[0] += std::mem::take(&mut list[k]);
        }
    }
    list
}

/// Puts the likeliest first and gives the probability of each.
pub(super) fn likeliest_first(all: &mut [Candidate], unit: f64) -> Vec<f64> {
    let mut list = probabilities_of(all, unit);
    let is_rule = |k: usize| unit != 1.0 || is_limit(&all[0].fit.effects, &all[k].fit.effects);
    let Some(k) = shared(&mut list, is_rule) else { return list };
    all[..=k].rotate_right(1);
    probabilities_of(all, unit)
}

/// Which of candidates with these probabilities comes before the first because it is likelier. Those that the first comes before by a
/// rule, for it is simpler or nearer to the measurement, are no likelier than it: they share alike.
fn shared(list: &mut [f64], is_rule: impl Fn(usize) -> bool) -> Option<usize> {
    while let Some(k) = (1..list.len()).filter(|&k| list[k] > list[0]).max_by(|&a, &b| list[a].total_cmp(&list[b])) {
        if !is_rule(k) {
            return Some(k);
        }
        let mean = 0.5 * (list[0] + list[k]);
        (list[0], list[k]) = (mean, mean);
    }
    None
}

/// Whether an effect has a parameter that the data do not know, which may as well be at a limit.
pub(super) fn is_open(deviations: &[f64], source: &Source) -> bool {
    source.parameters.iter().zip(deviations).any(|(p, d)| d.is_nan() || *d >= VOID * p.abs())
}

#[cfg(test)]
mod tests {
    use super::{nearer, shared};

    #[test]
    fn evidence_orders_what_leaves_noise_and_the_error_what_leaves_more() {
        let errors = [0.6, 0.09, 0.16];
        assert_eq!(nearer(1.2, &errors), None);
        assert_eq!(nearer(40.0, &errors), Some(1));
        assert_eq!(nearer(40.0, &[0.6, 0.3]), None);
        assert_eq!(nearer(40.0, &[0.6]), None);
    }

    /// A likelier candidate comes first, but no wider law before a simpler one that does as well: they are equally likely.
    #[test]
    fn the_likeliest_comes_first_unless_a_rule_keeps_it_behind() {
        let by_rule = |mut list: Vec<f64>, kept: bool| (shared(&mut list, |_| kept), list);
        assert_eq!(by_rule(vec![0.5, 0.3, 0.2], false), (None, vec![0.5, 0.3, 0.2]));
        assert_eq!(by_rule(vec![0.25, 0.125, 0.625], false), (Some(2), vec![0.25, 0.125, 0.625]));
        assert_eq!(by_rule(vec![0.25, 0.0, 0.75], true), (None, vec![0.5, 0.0, 0.5]));
        assert_eq!(by_rule(vec![0.0, 0.5, 0.5], true).1[0], 0.375);
    }
}
