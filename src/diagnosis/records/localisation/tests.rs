//! What a free force leaves against one dense least squares problem of all forces and end differences, and the place of a dashpot in a
//! motion that was integrated.
#![allow(clippy::unwrap_used, reason = "tests")]
use super::*;
use crate::common::models::chain;
use crate::common::runs::decay;
use crate::math::least_squares::LeastSquares;

const CHANNELS: usize = 3;
const MODES: usize = 2;
const UNKNOWNS: usize = 4;

/// Lines of numbers that have nothing to do with each other.
fn lines(count: usize) -> Vec<Line> {
    let number = |k: usize| c64::new((1.3 * k as f64 + 0.4).sin(), (2.9 * k as f64 - 1.0).sin());
    let line = |k: usize| Line {
        measured: (0..CHANNELS).map(|c| number(7 * k + c) * 3.0).collect(),
        ends: (0..UNKNOWNS).map(|j| (0..CHANNELS).map(|c| number(11 * k + 5 * j + c + 40)).collect()).collect(),
        responses: Mat::from_fn(CHANNELS, MODES, |c, r| number(13 * k + 3 * c + r + 90)),
    };
    (0..count).map(line).collect()
}

/// Real and imaginary part of one line and channel a row pair; unknown are the end differences and the two parts of the force of every line.
#[test]
fn what_is_left_is_that_of_one_least_squares_problem() {
    let (count, pattern) = (5, [0.7, -0.4]);
    let lines = lines(count);
    let entry = |row: usize, column: usize| {
        let (k, c, imaginary) = (row / (2 * CHANNELS), row / 2 % CHANNELS, row % 2 == 1);
        let value = if column < UNKNOWNS {
            lines[k].ends[column][c]
        } else if (column - UNKNOWNS) / 2 == k {
            let force = (0..MODES).map(|r| lines[k].responses[(c, r)] * pattern[r]).sum::<c64>();
            force * if (column - UNKNOWNS).is_multiple_of(2) { c64::new(1.0, 0.0) } else { c64::new(0.0, 1.0) }
        } else {
            c64::new(0.0, 0.0)
        };
        if imaginary { value.im } else { value.re }
    };
    let matrix = Mat::from_fn(2 * CHANNELS * count, UNKNOWNS + 2 * count, entry);
    let measured: Vec<f64> = lines.iter().flat_map(|line| line.measured.iter().flat_map(|y| [y.re, y.im])).collect();
    let dense = LeastSquares::new(matrix.as_ref()).unwrap().solve(&measured).unwrap();
    let [left, freedom] = misfit(&lines, &pattern, UNKNOWNS);
    assert!((left / dense.residual_norm.powi(2) - 1.0).abs() < 1e-8, "{left} {}", dense.residual_norm.powi(2));
    assert_eq!(freedom, dense.freedom as f64);
}

/// Displacements of the masses of a free chain with a dashpot (N s/m) from each to the ground, by Runge and Kutta's method.
fn integrated(masses: [f64; 3], stiffness: &Mat<f64>, dashpots: [f64; 3], step: f64, count: usize) -> Vec<Vec<f64>> {
    const WITHIN: usize = 8;
    let slope = |state: &[f64; 6]| -> [f64; 6] {
        let force = |i: usize| (0..3).map(|j| stiffness[(i, j)] * state[j]).sum::<f64>() + dashpots[i] * state[3 + i];
        std::array::from_fn(|i| if i < 3 { state[3 + i] } else { -force(i - 3) / masses[i - 3] })
    };
    let along = |state: &[f64; 6], slope: &[f64; 6], t: f64| std::array::from_fn(|i| state[i] + t * slope[i]);
    let (mut state, mut rows, t) = ([0.0, 0.0, 0.0, 0.5, -0.3, 0.9], vec![Vec::new(); 3], step / WITHIN as f64);
    for _ in 0..count {
        rows.iter_mut().zip(state).for_each(|(row, x)| row.push(x));
        for _ in 0..WITHIN {
            let a = slope(&state);
            let b = slope(&along(&state, &a, 0.5 * t));
            let c = slope(&along(&state, &b, 0.5 * t));
            let d = slope(&along(&state, &c, t));
            state = std::array::from_fn(|i| state[i] + t / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
    }
    rows
}

/// A dashpot that the model lacks is told to be where it is, at any mass.
#[test]
fn a_dashpot_is_located_where_it_acts() {
    let masses = [2.0, 1.0, 1.5];
    let structure = chain(&masses, &[900.0, 0.0, 700.0], &[1500.0, 1100.0]);
    let places: Vec<Place> = (0..3).map(|dof| Place::Dofs(vec![dof])).collect();
    for at in 0..3 {
        let dashpots = std::array::from_fn(|dof| if dof == at { 0.8 } else { 0.0 });
        let rows = integrated(masses, &structure.matrices().unwrap().stiffness, dashpots, 5e-3, 3000);
        let records = Records::new(&structure, &[], &[decay(5e-3, rows)]).unwrap();
        let found = locate(&records, &places, 0.0);
        assert_eq!(found[0].place, places[at], "{found:?}");
        assert!(found[1].misfit > 10.0 * found[0].misfit, "{found:?}");
    }
}
