//! A hammer test of a linear model: frequency responses by averages of hits, with their coherence.
//!
//! Each hit has the spectrum `F(f) = exp(-(f / f_c)^2)` times a strength that scatters; sensors add white noise. From `n`
//! hits H1 and the coherence, as an analyser computes them:
//!
//! ```text
//! H1 = sum conj(F) Y / sum |F|^2,   g2 = |sum conj(F) Y|^2 / (sum |F|^2 sum |Y|^2)
//! ```

use faer::c64;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Corner of the hammer's spectrum over the highest frequency: 37 % of the force is left at 1.5 times the band.
const CORNER: f64 = 1.5;
/// Standard deviation of the logarithm of a hit's strength: hits of one person scatter by a fifth.
const STRENGTH: f64 = 0.2;

/// A simulated hammer test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HammerTest {
    /// Number of hits averaged, at least 1.
    pub averages: usize,
    /// Noise of a sensor over the root mean square of its signal in the band.
    pub noise: f64,
    /// Seed; the same gives the same on every machine.
    pub seed: u64,
}

impl HammerTest {
    /// H1 and coherence of a function whose true values (per newton) are given at `frequencies_hz`; `stream` tells
    /// functions apart.
    pub(crate) fn measure(&self, frequencies_hz: &[f64], truth: &[c64], stream: u64) -> (Vec<c64>, Vec<f64>) {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(stream);
        let corner = CORNER * frequencies_hz.last().copied().unwrap_or(1.0);
        let spectrum: Vec<f64> = frequencies_hz.iter().map(|f| (-(f / corner).powi(2)).exp()).collect();
        let power: f64 = truth.iter().zip(&spectrum).map(|(h, f)| square(*h) * f * f).sum();
        let deviation = self.noise * (0.5 * power / truth.len().max(1) as f64).sqrt();
        let mut sums = vec![(c64::new(0.0, 0.0), 0.0, 0.0); truth.len()];
        for _ in 0..self.averages.max(1) {
            let strength = (STRENGTH * normal(&mut random)).exp();
            for ((sum, h), f) in sums.iter_mut().zip(truth).zip(&spectrum) {
                let noise = c64::new(normal(&mut random), normal(&mut random)) * deviation;
                let (force, response) = (f * strength, h * (f * strength) + noise);
                sum.0 += response * force;
                sum.1 += force * force;
                sum.2 += square(response);
            }
        }
        let coherence = |&(cross, force, response): &(c64, f64, f64)| {
            if response > 0.0 { (square(cross) / (force * response)).min(1.0) } else { 1.0 }
        };
        (sums.iter().map(|(cross, force, _)| cross / *force).collect(), sums.iter().map(coherence).collect())
    }
}

fn normal(random: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(random)
}

fn square(h: c64) -> f64 {
    h.re * h.re + h.im * h.im
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn averages_close_in_on_the_truth_and_coherence_says_how_far() {
        let frequencies: Vec<f64> = (1..=200).map(f64::from).collect();
        let truth: Vec<c64> = frequencies.iter().map(|f| c64::new(1.0, f / 100.0)).collect();
        let errors = |averages: usize, noise: f64| {
            let (h, g2) = HammerTest { averages, noise, seed: 4 }.measure(&frequencies, &truth, 0);
            let error = h.iter().zip(&truth).map(|(a, b)| square(a - b)).sum::<f64>() / 200.0;
            (error.sqrt(), g2.iter().sum::<f64>() / 200.0)
        };
        let (exact, one) = errors(3, 0.0);
        assert!(exact < 1e-14 && (one - 1.0).abs() < 1e-12);
        let (few, many) = (errors(4, 0.1).0, errors(64, 0.1).0);
        assert!((few / many - 4.0).abs() < 1.0, "{few} {many}");
        assert!(errors(16, 0.3).1 < errors(16, 0.1).1);
    }
}
