//! Valleys that bend, bounds, what stays above what is of interest, what is left of the prior.

use super::{Descent, Residual, descend, stays_above};
use faer::Mat;

/// Rosenbrock's valley, ten times as deep: `100 (y - x^2)` and `10 (1 - x)`.
struct Valley(usize);

impl Residual for Valley {
    type Error = std::convert::Infallible;

    fn residual(&mut self, at: &[f64]) -> Result<Vec<f64>, Self::Error> {
        self.0 += 1;
        Ok(vec![100.0 * (at[1] - at[0] * at[0]), 10.0 * (1.0 - at[0])])
    }

    fn jacobian(&mut self, at: &[f64], _: &[f64]) -> Result<Mat<f64>, Self::Error> {
        Ok(Mat::from_fn(2, 2, |i, j| [[-200.0 * at[0], 100.0], [-10.0, 0.0]][i][j]))
    }
}

#[test]
fn a_descent_follows_a_valley_that_bends() {
    let mut valley = Valley(0);
    let Ok(descent) = descend(&mut valley, &[-1.2, 1.0], 200);
    assert!((descent.theta[0] - 1.0).abs() < 1e-2, "{:?}", descent.theta);
    assert!(valley.0 < 60, "{} residuals", valley.0);
}

/// `(x - 8) / 10`, `3 (x + y - 1)` with `x` at most 2.
struct Bounded(usize);

impl Residual for Bounded {
    type Error = std::convert::Infallible;

    fn residual(&mut self, at: &[f64]) -> Result<Vec<f64>, Self::Error> {
        self.0 += 1;
        Ok(vec![0.1 * (at[0] - 8.0), 3.0 * (at[0] + at[1] - 1.0)])
    }

    fn jacobian(&mut self, _: &[f64], _: &[f64]) -> Result<Mat<f64>, Self::Error> {
        Ok(Mat::from_fn(2, 2, |i, j| [[0.1, 0.0], [3.0, 3.0]][i][j]))
    }

    fn bounds(&self) -> Vec<[f64; 2]> {
        vec![[-2.0, 2.0]]
    }
}

#[test]
fn a_variable_that_would_leave_its_bounds_stays_and_the_others_go_on() {
    let mut bounded = Bounded(0);
    let Ok(descent) = descend(&mut bounded, &[0.0, 0.0], 50);
    assert_eq!(descent.theta[0], 2.0);
    assert!((descent.theta[1] + 1.0).abs() < 0.05 && descent.to_go < 0.02, "{descent:?}");
    assert!(bounded.0 < 20, "{} residuals", bounded.0);
}

/// Of a size that the data know to a tenth and one of which they know nothing, a tenth of the prior is left.
#[test]
fn the_volume_that_is_left_is_that_of_what_the_data_know() {
    let jacobian = Mat::from_fn(3, 2, |i, k| if k == 0 { [6.0, 8.0, 0.0][i] } else { 0.0 });
    let descent = Descent { theta: vec![0.0; 2], chi_square: 0.0, residual: vec![0.0; 3], jacobian, to_go: 0.0 };
    assert!((descent.log_volume() + 0.5 * 101.0_f64.ln()).abs() < 1e-12, "{}", descent.log_volume());
}

/// `x` and a part of the residual that nothing changes, where what stays above a bound is of no interest.
struct Bound {
    most: f64,
    residuals: usize,
}

impl Residual for Bound {
    type Error = std::convert::Infallible;

    fn residual(&mut self, at: &[f64]) -> Result<Vec<f64>, Self::Error> {
        self.residuals += 1;
        Ok(vec![10.0 * (at[0] - 4.0), 100.0])
    }

    fn jacobian(&mut self, _: &[f64], _: &[f64]) -> Result<Mat<f64>, Self::Error> {
        Ok(Mat::from_fn(2, 1, |i, _| [10.0, 0.0][i]))
    }

    fn most(&self) -> f64 {
        self.most
    }
}

#[test]
fn a_descent_that_would_stay_above_what_is_of_interest_is_not_begun() {
    let mut above = Bound { most: 5000.0, residuals: 0 };
    let Ok(descent) = descend(&mut above, &[0.0], 20);
    assert_eq!((descent.theta[0], above.residuals), (0.0, 1));
    let mut below = Bound { most: 10_500.0, residuals: 0 };
    let Ok(descent) = descend(&mut below, &[0.0], 20);
    assert!(descent.chi_square < 10_100.0, "{descent:?}");
    assert!(stays_above(100.0, 20.0, 50.0) && !stays_above(100.0, 30.0, 50.0));
}

/// A residual so rough that no step lowers it, whatever its derivative predicts.
struct Rough(usize);

impl Residual for Rough {
    type Error = std::convert::Infallible;

    fn residual(&mut self, at: &[f64]) -> Result<Vec<f64>, Self::Error> {
        self.0 += 1;
        Ok(vec![if at[0] == 0.0 { 1.0 } else { 2.0 }])
    }

    fn jacobian(&mut self, _: &[f64], _: &[f64]) -> Result<Mat<f64>, Self::Error> {
        Ok(Mat::from_fn(1, 1, |_, _| 1.0))
    }
}

/// A damped step that is predicted to bring less than counts is not tried: of the dozen up to the firmest there are a few.
#[test]
fn steps_that_are_predicted_to_bring_nothing_are_not_tried() {
    let mut rough = Rough(0);
    let Ok(descent) = descend(&mut rough, &[0.0], 20);
    assert_eq!(descent.theta[0], 0.0);
    assert!(rough.0 < 18, "{} residuals", rough.0);
}
