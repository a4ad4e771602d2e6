//! Laws regressed on the decay of two masses, followed by the classical method of Runge and Kutta in steps of its own.
#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::common::models::{chain, source};
use crate::common::runs::decay;
use crate::common::runs::uniform;

const MASSES: [f64; 2] = [2.0, 1.0];
const GROUND: f64 = 1800.0;
const COUPLING: f64 = 1500.0;
/// Known dashpot of the first mass, N s/m.
const KNOWN: f64 = 0.3;
const STEP: f64 = 4e-3;
const SAMPLES: usize = 3000;
/// Steps a sample.
const FINE: usize = 8;

/// Displacements of both masses from rest at `start`, with a force `law(d, v)` that holds back the second one.
fn free_motion(start: [f64; 2], law: impl Fn(f64, f64) -> f64) -> Vec<Vec<f64>> {
    let slope = |[x, y, u, v]: [f64; 4]| {
        let between = COUPLING * (x - y);
        [u, v, (-GROUND * x - between - KNOWN * u) / MASSES[0], (between - law(y, v)) / MASSES[1]]
    };
    let moved = |s: [f64; 4], k: [f64; 4], h: f64| [0, 1, 2, 3].map(|i| s[i] + h * k[i]);
    let h = STEP / FINE as f64;
    let mut state = [start[0], start[1], 0.0, 0.0];
    let mut rows = vec![Vec::new(); 2];
    let mut uniform = uniform(1);
    for _ in 0..SAMPLES {
        for (row, x) in rows.iter_mut().zip(state) {
            row.push(x + 2e-6 * uniform());
        }
        for _ in 0..FINE {
            let a = slope(state);
            let b = slope(moved(state, a, 0.5 * h));
            let c = slope(moved(state, b, 0.5 * h));
            let d = slope(moved(state, c, h));
            state = [0, 1, 2, 3].map(|i| state[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
    }
    rows
}

/// Checks that the regression of the decay finds the hidden source before all others and its coefficient to `tolerance`.
fn check(hidden: &Source, law: impl Fn(f64, f64) -> f64, tolerance: f64) {
    let structure = chain(&MASSES, &[GROUND, 0.0], &[COUPLING]);
    let run = decay(STEP, free_motion([0.01, 0.004], law));
    let known = [source(Effect::Viscous, &[0], &[KNOWN])];
    let records = Records::new(&structure, &known, std::slice::from_ref(&run)).unwrap();
    let control = Control::unattended();
    let regression = Regression::new(&records, &FittedRecords::start(&records, &[]), &control).unwrap();
    let places = [vec![0], vec![1], vec![0, 1]].map(Place::Dofs);
    let laws = [Effect::Viscous, Effect::Coulomb, Effect::Quadratic, Effect::CubicStiffness, Effect::Power];
    let ranked = regression.ranked(&places, &laws, &control);
    let best = &ranked[0];
    assert!(best.source.is_same(hidden), "{:?} before {hidden:?}", best.source);
    for (found, truth) in best.source.parameters.iter().zip(&hidden.parameters) {
        assert!((found / truth - 1.0).abs() < tolerance, "{found} for {truth}");
    }
    // What it leaves is the noise, or what the band of the filter does not hold; without it much more is left.
    let (with, without, rows) = (best.misfit, regression.misfit(), regression.rows() as f64);
    assert!(with < (1.3 * rows).max(0.1 * without) && without > with + 100.0, "{with} of {without} in {rows} rows");
    without_nuisances(&regression, &best.source, 0.1 * tolerance);
}

/// What is said of the nuisances beside the law: that there are none.
fn without_nuisances(regression: &Regression, law: &Source, tolerance: f64) {
    let [modes, sizes, _] = regression.corrections(Some(law)).unwrap();
    let none = modes.iter().all(|x| x.abs() < tolerance) && sizes.iter().all(|x| x.abs() < 0.05);
    assert!(none, "{modes:?} {sizes:?}");
}

#[test]
fn a_hidden_law_is_regressed_from_a_decay_by_runge_and_kutta() {
    check(&source(Effect::Viscous, &[1], &[0.4]), |_, v| 0.4 * v, 0.02);
    check(&source(Effect::Quadratic, &[1], &[4.0]), |_, v| 4.0 * v * v.abs(), 0.02);
    // Of a spring the stiffness of the modes, which is free beside it, takes a share.
    check(&source(Effect::CubicStiffness, &[1], &[3e5]), |d, _| 3e5 * d.powi(3), 0.15);
}
