//! How certain a measured frequency response is.
//!
//! From the coherence `g2` of `n` averages (H1 estimator, noise on the response): the regression of the response on the
//! force leaves `n S_yy (1 - g2)` of the response's power in `n - 1` complex degrees of freedom, so that the real and the
//! imaginary part of `H` each have the variance
//!
//! ```text
//! v = (1 - g2) / (2 (n - 1) g2) |H|^2
//! ```
//!
//! J. S. Bendat and A. G. Piersol, *Random Data*, 4th edition, (9.89), give it for large `n`, where `n - 1` is `n`.
//! From the scatter: noise that is independent from line to line leaves the third difference of `H` with 20 times its
//! variance (`1 + 9 + 9 + 1`), a smooth curve leaves next to nothing; the median is not led astray by sharp resonances.

use faer::c64;

/// Lines on either side over which the noise is averaged: single coherences of few averages scatter widely.
const NEIGHBOURS: usize = 3;
/// Lines on either side over which the scatter is judged.
const WINDOW: usize = 24;
/// Median over mean of the squared modulus of complex Gaussian noise.
const MEDIAN_OVER_MEAN: f64 = std::f64::consts::LN_2;
/// Coherence below which nothing is taken as known of a line.
const LEAST_COHERENCE: f64 = 1e-6;

/// Variance of the real part (and of the imaginary part) of each value, from its coherence over `averages` averages.
pub(crate) fn from_coherence(values: &[c64], coherence: &[f64], averages: usize) -> Vec<f64> {
    let freedom = 2.0 * (averages.max(2) - 1) as f64;
    let raw: Vec<f64> = values
        .iter()
        .zip(coherence)
        .map(|(h, g2)| {
            let g2 = g2.clamp(LEAST_COHERENCE, 1.0);
            (1.0 - g2) / (freedom * g2) * (h.re * h.re + h.im * h.im)
        })
        .collect();
    let around = |i: usize| {
        let part = &raw[i.saturating_sub(NEIGHBOURS)..(i + NEIGHBOURS + 1).min(raw.len())];
        part.iter().sum::<f64>() / part.len() as f64
    };
    (0..raw.len()).map(around).collect()
}

/// Variance of the real part (and of the imaginary part) of each value, from the scatter about a smooth curve.
pub(crate) fn from_scatter(values: &[c64]) -> Vec<f64> {
    const OF_DIFFERENCE: f64 = 20.0;
    let squares: Vec<f64> = values
        .windows(4)
        .map(|h| {
            let third = (h[3] - h[0]) - (h[2] - h[1]) * 3.0;
            third.re * third.re + third.im * third.im
        })
        .collect();
    if squares.is_empty() {
        return vec![0.0; values.len()];
    }
    let around = |i: usize| {
        let from = i.saturating_sub(WINDOW).min(squares.len() - 1);
        let mut part = squares[from..(i + WINDOW + 1).min(squares.len())].to_vec();
        let middle = part.len() / 2;
        let median = *part.select_nth_unstable_by(middle, f64::total_cmp).1;
        0.5 * median / MEDIAN_OVER_MEAN / OF_DIFFERENCE
    };
    (0..values.len()).map(around).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    fn gauss(random: &mut ChaCha8Rng) -> c64 {
        c64::new(StandardNormal.sample(random), StandardNormal.sample(random))
    }

    /// H1 and coherence of `averages` hits on a system `h` with noise of standard deviation `noise` on the response.
    fn hammered(h: c64, noise: f64, averages: usize, random: &mut ChaCha8Rng) -> (c64, f64) {
        let (mut cross, mut force, mut response) = (c64::new(0.0, 0.0), 0.0, 0.0);
        for _ in 0..averages {
            let x = gauss(random) + c64::new(3.0, 0.0);
            let y = h * x + gauss(random) * noise;
            cross += x.conj() * y;
            force += x.re * x.re + x.im * x.im;
            response += y.re * y.re + y.im * y.im;
        }
        let h1 = cross / force;
        (h1, (cross.re * cross.re + cross.im * cross.im) / (force * response))
    }

    #[test]
    fn coherence_gives_the_scatter_of_simulated_averages() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let truth = c64::new(0.6, -1.1);
        for (averages, noise) in [(4, 0.5), (10, 1.5), (50, 0.1)] {
            let trials = 4000;
            let (mut scatter, mut stated) = (0.0, 0.0);
            for _ in 0..trials {
                let (h, g2) = hammered(truth, noise, averages, &mut random);
                scatter += (h - truth).re.powi(2) + (h - truth).im.powi(2);
                stated += from_coherence(&[h], &[g2], averages)[0];
            }
            // The scatter holds both parts, the stated variance is that of one; the mean of trials is good to some 3 %.
            let ratio = stated / (0.5 * scatter);
            assert!((ratio - 1.0).abs() < 0.08, "{averages} averages, noise {noise}: {ratio}");
        }
    }

    #[test]
    fn scatter_gives_the_noise_and_is_blind_to_resonances() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let noise = 0.01;
        let values: Vec<c64> = (0..800)
            .map(|i| {
                let ratio = f64::from(i) / 400.0;
                c64::new(1.0, 0.0) / c64::new(1.0 - ratio * ratio, 0.02 * ratio) + gauss(&mut random) * noise
            })
            .collect();
        let variances = from_scatter(&values);
        let mean = variances.iter().sum::<f64>() / variances.len() as f64;
        assert!((mean / (noise * noise) - 1.0).abs() < 0.25, "{}", mean / (noise * noise));
        let largest = variances.iter().copied().fold(0.0, f64::max);
        assert!(largest < 4.0 * noise * noise, "{}", largest / (noise * noise));
        assert_eq!(from_scatter(&values[..3]), [0.0; 3]);
    }
}
