//! What else than sensor noise makes the energies of a `points` problem differ from a right model: the sizes of known sources, gains
//! and phases of channels, what is in proportion to the energy of a run.
//!
//! ```text
//! e = D u + n,    u_k ~ N(0, (kappa s_k)^2),    n_r ~ N(0, d_r^2 + (kappa s_p e_r)^2)
//! C = diag(n) + D S^2 D^T,    rows and columns are multiplied by C^(-1/2)
//! ```
//!
//! `kappa` is chosen beside each set of effects by its likelihood, so that exact data shrink it to nothing; that of known sources apart
//! from that of the measurement: good sensors say nothing of how well a damper is known.

use crate::diagnosis::updating::correction::Correction;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::diagnosis::updating::scales::Scales;
use dashpot_numerics::{dot, symmetric};
use faer::Mat;

/// Multiples of the scales of the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Multiples {
    /// Of the sizes of known sources.
    pub known: f64,
    /// Of gains and phases of channels and of what is in proportion to the energy.
    pub measurement: f64,
}

impl Multiples {
    const fn new(known: f64, measurement: f64) -> Self {
        Self { known, measurement }
    }

    /// Those that are tried.
    pub(super) const TRIED: [Self; 5] =
        [Self::new(1.0, 1.0), Self::new(1.0, 0.3), Self::new(0.3, 0.3), Self::new(1.0, 0.0), Self::new(0.0, 0.0)];

    /// Whether nothing is uncertain.
    pub(super) fn is_exact(self) -> bool {
        self.known == 0.0 && self.measurement == 0.0
    }

    fn of(self, parameter: &UpdatingParameter) -> f64 {
        if matches!(parameter, UpdatingParameter::Known(_)) { self.known } else { self.measurement }
    }
}

/// What is uncertain of the energies, at one multiple of its scales.
pub(super) struct Uncertainty {
    /// Parameters and the prior deviation of each.
    parameters: Vec<(UpdatingParameter, f64)>,
    /// Derivatives of the energy that is left by each, one list a parameter, over the deviation of each run.
    slopes: Vec<Vec<f64>>,
    /// `C^(-1/2)` in units of the deviations.
    root: Mat<f64>,
    /// `ln det C` in the same units.
    pub log_determinant: f64,
}

impl Uncertainty {
    /// Of uncertain parameters with the derivative of the energy that is left by each, over its deviation, and of the `input`
    /// over its deviation, one value a run; all scales are those of the search times their multiples.
    pub(super) fn new(uncertain: Vec<(UpdatingParameter, Vec<f64>)>, input: &[f64], multiples: Multiples) -> Self {
        let n = input.len();
        let scales = Scales::SEARCH.list();
        let (parameters, slopes): (Vec<_>, Vec<_>) =
            uncertain.into_iter().map(|(p, slope)| ((p.clone(), multiples.of(&p) * scales[p.class()]), slope)).unzip();
        let proportional = 2.0 * Scales::SEARCH.response * multiples.measurement;
        let covariance = Mat::from_fn(n, n, |i, j| {
            let shared: f64 = parameters.iter().zip(&slopes).map(|((_, s), d)| s * s * d[i] * d[j]).sum();
            let own = 1.0 + (proportional * input[i]).powi(2);
            shared + if i == j { own } else { 0.0 }
        });
        let Some((values, vectors)) = symmetric(covariance.as_ref()) else {
            return Self { parameters, slopes, root: Mat::identity(n, n), log_determinant: 0.0 };
        };
        // No eigenvalue is below one but by rounding.
        let values: Vec<f64> = values.into_iter().map(|v| v.max(1.0)).collect();
        let entry = |i: usize, j: usize| (0..n).map(|k| vectors[(i, k)] * vectors[(j, k)] / values[k].sqrt()).sum();
        let log_determinant = values.iter().map(|v| v.ln()).sum();
        Self { parameters, slopes, root: Mat::from_fn(n, n, entry), log_determinant }
    }

    /// Energies over their deviations, with unit covariance.
    pub(super) fn whitened(&self, rows: &[f64]) -> Vec<f64> {
        (0..rows.len()).map(|i| rows.iter().enumerate().map(|(j, r)| self.root[(i, j)] * r).sum()).collect()
    }

    /// Corrections of known sources where the energies over their deviations leave `rows`.
    pub(super) fn corrections(&self, rows: &[f64]) -> Vec<Correction> {
        let whitened = self.whitened(rows);
        let estimate = |((parameter, scale), slope): (&(UpdatingParameter, f64), &Vec<f64>)| {
            let slope = self.whitened(slope);
            let value = scale * scale * dot(&slope, &whitened);
            let variance = scale * scale * (1.0 - scale * scale * dot(&slope, &slope));
            let factor = value.exp();
            parameter.is_stated().then(|| Correction {
                parameter: parameter.clone(),
                factor,
                deviation: factor * variance.max(0.0).sqrt(),
            })
        };
        self.parameters.iter().zip(&self.slopes).filter_map(estimate).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::least_squares::solve_symmetric;

    const ROWS: [f64; 4] = [3.0, -1.0, 4.0, 0.5];
    const INPUT: [f64; 4] = [40.0, 55.0, 80.0, 20.0];

    fn slopes() -> [Vec<f64>; 2] {
        [vec![30.0, 10.0, 45.0, 2.0], vec![5.0, -20.0, 8.0, 12.0]]
    }

    fn uncertainty() -> Uncertainty {
        let [a, b] = slopes();
        Uncertainty::new(
            vec![(UpdatingParameter::Known(0), a), (UpdatingParameter::Gain("acc@1".into()), b)],
            &INPUT,
            Multiples::TRIED[0],
        )
    }

    /// Variance of what is each run's own.
    fn own(r: usize) -> f64 {
        1.0 + (2.0 * Scales::SEARCH.response * INPUT[r]).powi(2)
    }

    #[test]
    fn whitened_rows_have_unit_covariance() {
        let (uncertainty, [a, b]) = (uncertainty(), slopes());
        let (s, g) = (Scales::SEARCH.known, Scales::SEARCH.gain);
        let covariance =
            Mat::from_fn(4, 4, |i, j| s * s * a[i] * a[j] + g * g * b[i] * b[j] + if i == j { own(i) } else { 0.0 });
        let unit = &uncertainty.root * &covariance * uncertainty.root.transpose();
        for i in 0..4 {
            for j in 0..4 {
                assert!((unit[(i, j)] - f64::from(u8::from(i == j))).abs() < 1e-9, "{i} {j}: {}", unit[(i, j)]);
            }
        }
        let factor = dashpot_numerics::Cholesky::new(covariance.as_ref()).map(|c| c.log_determinant());
        assert!(factor.is_some_and(|l| (l - uncertainty.log_determinant).abs() < 1e-9));
    }

    /// The mean and variance of normal equations with the prior, `(D^T V^-1 D + S^-2) u = D^T V^-1 e`.
    #[test]
    fn corrections_are_those_of_the_normal_equations() {
        let slopes = slopes();
        let priors = [Scales::SEARCH.known, Scales::SEARCH.gain];
        let inner = |a: &[f64], b: &[f64]| (0..4).map(|r| a[r] * b[r] / own(r)).sum::<f64>();
        let normal =
            Mat::from_fn(2, 2, |i, j| inner(&slopes[i], &slopes[j]) + if i == j { priors[i].powi(-2) } else { 0.0 });
        let sides =
            Mat::from_fn(2, 2, |i, j| if j == 0 { inner(&slopes[i], &ROWS) } else { f64::from(u8::from(i == 0)) });
        let Ok(solved) = solve_symmetric(normal.as_ref(), sides.as_ref()) else { panic!("singular") };
        let corrections = uncertainty().corrections(&ROWS);
        assert_eq!(corrections.len(), 1, "gains are not of the model");
        let known = &corrections[0];
        assert!((known.factor.ln() - solved[(0, 0)]).abs() < 1e-9);
        assert!((known.deviation / known.factor - solved[(0, 1)].sqrt()).abs() < 1e-9);
    }
}
