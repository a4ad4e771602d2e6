//! Probabilities of chance: of one difference, of many corrected for their number, of all together.

use crate::math::statistics::normal_cdf;
use dashpot_numerics::{EquilibratedCholesky, dot};
use faer::Mat;

/// Probability of chance below which a difference is called a change.
pub const LEVEL: f64 = 0.01;

/// Probability of a difference as large by noise alone, two-sided; 1 where its deviation is not known.
pub(super) fn chance(difference: f64, deviation: f64) -> f64 {
    if deviation > 0.0 && deviation.is_finite() {
        (2.0 * normal_cdf(-(difference / deviation).abs())).min(1.0)
    } else {
        1.0
    }
}

/// Holm's step-down correction: the k-th smallest of n times (n - k), never falling, at most 1.
pub(super) fn holm(chances: &[f64]) -> Vec<f64> {
    let n = chances.len();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| chances[a].total_cmp(&chances[b]));
    let mut corrected = vec![0.0; n];
    let mut largest = 0.0_f64;
    for (rank, &k) in order.iter().enumerate() {
        largest = largest.max((n - rank) as f64 * chances[k]).min(1.0);
        corrected[k] = largest;
    }
    corrected
}

/// `d^T S^-1 d`; `None` where the covariance is not determined or there is nothing to compare.
pub(super) fn chi_square_of(differences: &[f64], covariance: &dyn Fn(usize, usize) -> f64) -> Option<f64> {
    let n = differences.len();
    if n == 0 {
        return None;
    }
    // Coefficients of different laws differ by powers of ten.
    let factor = EquilibratedCholesky::new(Mat::from_fn(n, n, covariance).as_ref(), 0.0)?;
    Some(dot(differences, &factor.solve(differences)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::{chance, chi_square_of, holm};

    #[test]
    fn chances_of_a_normal_difference() {
        assert!((chance(1.959_964, 1.0) - 0.05).abs() < 1e-6);
        assert!((chance(-2.575_829, 1.0) - 0.01).abs() < 1e-6);
        assert_eq!(chance(1.0, 0.0), 1.0);
        assert_eq!(chance(1.0, f64::INFINITY), 1.0);
    }

    #[test]
    fn holm_as_in_its_paper() {
        // Sorted 0.005, 0.011, 0.02, 0.04 times 4, 3, 2, 1, never falling.
        let corrected = holm(&[0.02, 0.005, 0.04, 0.011]);
        for (own, known) in corrected.iter().zip([0.04, 0.02, 0.04, 0.033]) {
            assert!((own - known).abs() < 1e-12, "{corrected:?}");
        }
        assert_eq!(holm(&[0.7, 0.9]), [1.0, 1.0]);
    }

    #[test]
    fn chi_square_of_correlated_differences() {
        // S = [[1, 0.5], [0.5, 1]], inverse 4/3 [[1, -0.5], [-0.5, 1]]: d = (1, 2) gives 4/3 (1 + 4 - 2) = 4.
        let s = |i: usize, j: usize| if i == j { 1.0 } else { 0.5 };
        assert!((chi_square_of(&[1.0, 2.0], &s).unwrap() - 4.0).abs() < 1e-12);
        assert!(chi_square_of(&[1.0], &|_, _| 0.0).is_none());
    }
}
