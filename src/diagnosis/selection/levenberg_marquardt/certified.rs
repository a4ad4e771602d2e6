//! The descent against certified values of the Statistical Reference Datasets for nonlinear regression (NIST StRD: Misra1a, Kowalik
//! and Osborne's MGH09), from the starts that are given there.

use super::{Residual, descend};
use faer::Mat;
use std::convert::Infallible;

/// A data set with its certified least squares fit.
struct Reference {
    /// Observations, each with the value of its predictor, `[y, x]`.
    observations: &'static [[f64; 2]],
    /// The model, at a predictor and its parameters.
    model: fn(f64, &[f64]) -> f64,
    /// Certified parameters, each with its standard deviation.
    certified: &'static [[f64; 2]],
    /// Certified residual sum of squares.
    sum_of_squares: f64,
}

const MISRA1A: Reference = Reference {
    observations: &[
        [10.07, 77.6],
        [14.73, 114.9],
        [17.94, 141.1],
        [23.93, 190.8],
        [29.61, 239.9],
        [35.18, 289.0],
        [40.02, 332.8],
        [44.82, 378.4],
        [50.76, 434.8],
        [55.05, 477.3],
        [61.01, 536.8],
        [66.40, 593.1],
        [75.47, 689.1],
        [81.78, 760.0],
    ],
    model: |x, b| b[0] * (1.0 - (-b[1] * x).exp()),
    certified: &[[2.389_421_291_8e2, 2.707_007_524_1], [5.501_564_318_1e-4, 7.266_868_843_6e-6]],
    sum_of_squares: 1.245_513_889_4e-1,
};

const MGH09: Reference = Reference {
    observations: &[
        [0.1957, 4.0],
        [0.1947, 2.0],
        [0.1735, 1.0],
        [0.16, 0.5],
        [0.0844, 0.25],
        [0.0627, 0.167],
        [0.0456, 0.125],
        [0.0342, 0.1],
        [0.0323, 0.0833],
        [0.0235, 0.0714],
        [0.0246, 0.0625],
    ],
    model: |x, b| b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3]),
    certified: &[
        [1.928_069_345_8e-1, 1.143_531_222_7e-2],
        [1.912_823_287_3e-1, 1.963_322_091_1e-1],
        [1.230_565_069_3e-1, 8.084_203_123_2e-2],
        [1.360_623_306_8e-1, 9.002_554_230_8e-2],
    ],
    sum_of_squares: 3.075_056_038_5e-4,
};

impl Reference {
    /// Certified residual standard deviation.
    fn deviation(&self) -> f64 {
        (self.sum_of_squares / (self.observations.len() - self.certified.len()) as f64).sqrt()
    }

    fn residual_at(&self, logarithms: &[f64]) -> Vec<f64> {
        let b: Vec<f64> = logarithms.iter().map(|x| x.exp()).collect();
        self.observations.iter().map(|&[y, x]| (y - (self.model)(x, &b)) / self.deviation()).collect()
    }

    /// Checks the fit from the parameters `start`.
    fn check(&self, start: &[f64]) {
        let logarithms: Vec<f64> = start.iter().map(|b| b.ln()).collect();
        let Ok(descent) = descend(&mut Fit(self), &logarithms, 500);
        let sum_of_squares = descent.chi_square * self.deviation().powi(2);
        assert!((sum_of_squares / self.sum_of_squares - 1.0).abs() < 1e-8, "{start:?}: {sum_of_squares}");
        let deviations = descent.deviations();
        for (k, [value, deviation]) in self.certified.iter().enumerate() {
            let found = descent.theta[k].exp();
            assert!((found - value).abs() < 1e-4 * deviation, "{start:?}: parameter {k} is {found} for {value}");
            // Of a logarithm: relative.
            let told = deviations[k] * found;
            assert!((told / deviation - 1.0).abs() < 1e-4, "{start:?}: deviation {k} is {told} for {deviation}");
        }
    }
}

/// Residuals of unit variance, the parameters in their logarithms as those of laws.
struct Fit<'a>(&'a Reference);

impl Residual for Fit<'_> {
    type Error = Infallible;

    fn residual(&mut self, theta: &[f64]) -> Result<Vec<f64>, Infallible> {
        Ok(self.0.residual_at(theta))
    }

    fn jacobian(&mut self, theta: &[f64], at: &[f64]) -> Result<Mat<f64>, Infallible> {
        let moved = |k: usize, by: f64| {
            let mut there = theta.to_vec();
            there[k] += by;
            self.0.residual_at(&there)
        };
        let step = 1e-6;
        let columns: Vec<[Vec<f64>; 2]> = (0..theta.len()).map(|k| [moved(k, step), moved(k, -step)]).collect();
        Ok(Mat::from_fn(at.len(), theta.len(), |i, k| (columns[k][0][i] - columns[k][1][i]) / (2.0 * step)))
    }

    fn enough(&self) -> f64 {
        1e-14
    }
}

#[test]
fn misra1a_is_fitted_to_its_certified_values() {
    for start in [[500.0, 1e-4], [250.0, 5e-4]] {
        MISRA1A.check(&start);
    }
}

#[test]
fn mgh09_is_fitted_to_its_certified_values() {
    for start in [[25.0, 39.0, 41.5, 39.0], [0.25, 0.39, 0.415, 0.39]] {
        MGH09.check(&start);
    }
}
