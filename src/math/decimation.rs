//! Low-pass filters without delay, and samples at a lower rate.
//!
//! The filter is a sinc under a Kaiser window (Oppenheim and Schafer, *Discrete-Time Signal Processing*, 2010, 7.6), 80 dB down
//! beyond its transition. Only what it covers wholly is kept, so that the ends of a signal are not guessed.

use std::f64::consts::PI;

/// Shape of the Kaiser window: 80 dB.
const BETA: f64 = 7.857;
/// Half length of the filter before samples are left out, in new steps.
const HALF: usize = 9;
/// Frequency at which it is down to one half, over the new sampling rate: noise that folds at the new Nyquist frequency fills up what
/// the filter takes from it, so that white noise stays white.
const CUT: f64 = 0.54;

/// Weights from `-half` to `half` steps, down to one half at the frequency `cut` over the sampling rate; their sum is one.
pub(crate) fn low_pass(half: usize, cut: f64) -> Vec<f64> {
    let weight = |k: usize| {
        let x = k as f64 - half as f64;
        let t = 2.0 * cut * x;
        let sinc = if x == 0.0 { 1.0 } else { (PI * t).sin() / (PI * t) };
        sinc * kaiser(BETA, x / half as f64)
    };
    let weights: Vec<f64> = (0..=2 * half).map(weight).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|w| w / sum).collect()
}

/// Numbers of the samples that [`decimated`] keeps of `count`.
pub(crate) fn kept(count: usize, factor: usize) -> impl Iterator<Item = usize> + Clone {
    let half = HALF * factor;
    (half..count.saturating_sub(half)).step_by(factor)
}

/// Every `factor`-th sample behind a filter against aliasing.
pub(crate) fn decimated(signal: &[f64], factor: usize) -> Vec<f64> {
    let half = HALF * factor;
    let weights = low_pass(half, CUT / factor as f64);
    let filtered_sample = |n: usize| weights.iter().zip(&signal[n - half..=n + half]).map(|(w, y)| w * y).sum();
    kept(signal.len(), factor).map(filtered_sample).collect()
}

/// Kaiser's window of a shape at a share of its half length, not scaled.
pub(super) fn kaiser(beta: f64, share: f64) -> f64 {
    bessel(beta * (1.0 - share * share).max(0.0).sqrt())
}

/// Modified Bessel function of the first kind, order zero.
fn bessel(x: f64) -> f64 {
    let mut term = 1.0;
    let mut sum = 1.0;
    for k in 1..60 {
        term *= (0.5 * x / f64::from(k)).powi(2);
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::runs::uniform;
    use crate::math::statistics::root_mean_square;
    use std::f64::consts::TAU;

    /// Amplitude of what is left of a sine of so many cycles a new step, against the sine itself.
    fn passed(cycles: f64, factor: usize) -> (f64, f64) {
        let sine = |n: usize| (TAU * cycles * n as f64 / factor as f64 + 0.4).sin();
        let signal: Vec<f64> = (0..400 * factor).map(sine).collect();
        let found = decimated(&signal, factor);
        let apart: Vec<f64> = kept(signal.len(), factor).zip(&found).map(|(n, y)| y - sine(n)).collect();
        (root_mean_square(&found) * f64::sqrt(2.0), root_mean_square(&apart))
    }

    #[test]
    fn sines_in_the_band_pass_and_those_that_would_fold_into_it_do_not() {
        for factor in [2, 5, 12] {
            for cycles in [0.01, 0.1, 0.3] {
                assert!(passed(cycles, factor).1 < 2e-3, "{factor} {cycles}");
            }
            assert!(passed(0.75, factor).0 < 1e-3, "{factor}");
            assert_eq!(kept(400 * factor, factor).count(), decimated(&vec![0.0; 400 * factor], factor).len());
        }
    }

    /// White noise keeps the spectrum of white noise, of a variance that is less by the factor.
    #[test]
    fn white_noise_stays_white() {
        let mut uniform = uniform(1);
        let noise: Vec<f64> = (0..160_000).map(|_| uniform() * 12.0_f64.sqrt()).collect();
        let found = decimated(&noise, 8);
        let neighbours: f64 = found.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / found.len() as f64;
        let variance = root_mean_square(&found).powi(2);
        assert!((8.0 * variance - 1.0).abs() < 0.1, "{variance}");
        assert!(neighbours.abs() < 0.05 * variance, "{neighbours} {variance}");
    }
}
