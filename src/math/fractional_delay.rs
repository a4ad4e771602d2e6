//! Signals between their samples: a sinc under a Kaiser window (Laakso, Valimaki, Karjalainen and Laine, "Splitting the unit delay", IEEE
//! Signal Processing Magazine 13, 1996), which is good to two fifths of the sampling rate; near the ends, where it would need samples that
//! nobody took, the polynomial through the last of them.

use super::decimation::kaiser;
use std::borrow::Cow;
use std::f64::consts::PI;

/// Samples of the sinc on either side, and the shape of the window: 118 dB.
const HALF: usize = 24;
const BETA: f64 = 12.0;
/// Points of the polynomial.
const POINTS: usize = 6;

/// `y(n + shift)` between the samples; beyond the ends the last polynomial goes on for no more than the shift.
pub(crate) fn shifted(samples: &[f64], shift: f64) -> Cow<'_, [f64]> {
    if shift == 0.0 || samples.is_empty() {
        return Cow::Borrowed(samples);
    }
    let (whole, weights) = (shift.floor(), weights(shift - shift.floor()));
    let sample = |n: usize| {
        // Far beyond the ends is no sample, whatever the shift.
        let first = n as f64 + whole - (HALF - 1) as f64;
        if first < 0.0 || first + weights.len() as f64 > samples.len() as f64 {
            return by_polynomial(samples, n as f64 + shift);
        }
        weights.iter().zip(&samples[first as usize..]).map(|(w, y)| w * y).sum()
    };
    Cow::Owned((0..samples.len()).map(sample).collect())
}

/// Weights of the samples about one that is a `part` of a step later, from `HALF - 1` samples before it to `HALF` behind; their sum is one.
fn weights(part: f64) -> Vec<f64> {
    let weight = |k: usize| {
        let x = k as f64 - (HALF - 1) as f64 - part;
        let sinc = if x == 0.0 { 1.0 } else { (PI * x).sin() / (PI * x) };
        sinc * kaiser(BETA, x / HALF as f64)
    };
    let weights: Vec<f64> = (0..2 * HALF).map(weight).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|w| w / sum).collect()
}

/// Value at the sample `at` of the polynomial through the samples about it.
fn by_polynomial(samples: &[f64], at: f64) -> f64 {
    let last = samples.len() - 1;
    let x = at.clamp(0.0, last as f64);
    let first = (x.floor() as usize).saturating_sub(POINTS / 2 - 1).min((last + 1).saturating_sub(POINTS));
    let points = first..(first + POINTS).min(last + 1);
    let weight =
        |i: usize| points.clone().filter(|&j| j != i).map(|j| (x - j as f64) / (i as f64 - j as f64)).product::<f64>();
    points.clone().map(|i| weight(i) * samples[i]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Sines of up to two fifths of the sampling rate come out where they were, a whole number of steps to the sample.
    #[test]
    fn sines_are_shifted_as_they_are_between_their_samples() {
        for cycles in [0.01, 0.1, 0.25, 0.33, 0.4] {
            let wave = |t: f64| (TAU * cycles * t + 0.4).sin();
            let samples: Vec<f64> = (0..400).map(|n| wave(f64::from(n))).collect();
            for shift in [0.5, -0.3, 2.8, -7.0] {
                let found = shifted(&samples, shift);
                let worst = (40..360).map(|n| (found[n] - wave(n as f64 + shift)).abs()).fold(0.0, f64::max);
                assert!(worst < 1e-3, "{cycles} {shift}: {worst}");
            }
        }
    }

    /// A slow decay is followed to its very first sample, and a shift by more than there is leaves its ends.
    #[test]
    fn ends_go_on_as_they_were() {
        let wave = |t: f64| (-0.01 * t).exp() * (0.05 * t).cos();
        let samples: Vec<f64> = (0..200).map(|n| wave(f64::from(n))).collect();
        let found = shifted(&samples, 0.4);
        assert!((0..199).all(|n| (found[n] - wave(n as f64 + 0.4)).abs() < 1e-5));
        assert!(shifted(&samples, 1e6).iter().all(|y| *y == samples[199]));
        assert!(shifted(&[3.0], -0.5).iter().all(|y| *y == 3.0) && shifted(&[], 0.5).is_empty());
    }
}
