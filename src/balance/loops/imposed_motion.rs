//! Displacement that a testing machine imposes, with its derivatives: taken in the band in which it stands above its noise.
//!
//! A machine moves smoothly; its displacement fills the lowest lines of the spectrum, its noise all of them. What lies above the band is
//! taken out without delay ([`filtered`]), then the rest is differentiated by local cubics (Savitzky and Golay, *Analytical Chemistry* 36,
//! 1964).

use crate::math::statistics::median;
use crate::math::zero_phase::{Extension, filtered};
use dashpot_numerics::RealTransform;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::{LN_2, PI};

/// Lines whose mean power is held against that of the noise; the mean of 16 scatters by a quarter, of windowed ones by a third.
const LINES: usize = 16;
/// Mean power over that of the noise from which on lines hold motion; noise alone reaches it once in a hundred million.
const ABOVE: f64 = 4.0;
/// Share of the highest lines, in which the noise is sought.
const HIGHEST: f64 = 0.25;
/// Least band in multiples of the frequency at which the displacement moves, and width of its edge in bandwidths.
const HARMONICS: f64 = 10.0;
const EDGE: f64 = 0.5;

/// The band of a displacement, and its noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Band {
    /// Highest frequency at which it stands above the noise, Hz.
    pub highest_hz: f64,
    /// Standard deviation of its noise, m.
    pub noise: f64,
}

impl Band {
    /// That of a displacement, sampled every `step` seconds, that moves at `frequency_hz`.
    pub(super) fn of(d: &[f64], step: f64, frequency_hz: f64) -> Self {
        let mean = d.iter().sum::<f64>() / d.len() as f64;
        // A Hann window: what begins or ends in the midst of its motion must not leak over the noise.
        let window = |n: usize| 0.5 - 0.5 * (2.0 * PI * (n as f64 + 0.5) / d.len() as f64).cos();
        let mut work: Vec<f64> = d.iter().enumerate().map(|(n, d)| window(n) * (d - mean)).collect();
        let lines = RealTransform::new(work.len()).forward(&mut work);
        let powers: Vec<f64> = lines.iter().map(faer::c64::norm_sqr).collect();
        let from = ((1.0 - HIGHEST) * powers.len() as f64) as usize;
        // The median of what is distributed exponentially is ln 2 of its mean.
        let floor = median(&powers[from..]) / LN_2;
        let holds_motion = |part: &[f64]| part.iter().sum::<f64>() > ABOVE * floor * part.len() as f64;
        let last = powers.chunks_exact(LINES).rposition(holds_motion).unwrap_or(0);
        let line_hz = 1.0 / (d.len() as f64 * step);
        Self {
            highest_hz: (((last + 1) * LINES) as f64 * line_hz).max(HARMONICS * frequency_hz),
            // The mean of the squared window is 3 / 8.
            noise: (floor / (0.375 * d.len() as f64)).sqrt(),
        }
    }

    /// What lies in the band; it fades out above.
    pub(super) fn filtered(&self, d: &[f64], step: f64) -> Vec<f64> {
        if self.highest_hz * step >= 0.5 {
            return d.to_vec();
        }
        let gain = |hz: f64| {
            let beyond = ((hz / self.highest_hz - 1.0) / EDGE).clamp(0.0, 1.0);
            0.5 * (1.0 + (PI * beyond).cos())
        };
        // The motion goes on with its velocity beyond the ends; the line through them is passed by the filter.
        let slope = (d[d.len() - 1] - d[0]) / (d.len() - 1) as f64;
        let beside = filtered(d, step, Extension::Odd, gain);
        beside.iter().enumerate().map(|(n, y)| y + d[0] + slope * n as f64).collect()
    }

    /// One draw of the noise, in the band; the same on every machine.
    pub(super) fn drawn_noise(&self, samples: usize, step: f64) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let white: Vec<f64> =
            (0..samples).map(|_| self.noise * Distribution::<f64>::sample(&StandardNormal, &mut random)).collect();
        self.filtered(&white, step)
    }
}

/// Displacement (m), velocity (m/s) and acceleration (m/s^2) at all samples but `half` at each end.
pub(super) fn derivatives(d: &[f64], step: f64, half: usize) -> Vec<[f64; 3]> {
    d.windows(2 * half + 1).map(|samples| cubic(samples, step)).collect()
}

/// Value, slope and curvature at the middle of a cubic through samples (least squares).
fn cubic(samples: &[f64], step: f64) -> [f64; 3] {
    let half = (samples.len() / 2) as f64;
    let (mut s2, mut s4, mut s6) = (0.0, 0.0, 0.0);
    let (mut y0, mut y1, mut y2, mut y3) = (0.0, 0.0, 0.0, 0.0);
    for (n, y) in samples.iter().enumerate() {
        let x = n as f64 - half;
        let square = x * x;
        s2 += square;
        s4 += square * square;
        s6 += square * square * square;
        y0 += y;
        y1 += x * y;
        y2 += square * y;
        y3 += square * x * y;
    }
    let count = samples.len() as f64;
    let (even, odd) = (count * s4 - s2 * s2, s2 * s6 - s4 * s4);
    let offset = if even > 0.0 { (s4 * y0 - s2 * y2) / even } else { y0 / count };
    let square = if even > 0.0 { (count * y2 - s2 * y0) / even } else { 0.0 };
    let slope = if odd > 1e-9 * s2 * s6 { (s6 * y1 - s4 * y3) / odd } else { y1 / s2 };
    [offset, slope / step, 2.0 * square / (step * step)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::statistics::root_mean_square;
    use std::f64::consts::TAU;

    #[test]
    fn a_cubic_is_its_own_fit() {
        let step = 0.1;
        let polynomial = |n: i32| {
            let x = step * f64::from(n);
            2.0 - 0.5 * x + 4.0 * x.powi(2) + x.powi(3)
        };
        let samples: Vec<f64> = (-3..=3).map(polynomial).collect();
        let [value, slope, curvature] = cubic(&samples, step);
        assert!((value - 2.0).abs() < 1e-12 && (slope + 0.5).abs() < 1e-12 && (curvature - 8.0).abs() < 1e-9);
    }

    /// A swing at 2 Hz with a fifth harmonic under white noise: the noise is told, the band ends above the harmonic, and the velocity is
    /// ten times nearer to the truth than that of the noisy samples.
    #[test]
    fn what_lies_above_the_band_is_taken_out() {
        let (step, count, noise) = (1e-3, 8000, 1e-4);
        let time = |n: usize| step * n as f64;
        let angle = |n: usize| TAU * 2.0 * time(n);
        let exact: Vec<f64> = (0..count).map(|n| angle(n).sin() + 0.01 * (5.0 * angle(n)).sin()).collect();
        let velocity = |n: usize| TAU * 2.0 * (angle(n).cos() + 0.05 * (5.0 * angle(n)).cos());
        let white = Band { highest_hz: 1e9, noise }.drawn_noise(count, step);
        let d: Vec<f64> = exact.iter().zip(&white).map(|(d, e)| d + e).collect();
        let band = Band::of(&d, step, 2.0);
        assert!((band.noise / noise - 1.0).abs() < 0.1, "{}", band.noise);
        assert!((20.0..60.0).contains(&band.highest_hz), "{}", band.highest_hz);
        let error = |d: &[f64]| {
            let left = derivatives(d, step, 4).iter().zip(4..).map(|(m, n)| m[1] - velocity(n)).collect::<Vec<f64>>();
            root_mean_square(&left[500..left.len() - 500])
        };
        let (smooth, rough) = (error(&band.filtered(&d, step)), error(&d));
        assert!(smooth < 0.1 * rough, "{smooth:.1e} {rough:.1e}");
    }

    /// Samples without noise, which end in the midst of a swing, are left as they are.
    #[test]
    fn exact_samples_are_kept() {
        let d: Vec<f64> = (0..2000).map(|n| (0.01 * f64::from(n)).sin()).collect();
        let band = Band::of(&d, 1e-3, 1.6);
        let filtered = band.filtered(&d, 1e-3);
        let largest = filtered.iter().zip(&d).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(largest < 1e-4, "{largest} {band:?}");
    }
}
