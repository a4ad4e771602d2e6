//! The branch of Duffing's oscillator, by one harmonic: `F^2 = a^2 ((k - m w^2 + 3/4 k3 a^2)^2 + (w c)^2)`, a cubic in `a^2`.
#![allow(clippy::unwrap_used, reason = "tests")]

use super::{nearest, settings};
use crate::common::models::{oscillator, source};
use crate::common::runs::displacements_run;
use crate::control::Control;
use crate::diagnosis::Problem;
use crate::diagnosis::residual::data::Data;
use crate::diagnosis::residual::prediction::Predictor;
use crate::effects::Effect;
use faer::c64;

const MASS: f64 = 1.0;
const STIFFNESS: f64 = 1.0;
const DASHPOT: f64 = 0.1;
/// So small that the third harmonic is at most a sixtieth of the first.
const CUBIC: f64 = 0.05;
const FORCE: f64 = 0.5;
const OMEGA: f64 = 1.2;

/// Amplitude for which the balance of forces has this difference.
fn gap(amplitude: f64) -> f64 {
    amplitude * (STIFFNESS - MASS * OMEGA * OMEGA + 0.75 * CUBIC * amplitude * amplitude).hypot(OMEGA * DASHPOT) - FORCE
}

/// All amplitudes, the smallest first, by bisection between changes of sign.
fn amplitudes() -> Vec<f64> {
    let grid: Vec<f64> = (0..20_000).map(|i| f64::from(i) * 5e-4).collect();
    let crossing = |pair: &&[f64]| gap(pair[0]) * gap(pair[1]) <= 0.0;
    let refined = |pair: &[f64]| {
        let (mut low, mut high) = (pair[0], pair[1]);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if gap(low) * gap(middle) <= 0.0 { high = middle } else { low = middle }
        }
        low
    };
    grid.windows(2).filter(crossing).map(refined).collect()
}

/// The complex amplitude of a motion that large.
fn motion(amplitude: f64) -> c64 {
    let stiffness = STIFFNESS - MASS * OMEGA * OMEGA + 0.75 * CUBIC * amplitude * amplitude;
    c64::new(FORCE, 0.0) / c64::new(stiffness, OMEGA * DASHPOT)
}

#[test]
fn a_measured_motion_is_compared_with_its_own_branch() {
    let found = amplitudes();
    assert_eq!(found.len(), 3, "the test's own numbers: {found:?}");
    let structure = oscillator(MASS, STIFFNESS);
    let sources = [source(Effect::Viscous, &[0], &[DASHPOT]), source(Effect::CubicStiffness, &[0], &[CUBIC])];
    for (amplitude, name, number) in [(found[0], "lower", 0), (found[2], "upper", 1)] {
        // Read 3 % too large: still nearest to its own.
        let runs = [displacements_run(OMEGA, (0, FORCE), &[motion(amplitude) * 1.03], 1e-3)];
        let problem = Problem { structure: &structure, sources: &sources, runs: &runs };
        let data = Data::new(&problem).unwrap();
        let predictor = Predictor::new(&structure, sources.to_vec(), &data).unwrap();
        let (prediction, branch) = nearest(&predictor, 0, &data.runs[0], &[], &Control::unattended()).unwrap();
        let branch = branch.unwrap();
        assert_eq!((branch.name().as_str(), branch.number, branch.stable, branch.all), (name, number, 2, 3));
        let x = prediction.response.amplitude(0, 1);
        assert!((x - motion(amplitude)).norm() < 0.05 * amplitude, "{name}: {x} for {}", motion(amplitude));
    }
}

/// About the force at which the lower two motions meet, where a step of the path over the force passes both at once, the upper one and the
/// one from rest are found all the same, and what was measured is compared with the upper one.
#[test]
fn the_upper_motion_is_found_where_the_lower_two_meet() {
    let force = |a: f64| gap(a) + FORCE;
    let grid: Vec<f64> = (0..40_000).map(|i| f64::from(i) * 1e-4).collect();
    let fold = grid.windows(3).find(|a| force(a[1]) > force(a[0]) && force(a[1]) > force(a[2])).unwrap()[1];
    let structure = oscillator(MASS, STIFFNESS);
    let sources = [source(Effect::Viscous, &[0], &[DASHPOT]), source(Effect::CubicStiffness, &[0], &[CUBIC])];
    for k in 0..60 {
        let at = force(fold) * (1.0 + 1e-4 * f64::from(k - 40));
        let upper = (1..20_000).map(|i| 20.0 - 1e-3 * f64::from(i)).find(|a| force(*a) < at).unwrap();
        let measured = motion(upper) / FORCE * at;
        let runs = [displacements_run(OMEGA, (0, at), &[measured], 1e-3)];
        let problem = Problem { structure: &structure, sources: &sources, runs: &runs };
        let data = Data::new(&problem).unwrap();
        let predictor = Predictor::new(&structure, sources.to_vec(), &data).unwrap();
        let (run, control) = (&data.runs[0], Control::unattended());
        let all = predictor.branches(0, run, &[], &settings(run), &control).unwrap();
        let is_upper = |x: c64| (x - measured).norm() < 0.05 * upper;
        let amplitudes: Vec<c64> = all.iter().map(|(found, _)| found.response.amplitude(0, 1)).collect();
        assert!(amplitudes.iter().any(|x| is_upper(*x)), "{k}: {at} N: {amplitudes:?} without {measured}");
        let (prediction, _) = nearest(&predictor, 0, run, &[], &control).unwrap();
        assert!(is_upper(prediction.response.amplitude(0, 1)), "{k}: {at} N");
    }
}

/// Where there is one motion there is no branch to name.
#[test]
fn a_single_motion_has_no_branch() {
    let structure = oscillator(MASS, STIFFNESS);
    let sources = [source(Effect::Viscous, &[0], &[DASHPOT])];
    let runs = [displacements_run(OMEGA, (0, FORCE), &[motion(0.0)], 1e-3)];
    let problem = Problem { structure: &structure, sources: &sources, runs: &runs };
    let data = Data::new(&problem).unwrap();
    let predictor = Predictor::new(&structure, sources.to_vec(), &data).unwrap();
    let (prediction, branch) = nearest(&predictor, 0, &data.runs[0], &[], &Control::unattended()).unwrap();
    assert!(branch.is_none());
    assert!((prediction.response.amplitude(0, 1) - motion(0.0)).norm() < 1e-9);
}
