//! The error on runs that were left out, against a fit of the other rows by singular values.

use super::without;
use crate::diagnosis::selection::levenberg_marquardt::Descent;
use faer::Mat;
use nalgebra::{DMatrix, DVector};

const ROWS: [[f64; 3]; 8] = [
    [1.0, 0.2, -0.5],
    [0.4, 1.1, 0.3],
    [-0.7, 0.6, 1.2],
    [2.0, -0.4, 0.1],
    [0.3, 0.9, -1.4],
    [-1.1, 0.5, 0.8],
    [0.6, -1.3, 0.7],
    [0.1, 0.2, 1.9],
];
const RESIDUAL: [f64; 8] = [0.3, -0.1, 0.25, 0.4, -0.2, 0.05, -0.3, 0.15];
const FOLDS: [usize; 8] = [0, 0, 1, 1, 2, 2, usize::MAX, usize::MAX];

fn descent(scale: f64) -> Descent {
    Descent {
        theta: vec![0.7, -0.2, 1.5],
        chi_square: 0.0,
        residual: RESIDUAL.iter().map(|r| scale * r).collect(),
        jacobian: Mat::from_fn(8, 3, |i, k| ROWS[i][k]),
        to_go: 0.0,
    }
}

#[test]
fn variables_without_a_fold_are_those_of_least_squares_on_the_other_rows() {
    let descent = descent(1.0);
    for fold in 0..3 {
        let kept: Vec<usize> = (0..8).filter(|&i| FOLDS[i] != fold).collect();
        let jacobian = DMatrix::from_fn(kept.len(), 3, |i, k| ROWS[kept[i]][k]);
        let residual = DVector::from_fn(kept.len(), |i, _| RESIDUAL[kept[i]]);
        let step = jacobian.svd(true, true).solve(&residual, 1e-12).expect("both sides of the decomposition");
        for (k, found) in without(&descent, &FOLDS, fold).into_iter().enumerate() {
            let expected = descent.theta[k] - step[k];
            assert!((found - expected).abs() < 1e-9, "fold {fold}, variable {k}: {found} for {expected}");
        }
    }
}

/// A linearised step says nothing beyond half a natural unit.
#[test]
fn no_variable_moves_by_more_than_half_a_unit() {
    let descent = descent(100.0);
    for fold in 0..3 {
        let moved = without(&descent, &FOLDS, fold);
        let steps: Vec<f64> = moved.iter().zip(&descent.theta).map(|(a, b)| (a - b).abs()).collect();
        assert!(steps.iter().all(|step| *step <= 0.5 + 1e-12) && steps.iter().any(|step| *step > 0.49), "{steps:?}");
    }
}
