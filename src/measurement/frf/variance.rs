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
//! variance (`1 + 9 + 9 + 1`), a smooth curve leaves next to nothing; the median is not led astray by sharp resonances. Noise in proportion
//! to the response, as hits that differ leave it, is a share of the modulus that lines on the flanks of resonances tell, where these scatter
//! more than the lines around them: at narrow crests, where it is largest, too few lines lie.

use faer::c64;

/// Lines on either side over which the noise is averaged: single coherences of few averages scatter widely.
const NEIGHBOURS: usize = 3;
/// Lines on either side over which the scatter is judged.
const WINDOW: usize = 24;
/// Orders of the differences that tell noise in proportion to the response, the least of which is taken: the curve near a resonance is in
/// each of them another way.
const ORDERS: [usize; 3] = [3, 5, 7];
/// How many times the squared response around it that of a line is which tells noise in proportion to it, and the fewest such lines.
const LARGER: f64 = 2.0;
const FEWEST: usize = 16;
/// Lines on either side of a crest whose curve is no scatter, and how many times their squared response a crest is then.
const CREST: usize = 6;
const STEEP: f64 = 2.0;
/// Most of it: a test whose hits differ by more than 5 % is none, and the curve of modes between few lines may be more.
const MOST_SHARE: f64 = 0.0025;
/// Deviations by which lines of large response scatter more than those around them.
const CERTAIN: f64 = 2.0;
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

/// Variance of the real part (and of the imaginary part) of each value, from the scatter about a smooth curve: the greater of what lines
/// nearby scatter by and the `share` of its squared modulus.
pub(crate) fn from_scatter(values: &[c64], share: f64) -> Vec<f64> {
    let (squares, _) = differences(values, 3);
    if squares.is_empty() {
        return vec![0.0; values.len()];
    }
    let around = |i: usize| {
        let from = i.saturating_sub(WINDOW).min(squares.len() - 1);
        0.5 * median(squares[from..(i + WINDOW + 1).min(squares.len())].to_vec()) / MEDIAN_OVER_MEAN
    };
    (0..values.len()).map(|i| around(i).max(0.5 * share * values[i].norm_sqr())).collect()
}

/// Squared modulus of the noise over that of the values where it is in proportion to them in all `functions`; 0 where lines that are larger
/// than those around them scatter no more, so that it is noise that is alike nearby.
pub(crate) fn noise_share(functions: &[&[c64]]) -> f64 {
    ORDERS.into_iter().map(|order| share_by_order(functions, order)).fold(f64::INFINITY, f64::min)
}

/// The same from differences of this order.
fn share_by_order(functions: &[&[c64]], order: usize) -> f64 {
    let (mut beyond, mut shares) = (Vec::new(), Vec::new());
    for values in functions {
        let (squares, sizes) = differences(values, order);
        let lines = squares.len();
        let around =
            |list: &[f64], i: usize| median(list[i.saturating_sub(WINDOW)..(i + WINDOW + 1).min(lines)].to_vec());
        let mut curved = vec![false; lines];
        for k in (CREST..lines.saturating_sub(CREST)).filter(|&k| is_crest(&sizes, k)) {
            curved[k - CREST..=k + CREST].fill(true);
        }
        for i in (0..lines).filter(|&i| sizes[i] > LARGER * around(&sizes, i) && !curved[i]) {
            beyond.push(squares[i] / around(&squares, i));
            shares.push(squares[i] / MEDIAN_OVER_MEAN / sizes[i]);
        }
    }
    // A median of so many squares of noise scatters by its own size over the root of their number, neighbours having values in common.
    let scatter = ((order + 1) as f64 / shares.len() as f64).sqrt() / MEDIAN_OVER_MEAN;
    if shares.len() < FEWEST || median(beyond) < 1.0 + CERTAIN * scatter { 0.0 } else { median(shares).min(MOST_SHARE) }
}

/// Whether line `k` is the crest of a resonance so narrow that the curve of the few lines beside it is no scatter.
fn is_crest(sizes: &[f64], k: usize) -> bool {
    let largest = sizes[k - CREST..=k + CREST].iter().all(|size| *size <= sizes[k]);
    largest && [k - CREST, k + CREST].iter().all(|&end| STEEP * sizes[end] < sizes[k])
}

/// Squared moduli of the differences of this order, over the factor by which noise that is independent from line to line is in them, and
/// the mean squared moduli of the values in each, weighted as their noise is.
fn differences(values: &[c64], order: usize) -> (Vec<f64>, Vec<f64>) {
    let mut weights = vec![1.0];
    for k in 0..order {
        weights.push(-weights[k] * (order - k) as f64 / (k + 1) as f64);
    }
    let all: f64 = weights.iter().map(|w| w * w).sum();
    let difference_of = |h: &[c64]| {
        let difference: c64 = h.iter().zip(&weights).map(|(h, w)| *h * *w).sum();
        let size: f64 = h.iter().zip(&weights).map(|(h, w)| w * w * h.norm_sqr()).sum();
        (difference.norm_sqr() / all, size / all)
    };
    values.windows(order + 1).map(difference_of).unzip()
}

fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
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
        let variances = from_scatter(&values, noise_share(&[&values]));
        let mean = variances.iter().sum::<f64>() / variances.len() as f64;
        assert!((mean / (noise * noise) - 1.0).abs() < 0.25, "{}", mean / (noise * noise));
        let largest = variances.iter().copied().fold(0.0, f64::max);
        assert!(largest < 4.0 * noise * noise, "{}", largest / (noise * noise));
        assert_eq!(from_scatter(&values[..3], noise_share(&[&values[..3]])), [0.0; 3]);
    }

    #[test]
    fn scatter_in_proportion_to_the_response_is_told_at_the_crest_too() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let response = |i: i32| {
            let ratio = f64::from(i) / 300.0;
            c64::new(1.0, 0.0) / c64::new(1.0 - ratio * ratio, 0.05 * ratio)
        };
        let share = 0.01;
        let mut noisy = |i: i32| response(i) * (c64::new(1.0, 0.0) + gauss(&mut random) * share);
        let sensors: Vec<Vec<c64>> = (0..6).map(|_| (0..600).map(&mut noisy).collect()).collect();
        let told = noise_share(&sensors.iter().map(Vec::as_slice).collect::<Vec<_>>());
        let crest = from_scatter(&sensors[0], told)[300].sqrt() / response(300).norm();
        assert!((crest / share - 1.0).abs() < 0.3, "{crest}");
        // Without noise the few lines of a crest are no noise.
        let exact: Vec<c64> = (0..600).map(response).collect();
        let crest = from_scatter(&exact, noise_share(&[&exact]))[300].sqrt() / response(300).norm();
        assert!(crest < 0.1 * share, "{crest}");
    }
}
