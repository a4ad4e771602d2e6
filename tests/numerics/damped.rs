//! Damped modes against proportional damping in closed form, their own equation, and finite differences.

use crate::common::models::cantilever;
use crate::random::{generator, positive, vector};
use dashpot::math::eigen::generalised_symmetric;
use dashpot::structure::SystemMatrices;
use dashpot::structure::damped_modes::{DampedMode, damped_modes, damped_modes_from};
use dashpot::structure::modes::modes;
use faer::{Mat, c64};

fn system(seed: u64, n: usize) -> SystemMatrices {
    let mut rng = generator(seed);
    SystemMatrices { mass: positive(&mut rng, n, 0.5), stiffness: positive(&mut rng, n, 1.0) * faer::Scale(1e6) }
}

/// Backward error `|(lambda^2 M + lambda C + K) psi| / ((|lambda|^2 |M| + |lambda| |C| + |K|) |psi|)`.
fn residual(s: &SystemMatrices, c: &Mat<f64>, mode: &DampedMode) -> f64 {
    let n = mode.shape.len();
    let (lambda, square) = (mode.lambda, mode.lambda * mode.lambda);
    let row = |i: usize| {
        let terms =
            (0..n).map(|j| mode.shape[j] * (square * s.mass[(i, j)] + lambda * c[(i, j)] + s.stiffness[(i, j)]));
        terms.sum::<c64>().norm()
    };
    let size = square.norm() * s.mass.norm_max() + lambda.norm() * c.norm_max() + s.stiffness.norm_max();
    let psi = mode.shape.iter().fold(0.0_f64, |l, v| l.max(v.norm()));
    (0..n).map(row).fold(0.0, f64::max) / (size * psi)
}

fn norm_form(s: &SystemMatrices, c: &Mat<f64>, mode: &DampedMode) -> c64 {
    mode.lambda * 2.0 * mode.quadratic_form(s.mass.as_ref()) + mode.quadratic_form(c.as_ref())
}

#[test]
fn proportional_damping_in_closed_form() {
    let s = system(1, 8);
    let (alpha, beta) = (3.0, 2e-5);
    let c = Mat::from_fn(8, 8, |i, j| alpha * s.mass[(i, j)] + beta * s.stiffness[(i, j)]);
    let undamped = modes(&s).unwrap();
    let found = damped_modes_from(&undamped, c.as_ref()).unwrap();
    assert_eq!(found.len(), 8);
    for (mode, omega) in found.iter().zip(&undamped.omega) {
        let zeta = alpha / (2.0 * omega) + beta * omega / 2.0; // (2.90)
        assert!((mode.damping_ratio - zeta).abs() < 1e-11, "{} {zeta}", mode.damping_ratio);
        assert!((mode.frequency_hz * std::f64::consts::TAU / omega - 1.0).abs() < 1e-11);
    }
}

#[test]
fn every_mode_solves_its_equation_and_is_normalised() {
    for (seed, strength) in [(2, 1.0), (3, 100.0), (4, 1e4)] {
        let s = system(seed, 9);
        let c = positive(&mut generator(seed + 50), 9, 0.0) * faer::Scale(strength);
        let found = damped_modes(s.mass.as_ref(), s.stiffness.as_ref(), c.as_ref()).unwrap();
        let real = found.iter().filter(|m| m.is_overdamped()).count();
        assert_eq!(2 * (found.len() - real) + real, 18);
        assert!(strength < 1e3 || real > 0);
        for mode in &found {
            assert!(residual(&s, &c, mode) < 1e-12, "{strength} {:?} {}", mode.lambda, residual(&s, &c, mode));
            assert!((norm_form(&s, &c, mode) - c64::new(1.0, 0.0)).norm() < 1e-8);
            assert!(mode.lambda.re < 0.0);
        }
        assert!(found.windows(2).all(|w| w[0].frequency_hz <= w[1].frequency_hz));
    }
}

#[test]
fn sensitivities_agree_with_finite_differences() {
    let s = system(6, 6);
    let base = vector(&mut generator(7), 6, 10.0, 300.0);
    let solve = |c: &[f64], spring: f64| {
        let mut matrix = Mat::from_fn(6, 6, |i, j| if i == j { c[i] } else { 0.0 });
        for (i, j, sign) in [(1, 1, 1.0), (4, 4, 1.0), (1, 4, -1.0), (4, 1, -1.0)] {
            matrix[(i, j)] += sign * spring;
        }
        damped_modes(s.mass.as_ref(), s.stiffness.as_ref(), matrix.as_ref()).unwrap()
    };
    let (here, up, down) = (solve(&base, 50.0), solve(&base, 50.5), solve(&base, 49.5));
    for r in 0..6 {
        let relative = here[r].shape[1] - here[r].shape[4];
        let change = here[r].sensitivity(relative * relative);
        let lambda = up[r].lambda - down[r].lambda;
        assert!((change.lambda - lambda).norm() < 1e-6 * change.lambda.norm() + 1e-10);
        let zeta = up[r].damping_ratio - down[r].damping_ratio;
        assert!((change.damping_ratio - zeta).abs() < 1e-6 * zeta.abs() + 1e-12);
        let frequency = up[r].frequency_hz - down[r].frequency_hz;
        assert!((change.frequency_hz - frequency).abs() < 1e-5 * frequency.abs() + 1e-9);
    }
}

#[test]
fn no_damping_gives_the_undamped_modes() {
    let s = system(11, 10);
    let values = generalised_symmetric(s.stiffness.as_ref(), s.mass.as_ref()).unwrap().values;
    let found = damped_modes(s.mass.as_ref(), s.stiffness.as_ref(), Mat::zeros(10, 10).as_ref()).unwrap();
    assert_eq!(found.len(), 10);
    for (mode, value) in found.iter().zip(values) {
        assert!((mode.lambda.im / value.sqrt() - 1.0).abs() < 1e-12 && mode.damping_ratio.abs() < 1e-12);
    }
}

#[test]
fn many_degrees_of_freedom_keep_their_precision() {
    // Beyond 128 rows the eigenvalue solver of the linear algebra crate changes its method.
    let n = 160;
    let structure = cantilever(n / 2);
    let s = structure.matrices().unwrap();
    let undamped = structure.modes().unwrap();
    for r in 0..n {
        let column = |a: &Mat<f64>| a * undamped.shapes.col(r);
        let spring = column(&s.stiffness);
        let gap = (&spring - column(&s.mass) * faer::Scale(undamped.omega[r].powi(2))).norm_max();
        let size = s.stiffness.norm_max() * undamped.shapes.col(r).norm_max();
        assert!(gap < 1e-12 * size, "mode {r}: {:e}", gap / size);
    }
    let c = Mat::from_fn(n, n, |i, j| if i == j && i % 6 == 2 { 0.01 } else { 0.0 });
    let found = damped_modes_from(&undamped, c.as_ref()).unwrap();
    assert_eq!(found.len(), n);
    for mode in &found {
        assert!(residual(s, &c, mode) < 1e-12, "{:?}: {:e}", mode.lambda, residual(s, &c, mode));
        assert!((norm_form(s, &c, mode) - c64::new(1.0, 0.0)).norm() < 1e-7);
    }
}

/// Three equal oscillators beside a damped one: the solver may give any basis of the threefold pole, the receptance
/// `sum psi psi^T / (i w - lambda) + conjugate` needs shapes that are orthogonal in `2 lambda M + C`.
#[test]
fn shapes_of_equal_poles_add_up_to_the_receptance() {
    let m = Mat::<f64>::identity(4, 4);
    let mut k = Mat::<f64>::identity(4, 4) * faer::Scale(100.0);
    k[(3, 3)] = 250.0;
    let turn = Mat::from_fn(4, 4, |i, j| if i == j { 1.0 } else { 0.3 * ((i * 4 + j) as f64 * 1.7).sin() });
    let turned = |a: &Mat<f64>| turn.transpose() * a * &turn;
    let mut c = Mat::<f64>::zeros(4, 4);
    c[(3, 3)] = 0.8;
    let (m, k, c) = (turned(&m), turned(&k), turned(&c));
    let modes = damped_modes(m.as_ref(), k.as_ref(), c.as_ref()).unwrap();
    assert_eq!(modes.len(), 4);
    let omega = 6.0;
    let s = c64::new(0.0, omega);
    let direct = Mat::from_fn(4, 4, |i, j| c64::new(k[(i, j)] - omega * omega * m[(i, j)], omega * c[(i, j)]));
    let sum = Mat::from_fn(4, 4, |i, j| {
        modes
            .iter()
            .map(|mode| {
                let residue = mode.shape[i] * mode.shape[j];
                residue / (s - mode.lambda) + residue.conj() / (s - mode.lambda.conj())
            })
            .sum::<c64>()
    });
    let product = &direct * &sum;
    for i in 0..4 {
        for j in 0..4 {
            let one = if i == j { 1.0 } else { 0.0 };
            assert!((product[(i, j)] - one).norm() < 1e-9, "{i} {j} {}", product[(i, j)]);
        }
    }
}
