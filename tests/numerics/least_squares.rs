//! Non-negative least squares: optimality conditions on random problems, and every set of columns tried in turn.

use crate::random::{generator, matrix, vector};
use dashpot::math::least_squares::LeastSquares;
use dashpot::math::nnls::nnls;
use faer::Mat;

#[test]
fn optimality_conditions_hold_on_random_problems() {
    let mut rng = generator(21);
    for trial in 0..200 {
        let (rows, columns) = (1 + trial % 23, 1 + (trial * 7) % 41);
        let low = if trial % 2 == 0 { 0.0 } else { -1.0 };
        let a = matrix(&mut rng, rows, columns, low, 1.0);
        let b = vector(&mut rng, rows, -0.5, 1.0);
        let fit = nnls(a.as_ref(), &b).unwrap();
        for j in 0..columns {
            assert!(fit.solution[j] >= 0.0);
            assert!(fit.dual[j] < 1e-12, "trial {trial}: dual {}", fit.dual[j]);
            assert!(fit.solution[j] == 0.0 || fit.dual[j].abs() < 1e-11, "trial {trial}: {}", fit.dual[j]);
        }
    }
}

#[test]
fn same_minimum_as_trying_every_set_of_columns() {
    let mut rng = generator(22);
    for _ in 0..20 {
        let a = matrix(&mut rng, 6, 8, -1.0, 1.0);
        let b = vector(&mut rng, 6, -1.0, 1.0);
        let mut least = b.iter().map(|v| v * v).sum::<f64>().sqrt();
        for set in 1_u32..256 {
            let used: Vec<usize> = (0..8).filter(|j| set >> j & 1 == 1).collect();
            let part = Mat::from_fn(6, used.len(), |i, j| a[(i, used[j])]);
            let problem = LeastSquares::new(part.as_ref()).unwrap();
            let fit = problem.solve(&b).unwrap();
            if problem.rank() == used.len() && fit.x.iter().all(|&x| x >= 0.0) {
                least = least.min(fit.residual_norm);
            }
        }
        assert!((nnls(a.as_ref(), &b).unwrap().residual_norm - least).abs() < 1e-12);
    }
}

#[test]
fn nearly_collinear_columns_terminate() {
    let mut rng = generator(23);
    for gap in [1e-6, 1e-9, 1e-12, 1e-15, 0.0] {
        let base = matrix(&mut rng, 12, 1, 0.5, 1.0);
        let a = Mat::from_fn(12, 40, |i, j| base[(i, 0)] + gap * ((i * 7 + j * 13) % 11) as f64);
        let b: Vec<f64> = (0..12).map(|i| 3.0 * base[(i, 0)]).collect();
        let fit = nnls(a.as_ref(), &b).unwrap();
        assert!(fit.residual_norm < 40.0 * gap + 1e-12, "{gap}: {}", fit.residual_norm);
    }
}

#[test]
fn covariance_agrees_with_the_scatter_of_many_fits() {
    let mut rng = generator(24);
    let a = matrix(&mut rng, 12, 3, -1.0, 1.0);
    let problem = LeastSquares::new(a.as_ref()).unwrap();
    let trials = 4000;
    let mut squares = [0.0; 3];
    for _ in 0..trials {
        // Uniform noise between -1 and 1 has the variance 1/3.
        let fit = problem.solve(&vector(&mut rng, 12, -1.0, 1.0)).unwrap();
        for (sum, x) in squares.iter_mut().zip(&fit.x) {
            *sum += x * x / f64::from(trials);
        }
    }
    for (square, deviation) in squares.iter().zip(problem.standard_deviations(1.0 / 3.0)) {
        assert!((square.sqrt() / deviation - 1.0).abs() < 0.05);
    }
}
