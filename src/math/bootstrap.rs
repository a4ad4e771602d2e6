//! Bayesian bootstrap (Rubin 1981, Annals of Statistics 9, 130): how sure a sum over groups of data is, judged by how it scatters
//! from group to group.
//!
//! ```text
//! P_i = mean over draws s of  exp(G sum_g s_g l_ig + prior_i) / sum_j exp(G sum_g s_g l_jg + prior_j),    s ~ Dirichlet(1, ..., 1)
//! ```
//!
//! `l_ig` is the logarithm of the density of group `g` under model `i`, `G` the number of groups (pseudo-BMA+, Yao, Vehtari, Simpson
//! and Gelman 2018, Bayesian Analysis 13, 917).

use super::statistics::evidence_weights;
use dashpot_numerics::dot;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Exp1};

/// Number of draws.
pub(crate) const DRAWS: usize = 1000;

/// Probabilities of models from the logarithms of their densities of the same groups of data, and of their priors.
pub(crate) fn probabilities(densities: &[Vec<f64>], priors: &[f64]) -> Vec<f64> {
    let groups = densities.first().map_or(0, Vec::len);
    let mut sums = vec![0.0; densities.len()];
    for shares in shares(groups) {
        let score = |(of, prior): (&Vec<f64>, &f64)| -2.0 * (groups as f64 * dot(of, &shares) + prior);
        let weights = evidence_weights(&densities.iter().zip(priors).map(score).collect::<Vec<f64>>());
        sums.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight / DRAWS as f64);
    }
    sums
}

/// Draws of the weights of `groups` (Dirichlet of ones), the same at every call.
pub(crate) fn shares(groups: usize) -> impl Iterator<Item = Vec<f64>> {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    (0..DRAWS).map(move |_| {
        let shares: Vec<f64> = (0..groups).map(|_| Exp1.sample(&mut random)).collect();
        let total: f64 = shares.iter().sum();
        shares.into_iter().map(|share| share / total).collect()
    })
}
