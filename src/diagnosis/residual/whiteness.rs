//! Whether what the model leaves is white: does it depend on frequency, level, place or harmonic?
//!
//! Whitened residuals `z` are turned by the phase of the model, `u = z conj(Y_model) / |Y_model|`, which leaves noise
//! noise but lines up what a missing effect leaves. In groups `g` of `n_g` values, were all noise of unit variance,
//!
//! ```text
//! T = sum_g |sum u|^2 / n_g  -  |sum u|^2 / n                           chi-square, 2 (G - 1) degrees of freedom
//! B = N ln(sum_g N_g q_g / N) - sum_g N_g ln q_g,  q_g = max(1, mean u^2)    Bartlett (1937), at most G - 1 of them
//! ```
//!
//! `T` sees a mean and `B` a size that changes from group to group; a residual below its noise counts as noise, so that
//! the test is never too eager. The probability is that of a larger `T + B` by chance.

use crate::math::statistics::chi_square_tail;
use faer::c64;
use std::collections::BTreeMap;

/// What a residual may depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Dependence {
    /// The frequency of the run.
    Frequency,
    /// The level of the force.
    Level,
    /// The channel.
    Place,
    /// The order of the harmonic.
    Harmonic,
}

impl Dependence {
    /// Word of files and tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::Frequency => "frequency",
            Self::Level => "level",
            Self::Place => "place",
            Self::Harmonic => "harmonic",
        }
    }
}

/// Result of one test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Whiteness {
    /// What was tested.
    pub of: Dependence,
    /// `T + B`.
    pub statistic: f64,
    /// Degrees of freedom, `3 (G - 1)`.
    pub freedom: usize,
    /// Probability that noise alone looks like that or worse.
    pub probability: f64,
}

/// One whitened residual.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Left {
    /// Numbers of its groups: frequency, level, channel, harmonic.
    pub groups: [usize; 4],
    /// Residual of unit variance a part, turned by the phase of the model.
    pub value: c64,
}

/// All tests for which there are two groups or more.
pub(crate) fn whiteness(left: &[Left]) -> Vec<Whiteness> {
    let all = [Dependence::Frequency, Dependence::Level, Dependence::Place, Dependence::Harmonic];
    all.into_iter().enumerate().filter_map(|(k, of)| test(of, left.iter().map(|l| (l.groups[k], l.value)))).collect()
}

/// Count, sum and sum of squares.
#[derive(Debug, Clone, Copy)]
struct Moments {
    count: f64,
    sum: c64,
    squares: f64,
}

impl Moments {
    const NONE: Self = Self { count: 0.0, sum: c64::new(0.0, 0.0), squares: 0.0 };

    fn add(&mut self, count: f64, sum: c64, squares: f64) {
        self.count += count;
        self.sum += sum;
        self.squares += squares;
    }

    /// `|sum|^2 / n`.
    fn mean_square(&self) -> f64 {
        self.sum.norm_sqr() / self.count
    }

    /// Number of real values.
    fn reals(&self) -> f64 {
        2.0 * self.count
    }

    /// Variance of a part, at least 1.
    fn variance(&self) -> f64 {
        (self.squares / self.reals()).max(1.0)
    }
}

fn test(of: Dependence, values: impl Iterator<Item = (usize, c64)>) -> Option<Whiteness> {
    let mut groups: BTreeMap<usize, Moments> = BTreeMap::new();
    for (group, value) in values {
        groups.entry(group).or_insert(Moments::NONE).add(1.0, value, value.norm_sqr());
    }
    if groups.len() < 2 {
        return None;
    }
    let mut all = Moments::NONE;
    groups.values().for_each(|g| all.add(g.count, g.sum, g.squares));
    let between = groups.values().map(Moments::mean_square).sum::<f64>() - all.mean_square();
    let pooled = groups.values().map(|g| g.reals() * g.variance()).sum::<f64>() / all.reals();
    let sizes = all.reals() * pooled.ln() - groups.values().map(|g| g.reals() * g.variance().ln()).sum::<f64>();
    let others = (groups.len() - 1) as f64;
    let few = groups.values().map(|g| 1.0 / g.reals()).sum::<f64>() - 1.0 / all.reals();
    let statistic = (between + sizes / (1.0 + few / (3.0 * others))).max(0.0);
    let freedom = 3 * (groups.len() - 1);
    Some(Whiteness { of, statistic, freedom, probability: chi_square_tail(statistic, freedom) })
}

/// Numbers of groups of values that differ by less than `ratio` from their neighbours in order.
pub(crate) fn numbered(values: &[f64], ratio: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut numbers = vec![0; values.len()];
    for pair in order.windows(2) {
        let apart = values[pair[1]] > values[pair[0]] * (1.0 + ratio);
        numbers[pair[1]] = numbers[pair[0]] + usize::from(apart);
    }
    numbers
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// `size(group)` times noise plus `mean(group)`, four groups of twelve.
    fn sample(seed: u64, size: impl Fn(usize) -> f64, mean: impl Fn(usize) -> f64) -> Whiteness {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        let values: Vec<(usize, c64)> =
            (0..48).map(|k| (k % 4, c64::new(normal(), normal()) * size(k % 4) + mean(k % 4))).collect();
        test(Dependence::Place, values.into_iter()).unwrap()
    }

    #[test]
    fn noise_is_seldom_called_coloured() {
        let small = (0..500).filter(|&seed| sample(seed, |_| 1.0, |_| 0.0).probability < 0.05).count();
        // The floor of the variance makes the test careful: at most the nominal 5 %, here with room for chance.
        assert!(small <= 35, "{small} of 500");
        let quiet = (0..200).filter(|&seed| sample(seed, |g| 0.1 * g as f64, |_| 0.0).probability < 0.05).count();
        assert_eq!(quiet, 0, "less than the noise is noise");
    }

    #[test]
    fn a_mean_or_a_size_of_one_group_is_seen() {
        for seed in 0..20 {
            assert!(sample(seed, |_| 1.0, |g| if g == 2 { 3.0 } else { 0.0 }).probability < 1e-3);
            assert!(sample(seed, |g| if g == 1 { 4.0 } else { 1.0 }, |_| 0.0).probability < 1e-3);
        }
    }

    #[test]
    fn groups_are_numbered_in_order() {
        assert_eq!(numbered(&[2.0, 1.0, 2.01, 4.0], 0.1), [1, 0, 1, 2]);
    }
}
