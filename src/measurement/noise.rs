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

/// Differences that are enough: the noise is then known to half a per cent, better than anything that it is used for.
const ENOUGH: usize = 1 << 15;

/// Largest deviation from even time steps, in steps, at which one set of weights serves all samples.
const EVEN: f64 = 1e-6;

/// Interpolation of one value: the sample it is compared with, the first sample of the stencil, and the weights.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    sample: usize,
    start: usize,
    weights: [f64; STENCIL],
    scale: f64,
}

/// The way to compare samples with those a period later.
#[derive(Debug)]
pub(super) enum Lag {
    /// The same weights for `count` samples, `stride` apart; stencils start `shift` samples later.
    Even { count: usize, stride: usize, shift: usize, weights: [f64; STENCIL], scale: f64 },
    /// Weights of their own for every sample.
    Uneven(Vec<Entry>),
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
        if even {
            return even_lag(n, period / step);
        }
        let entries = uneven_entries(time, period);
        (entries.len() >= FEWEST).then_some(Self::Uneven(entries))
    }

    /// Calls `work` with the number of the earlier sample and the difference over one period, divided by
    /// `sqrt(1 + sum w^2)`.
    pub(super) fn each(&self, values: &[f64], mut work: impl FnMut(usize, f64)) {
        let difference = |sample: usize, start: usize, weights: &[f64; STENCIL]| {
            let later: f64 = weights.iter().zip(&values[start..start + STENCIL]).map(|(w, y)| w * y).sum();
            later - values[sample]
        };
        match self {
            Self::Even { count, stride, shift, weights, scale } => {
                for n in (0..*count).map(|n| n * stride) {
                    work(n, difference(n, n + shift, weights) * scale);
                }
            }
            Self::Uneven(entries) => {
                for entry in entries {
                    work(entry.sample, difference(entry.sample, entry.start, &entry.weights) * entry.scale);
                }
            }
        }
    }

    /// Variance of the noise of one sample.
    pub(super) fn variance(&self, values: &[f64]) -> f64 {
        let (mut squares, mut count) = (0.0, 0.0);
        self.each(values, |_, d| {
            squares += d * d;
            count += 1.0;
        });
        squares / count
    }
}

fn entry(sample: usize, start: usize, weights: [f64; STENCIL]) -> Option<Entry> {
    let gain: f64 = weights.iter().map(|w| w * w).sum();
    (gain <= LARGEST_GAIN).then(|| Entry { sample, start, weights, scale: (1.0 + gain).sqrt().recip() })
}

/// Comparison at even steps with a lag of `lag` steps.
fn even_lag(n: usize, lag: f64) -> Option<Lag> {
    let before = STENCIL / 2 - 1;
    let whole = lag.floor() as usize;
    if whole <= before {
        return None;
    }
    let nodes: [f64; STENCIL] = std::array::from_fn(|k| k as f64 - before as f64);
    let weights = lagrange(&nodes, lag - whole as f64);
    let shift = whole - before;
    let count = (n + 1).saturating_sub(shift + STENCIL);
    let stride = count.div_ceil(ENOUGH).max(1);
    let entry = entry(0, shift, weights)?;
    let count = count.div_ceil(stride);
    (count >= FEWEST).then_some(Lag::Even { count, stride, shift, weights, scale: entry.scale })
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
