//! Quantiles of the normal and chi-square distributions, robust measures, and the Bayesian information criterion.

use statrs::distribution::{ChiSquared, ContinuousCDF, Normal};

/// Standard deviation of a normal distribution over its median absolute deviation.
pub(crate) const MAD_TO_DEVIATION: f64 = 1.482_602_218_505_602;

/// `P(X > x)` for chi-square with `freedom` degrees of freedom, exact where it is tiny; 0 for `freedom == 0`, NaN for NaN.
pub(crate) fn chi_square_tail(x: f64, freedom: usize) -> f64 {
    if x.is_nan() {
        return f64::NAN;
    }
    if x <= 0.0 && freedom > 0 {
        return 1.0;
    }
    ChiSquared::new(freedom as f64).map_or(0.0, |distribution| distribution.sf(x))
}

/// Value that chi-square with `freedom` degrees of freedom stays below with `probability` (clamped to 0..1); 0 for
/// `freedom == 0`.
pub(crate) fn chi_square_quantile(probability: f64, freedom: usize) -> f64 {
    let p = probability.clamp(0.0, 1.0);
    if p >= 1.0 && freedom > 0 {
        return f64::INFINITY;
    }
    ChiSquared::new(freedom as f64).map_or(0.0, |distribution| distribution.inverse_cdf(p))
}

/// `P(X <= x)` for the standard normal distribution.
pub(crate) fn normal_cdf(x: f64) -> f64 {
    Normal::standard().cdf(x)
}

/// Root mean square; 0 for no values.
pub(crate) fn root_mean_square(values: &[f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    super::nnls::norm(values) / (values.len() as f64).sqrt()
}

/// Sum of squares.
pub(crate) fn sum_of_squares(values: &[f64]) -> f64 {
    values.iter().map(|x| x * x).sum()
}

/// Arithmetic mean; NaN for no values.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Sample standard deviation (divisor n - 1); 0 for fewer than two values.
pub(crate) fn standard_deviation(values: &[f64]) -> f64 {
    if values.len() < 2 {
        return 0.0;
    }
    let centre = mean(values);
    (values.iter().map(|v| (v - centre).powi(2)).sum::<f64>() / (values.len() - 1) as f64).sqrt()
}

/// Quantile by linear interpolation between order statistics (type 7); `probability` is clamped to 0..1; NaN for no values.
pub(crate) fn quantile(values: &[f64], probability: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let position = probability.clamp(0.0, 1.0) * last as f64;
    let below = position.floor() as usize;
    let above = (below + 1).min(last);
    sorted[below] + (position - below as f64) * (sorted[above] - sorted[below])
}

/// Median; NaN for no values.
pub(crate) fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// Standard deviation estimated from the median absolute deviation from the median: untouched by outliers.
pub(crate) fn robust_deviation(values: &[f64]) -> f64 {
    let centre = median(values);
    let distances: Vec<f64> = values.iter().map(|v| (v - centre).abs()).collect();
    MAD_TO_DEVIATION * median(&distances)
}

/// Bayesian information criterion `chi^2 + p ln n` of a model with `parameters` free parameters whose weighted squared
/// residual over `data` values is `chi_square`; the smaller, the better the evidence.
pub(crate) fn bayesian_information(chi_square: f64, parameters: usize, data: usize) -> f64 {
    chi_square + parameters as f64 * (data.max(1) as f64).ln()
}

/// Probabilities of models from their information criteria, `exp(-b/2)` normalised.
pub(crate) fn evidence_weights(criteria: &[f64]) -> Vec<f64> {
    let least = criteria.iter().copied().fold(f64::INFINITY, f64::min);
    let weights: Vec<f64> = criteria.iter().map(|b| (-0.5 * (b - least)).exp()).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|w| w / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_printed_tables() {
        assert!((chi_square_quantile(0.95, 1) - 3.841_458_821).abs() < 1e-6);
        assert!((chi_square_quantile(0.99, 10) - 23.209_251_16).abs() < 1e-6);
        assert!((normal_cdf(1.959_963_985) - 0.975).abs() < 1e-9);
    }

    #[test]
    fn tail_closed_form_for_two_degrees() {
        for x in [0.1, 1.0, 7.0, 400.0] {
            assert!((chi_square_tail(x, 2) / (-x / 2.0).exp() - 1.0).abs() < 1e-9);
        }
        assert_eq!((chi_square_tail(1.0, 0), chi_square_tail(0.0, 3)), (0.0, 1.0));
    }

    #[test]
    fn robust_deviation_ignores_an_outlier() {
        let normal = |k: i32| Normal::standard().inverse_cdf((f64::from(k) + 0.5) / 101.0);
        let values: Vec<f64> = (0..101).map(normal).collect();
        let mut spoilt = values.clone();
        spoilt[100] = 1e9;
        assert!((robust_deviation(&values) - 1.0).abs() < 0.02);
        assert!((robust_deviation(&spoilt) - robust_deviation(&values)).abs() < 1e-12);
    }

    #[test]
    fn order_statistics() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(quantile(&[1.0, 2.0, 3.0, 4.0], 0.5), 2.5);
        assert!(median(&[]).is_nan());
        assert!((root_mean_square(&[3.0, 4.0]) - 12.5f64.sqrt()).abs() < 1e-15);
        assert!((standard_deviation(&[1.0, 2.0, 3.0]) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn weights_add_up() {
        let weights = evidence_weights(&[10.0, 12.0, 1e4]);
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        assert!((weights[0] / weights[1] - 1f64.exp()).abs() < 1e-12);
    }
}
