//! How far every sample of a record can be trusted: the noise of its channel, and the motion above the modes that are followed.
//!
//! ```text
//! sigma_n^2 = noise^2 + max(0, <h^2>_n - noise^2 p) + (share a_n)^2
//! ```
//!
//! `h` is the signal above the corner between the last mode that is followed and the next, `<>_n` its mean over the
//! neighbourhood of sample `n`, `p` the share of the band above the corner. Modes that are not followed, the start of a filter
//! against aliasing and the contact of a hammer are no error of the model; they pass soon, and count as noise while they last.
//! `a_n` is the root mean square of the motion near sample `n`: no model has its modes' shapes, no sensor its gain, better than
//! to about a hundredth.

use crate::math::zero_phase::{Extension, filtered};

/// Share of the band up to Nyquist's frequency above the corner below which nothing can be said.
const LEAST_BAND: f64 = 0.05;
/// Half width of a neighbourhood, in periods of the corner.
const NEIGHBOURS: f64 = 2.0;

/// Share of the motion by which any model is wrong; one of a single shape, whose mass takes what its sensor and its shape are off by, is wrong
/// by less.
pub(super) const SHARE: f64 = 0.01;
pub(super) const SHARE_OF_ONE: f64 = 2e-3;

/// Root mean square of a signal over `half` samples on either side of each.
pub(super) fn local(signal: &[f64], half: usize) -> Vec<f64> {
    let n = signal.len();
    let mut sums = vec![0.0; n + 1];
    for k in 0..n {
        sums[k + 1] = sums[k] + signal[k] * signal[k];
    }
    let rms_at_sample = |k: usize| {
        let (from, to) = (k.saturating_sub(half), (k + half + 1).min(n));
        ((sums[to] - sums[from]).max(0.0) / (to - from) as f64).sqrt()
    };
    (0..n).map(rms_at_sample).collect()
}

/// Standard deviations with a `share` of the motion `signal` by which any model is wrong; `half` samples on either side.
pub(super) fn with_share(share: f64, deviations: &[f64], signal: &[f64], half: usize) -> Vec<f64> {
    deviations.iter().zip(local(signal, half)).map(|(s, a)| s.hypot(share * a)).collect()
}

/// Standard deviation of every sample of a signal: its noise and what lies above the corner.
pub(super) fn deviations(signal: &[f64], noise: f64, step: f64, corner_hz: f64) -> Vec<f64> {
    let n = signal.len();
    let above = 1.0 - 2.0 * corner_hz * step;
    if above < LEAST_BAND || n < 16 {
        return vec![noise; n];
    }
    let high = above_corner(signal, step, corner_hz);
    let half = ((NEIGHBOURS / (corner_hz * step)).ceil() as usize).clamp(2, n / 4);
    let mean = local(&high, half);
    // The mean of a few squares of noise scatters: only what is well above it is no noise.
    let scatter = 1.0 + 3.0 * (2.0 / (above * (2 * half + 1) as f64)).sqrt();
    let deviation_at_sample = |k: usize| {
        let own = mean[k].powi(2);
        let rest = if own > scatter * above * noise * noise { own - above * noise * noise } else { 0.0 };
        (noise * noise + rest).sqrt()
    };
    (0..n).map(deviation_at_sample).collect()
}

/// The part of a signal above the corner. It is extended oddly, so that neither values nor slopes jump: the motion below the corner,
/// a hundred times as large, leaves next to nothing there.
fn above_corner(signal: &[f64], step: f64, corner_hz: f64) -> Vec<f64> {
    filtered(signal, step, Extension::Odd, |hz| if hz > corner_hz { 1.0 } else { 0.0 })
}

/// The part of a signal between two frequencies; it is extended evenly, so that its ends do not jump.
pub(super) fn in_band(signal: &[f64], step: f64, [low_hz, high_hz]: [f64; 2]) -> Vec<f64> {
    filtered(signal, step, Extension::Even, |hz| if hz > low_hz && hz <= high_hz { 1.0 } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::deviations;
    use crate::common::runs::uniform;
    use std::f64::consts::TAU;

    /// A burst at 200 Hz on a sine of 20 Hz: its root mean square counts where it is, nothing elsewhere.
    #[test]
    fn what_lies_above_the_corner_counts_as_noise_where_it_is() {
        let (step, noise) = (1e-3, 1e-4);
        let burst_on_sine = |n: usize| {
            let t = n as f64 * step;
            let burst = if (400..600).contains(&n) { 0.1 * (TAU * 200.0 * t).sin() } else { 0.0 };
            (TAU * 20.0 * t).sin() + burst
        };
        let signal: Vec<f64> = (0..1000).map(burst_on_sine).collect();
        let sigma = deviations(&signal, noise, step, 60.0);
        assert!((sigma[500] / (0.1 / 2.0_f64.sqrt()) - 1.0).abs() < 0.1, "{}", sigma[500]);
        assert!(sigma[200] < 0.01 && sigma[800] < 0.01, "{} {}", sigma[200], sigma[800]);
    }

    /// A decay that neither begins nor ends at rest has nothing above twice its frequency: its ends are no burst.
    #[test]
    fn a_slow_motion_leaves_nothing_above_the_corner() {
        let (step, noise) = (1e-3, 1e-6);
        let decay = |n: usize| {
            let t = n as f64 * step;
            (-0.2 * t).exp() * (TAU * 5.0 * t + 0.6).cos()
        };
        let signal: Vec<f64> = (0..4000).map(decay).collect();
        let sigma = deviations(&signal, noise, step, 10.0);
        let mean = (sigma.iter().map(|s| s * s).sum::<f64>() / sigma.len() as f64).sqrt();
        assert!(mean < 0.01, "{mean}");
        assert!(sigma[2000] < 2e-3, "{}", sigma[2000]);
    }

    /// White noise stays what it is.
    #[test]
    fn noise_is_not_counted_twice() {
        let mut uniform = uniform(1);
        let signal: Vec<f64> = (0..4000).map(|_| uniform() * 12.0_f64.sqrt()).collect();
        let sigma = deviations(&signal, 1.0, 1e-3, 100.0);
        let mean = sigma.iter().sum::<f64>() / sigma.len() as f64;
        assert!((mean - 1.0).abs() < 0.03, "{mean}");
    }
}
