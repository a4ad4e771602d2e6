//! The five masses of section 6.7 with the damping of (6.13), and complete noise-free data of them.

pub(crate) use crate::common::models::five_masses;
use dashpot::classical::{LoadCase, ModalData, ReceptanceData};
use dashpot::structure::Structure;
use dashpot::structure::damped_modes::damped_modes;
use faer::linalg::solvers::Solve;
use faer::{Mat, c64};
use std::f64::consts::TAU;

/// (6.13), N s/m.
pub(crate) fn damping() -> Mat<f64> {
    let mut c = Mat::zeros(5, 5);
    for (i, j, value) in [
        (0, 0, 2.0413),
        (1, 1, 4.0066),
        (2, 2, 4.0066),
        (1, 2, -1.9652),
        (3, 3, 2.3693),
        (4, 4, 2.3693),
        (3, 4, -0.3280),
    ] {
        c[(i, j)] = value;
        c[(j, i)] = value;
    }
    c
}

pub(crate) fn scaled(c: &Mat<f64>, factor: f64) -> Mat<f64> {
    Mat::from_fn(c.nrows(), c.ncols(), |i, j| factor * c[(i, j)])
}

pub(crate) fn modal(structure: &Structure, c: &Mat<f64>, count: usize) -> ModalData {
    let matrices = structure.matrices().unwrap();
    let modes = damped_modes(matrices.mass.as_ref(), matrices.stiffness.as_ref(), c.as_ref()).unwrap();
    ModalData::from_modes(&modes, count)
}

/// The same modes at scales of no meaning, as a test without a drive point gives them.
pub(crate) fn unscaled(modes: &ModalData) -> ModalData {
    let factor = |p: usize| c64::from_polar(0.3 + p as f64, 0.7 * p as f64 + 0.2);
    let shapes = Mat::from_fn(modes.degrees(), modes.len(), |i, p| modes.shapes[(i, p)] * factor(p));
    ModalData { poles: modes.poles.clone(), shapes, scaled: false }
}

/// Receptance by an LU of its own, `[K + i (w C + D) - w^2 M]^-1`.
pub(crate) fn receptance(structure: &Structure, c: &Mat<f64>, d: &Mat<f64>, lines_hz: &[f64]) -> ReceptanceData {
    let matrices = structure.matrices().unwrap();
    let n = structure.len();
    let on_line = |hz: &f64| {
        let w = TAU * hz;
        let z = Mat::from_fn(n, n, |i, j| {
            let re = matrices.stiffness[(i, j)] - w * w * matrices.mass[(i, j)];
            c64::new(re, w * c[(i, j)] + d[(i, j)])
        });
        let identity = Mat::from_fn(n, n, |i, j| c64::new(f64::from(u8::from(i == j)), 0.0));
        z.partial_piv_lu().solve(identity)
    };
    ReceptanceData {
        omega: lines_hz.iter().map(|hz| TAU * hz).collect(),
        matrices: lines_hz.iter().map(on_line).collect(),
    }
}

/// Lines over the band of the five modes.
pub(crate) fn lines() -> Vec<f64> {
    (0..60).map(|k| 15.3 + f64::from(k)).collect()
}

/// The motion under a unit force at one DOF.
pub(crate) fn loads(receptance: &ReceptanceData, drive: usize) -> Vec<LoadCase> {
    let n = receptance.degrees();
    let lines = receptance.omega.iter().zip(&receptance.matrices);
    lines
        .map(|(&omega, h)| LoadCase {
            omega,
            force: (0..n).map(|i| c64::new(f64::from(u8::from(i == drive)), 0.0)).collect(),
            displacement: (0..n).map(|i| h[(i, drive)]).collect(),
        })
        .collect()
}

/// `|A - B| / |B|`, Frobenius.
pub(crate) fn distance(a: &Mat<f64>, b: &Mat<f64>) -> f64 {
    (a - b).norm_l2() / b.norm_l2()
}

#[track_caller]
pub(crate) fn assert_exact(found: &Mat<f64>, expected: &Mat<f64>) {
    let error = distance(found, expected);
    assert!(error < 1e-6, "relative error {error:.2e}\n{found:?}");
}
