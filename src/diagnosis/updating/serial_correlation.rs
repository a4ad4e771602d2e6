//! Whether what differs from run to run follows the amplitude: then it is no scatter, but a law that the model lacks.
//!
//! Joints that are seated anew and temperature shift the stiffness of each run by chance. In order of the amplitude of the motion let
//! `a_i` be the shifts less their median, by the rank of their size and with their sign (Wilcoxon). Their signs being by chance, whatever
//! their sizes are (runs of which the data say little have small ones),
//!
//! ```text
//! z = sum a_i a_{i+1} / sqrt(sum (a_i a_{i+1})^2)          N(0, 1)
//! ```
//!
//! and larger where neighbours are alike.

use super::parameters::Updating;
use crate::diagnosis::residual::data::{ChannelData, Data, RunData};
use crate::math::nnls::norm;
use crate::math::statistics::{median, normal_cdf};

/// Fewest runs of which it is asked.
const FEWEST: usize = 8;

/// Evidence against the shifts of the runs being scatter, `-2 ln p` with the probability `p` that shifts by chance follow the amplitude
/// as much; none of few runs, or where all are alike.
pub(crate) fn evidence_against_scatter(updating: &Updating, data: &Data) -> f64 {
    let mut runs: Vec<(f64, f64)> =
        data.runs.iter().enumerate().map(|(r, run)| (amplitude(run), updating.shift(r))).collect();
    runs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let shifts: Vec<f64> = runs.into_iter().map(|(_, shift)| shift).collect();
    -2.0 * probability_of_likeness(&shifts).ln()
}

/// Amplitude of the motion at the fundamental, all displacements together, m or rad.
fn amplitude(run: &RunData) -> f64 {
    let displacement =
        |response: &ChannelData| response.measured[0].norm() / response.from_displacement(run.omega).norm();
    run.alive.iter().map(|&c| displacement(&run.responses[c]).powi(2)).sum::<f64>().sqrt()
}

/// Probability that neighbours among independent values are as alike; one of few values or equal ones.
fn probability_of_likeness(values: &[f64]) -> f64 {
    if values.len() < FEWEST {
        return 1.0;
    }
    let ranks = signed_ranks(values);
    let products: Vec<f64> = ranks.windows(2).map(|pair| pair[0] * pair[1]).collect();
    let deviation = norm(&products);
    if deviation > 0.0 { normal_cdf(-products.iter().sum::<f64>() / deviation) } else { 1.0 }
}

/// Rank of the size of each value less their median, from one, with its sign; nothing where it is the median.
fn signed_ranks(values: &[f64]) -> Vec<f64> {
    let middle = median(values);
    let mut order: Vec<usize> = (0..values.len()).filter(|&k| values[k] != middle).collect();
    order.sort_by(|&a, &b| (values[a] - middle).abs().total_cmp(&(values[b] - middle).abs()));
    let mut ranks = vec![0.0; values.len()];
    order.into_iter().enumerate().for_each(|(rank, k)| ranks[k] = (rank as f64 + 1.0).copysign(values[k] - middle));
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// Of 2000 samples of 24 values by chance, of the size `size`, those whose neighbours are alike as one sample in twenty is.
    fn called_alike(size: fn(usize) -> f64) -> usize {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let mut value = |k: usize| -> f64 {
            let normal: f64 = StandardNormal.sample(&mut rng);
            size(k) * normal
        };
        let mut is_alike = || probability_of_likeness(&(0..24).map(&mut value).collect::<Vec<f64>>()) < 0.05;
        (0..2000).filter(|_| is_alike()).count()
    }

    /// As often as the probability says, also where half of them are small.
    #[test]
    fn values_by_chance_are_seldom_called_alike() {
        for count in [called_alike(|_| 1.0), called_alike(|k| if k < 12 { 0.05 } else { 1.0 })] {
            assert!((60..140).contains(&count), "{count} of 2000");
        }
    }

    #[test]
    fn a_curve_is_no_chance() {
        let curve: Vec<f64> = (0..24_usize).map(|k| (0.2 * k as f64).cos() + 0.1 * (7.3 * k as f64).sin()).collect();
        assert!(probability_of_likeness(&curve) < 1e-3);
        assert!(probability_of_likeness(&[1.0; 24]) == 1.0 && probability_of_likeness(&curve[..7]) == 1.0);
    }
}
