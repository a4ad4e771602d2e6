//! Noise from the scatter between periods.
//!
//! `d_n = r(t_n + T) - r(t_n)`, with `r` what the fit leaves and `r(t_n + T)` interpolated from its neighbours,
//! `sum_k w_k r_k`. Whatever repeats with the period drops out, harmonics above those fitted included: friction makes
//! many, and they must not pass for noise. White noise of variance `sigma^2` gives `E d_n^2 = sigma^2 (1 + sum w_k^2)`
//! exactly, so `mean d_n^2 / (1 + sum w_k^2)` is unbiased, at any time steps.

/// Samples that a value between two samples is interpolated from. Eight keep the error on harmonics below half of the
/// Nyquist frequency under a thousandth of their amplitude.
const STENCIL: usize = 8;

/// Largest sum of squared weights of an interpolation. Inside an even stencil it is at most 1; more is a gap.
const LARGEST_GAIN: f64 = 4.0;

/// Longest time between neighbours of a stencil over the median step: across gaps nothing is interpolated.
const LONGEST_STEP: f64 = 3.0;

/// Fewest differences that the noise is estimated from: its deviation is then known to about 20 %.
const FEWEST: usize = 16;

/// Largest deviation from even time steps, in steps, at which one set of weights serves all samples.
const EVEN: f64 = 1e-6;

/// Interpolation of one value: the sample it is compared with, the first sample of the stencil, and the weights.
#[derive(Debug, Clone)]
struct Entry {
    sample: usize,
    start: usize,
    weights: [f64; STENCIL],
    scale: f64,
}

/// The way to compare every sample with the one a period later.
#[derive(Debug)]
pub(super) struct Lag {
    entries: Vec<Entry>,
}

impl Lag {
    /// For samples at these times and a period in seconds; `None` where too few samples have one a period later.
    pub(super) fn new(time: &[f64], period: f64) -> Option<Self> {
        let n = time.len();
        if n < 2 * STENCIL {
            return None;
        }
        let step = (time[n - 1] - time[0]) / (n - 1) as f64;
        let even = time.iter().enumerate().all(|(i, t)| (t - time[0] - i as f64 * step).abs() <= EVEN * step);
        let entries = if even { even_entries(n, period / step) } else { uneven_entries(time, period) };
        (entries.len() >= FEWEST).then_some(Self { entries })
    }

    /// Differences over one period, each divided by `sqrt(1 + sum w^2)`, with the number of the earlier sample.
    pub(super) fn differences<'a>(&'a self, values: &'a [f64]) -> impl Iterator<Item = (usize, f64)> + 'a {
        self.entries.iter().map(|entry| {
            let later: f64 = entry.weights.iter().zip(&values[entry.start..]).map(|(w, y)| w * y).sum();
            (entry.sample, (later - values[entry.sample]) * entry.scale)
        })
    }

    /// Variance of the noise of one sample.
    pub(super) fn variance(&self, values: &[f64]) -> f64 {
        self.differences(values).map(|(_, d)| d * d).sum::<f64>() / self.entries.len() as f64
    }
}

fn entry(sample: usize, start: usize, weights: [f64; STENCIL]) -> Option<Entry> {
    let gain: f64 = weights.iter().map(|w| w * w).sum();
    (gain <= LARGEST_GAIN).then(|| Entry { sample, start, weights, scale: (1.0 + gain).sqrt().recip() })
}

/// Entries at even steps for a lag of `lag` steps.
fn even_entries(n: usize, lag: f64) -> Vec<Entry> {
    let before = STENCIL / 2 - 1;
    let whole = lag.floor() as usize;
    if whole <= before {
        return Vec::new();
    }
    let nodes: [f64; STENCIL] = std::array::from_fn(|k| k as f64 - before as f64);
    let weights = lagrange(&nodes, lag - whole as f64);
    let first = whole - before;
    (0..(n + 1).saturating_sub(first + STENCIL)).filter_map(|i| entry(i, i + first, weights)).collect()
}

/// Entries at any steps.
fn uneven_entries(time: &[f64], period: f64) -> Vec<Entry> {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    let longest = LONGEST_STEP * *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let before = STENCIL / 2 - 1;
    let mut later = 0;
    let mut entries = Vec::new();
    for (i, t) in time.iter().enumerate() {
        let target = t + period;
        while later + 1 < time.len() && time[later + 1] <= target {
            later += 1;
        }
        if later + STENCIL - before > time.len() || later + 1 == time.len() {
            break;
        }
        if later <= i + before {
            continue;
        }
        let start = later - before;
        let nodes: [f64; STENCIL] = std::array::from_fn(|k| time[start + k] - target);
        let usable = nodes.windows(2).all(|pair| pair[1] > pair[0] && pair[1] - pair[0] <= longest);
        entries.extend(usable.then(|| entry(i, start, lagrange(&nodes, 0.0))).flatten());
    }
    entries
}

/// Weights of the polynomial through values at the nodes, at `x`.
fn lagrange(nodes: &[f64; STENCIL], x: f64) -> [f64; STENCIL] {
    std::array::from_fn(|i| {
        let others = (0..STENCIL).filter(|&j| j != i);
        others.map(|j| (x - nodes[j]) / (nodes[i] - nodes[j])).product()
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn what_repeats_is_no_noise() {
        // 37.3 samples a period, even and uneven: harmonics up to the fifth drop out.
        for shake in [0.0, 0.2] {
            let time: Vec<f64> = (0..600).map(|n| f64::from(n) + shake * f64::from(n * n % 5 - 2) / 2.0).collect();
            let w = std::f64::consts::TAU / 37.3;
            let values: Vec<f64> = time.iter().map(|t| (w * t).sin() + 0.5 * (5.0 * w * t).cos()).collect();
            let lag = Lag::new(&time, 37.3).unwrap();
            assert!(lag.variance(&values).sqrt() < 2e-3, "{}", lag.variance(&values).sqrt());
        }
    }

    #[test]
    fn a_cubic_is_interpolated_exactly() {
        let nodes = [-3.0, -2.5, -1.0, 0.0, 1.5, 2.0, 3.0, 4.0];
        let weights = lagrange(&nodes, 0.7);
        let value: f64 = nodes.iter().zip(weights).map(|(x, w)| w * (x * x * x - 2.0 * x + 1.0)).sum();
        assert!((value - (0.343 - 1.4 + 1.0)).abs() < 1e-12);
    }
}
