//! The branch of Duffing's oscillator, by one harmonic: `F^2 = a^2 ((k - m w^2 + 3/4 k3 a^2)^2 + (w c)^2)`, a cubic in `a^2`.
#![allow(clippy::unwrap_used, reason = "tests")]

use super::{Motion, measured, nearest, settings};
use crate::common::models::{oscillator, source};
use crate::common::runs::{channel, displacements_run, run};
use crate::control::Control;
use crate::diagnosis::Problem;
use crate::diagnosis::residual::data::Data;
use crate::diagnosis::residual::prediction::Predictor;
use crate::effects::Effect;
use crate::measurement::Quantity;
use faer::c64;
use std::f64::consts::TAU;

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

/// Resistance of the exciter, N s/m: its force under a constant voltage is `A cos w t - Z v`.
const IMPEDANCE: f64 = 1.0;
const STEPS: usize = 500;
const PERIODS: usize = 120;

/// Fundamental and two harmonics of force (N) and displacement (m) in the last period on such an exciter: Runge and Kutta's
/// fourth order from rest.
fn on_exciter(drive: f64) -> [Vec<c64>; 2] {
    let step = TAU / OMEGA / STEPS as f64;
    let force = |t: f64, v: f64| drive * (OMEGA * t).cos() - IMPEDANCE * v;
    let slope = |t: f64, [x, v]: [f64; 2]| [v, (force(t, v) - DASHPOT * v - STIFFNESS * x - CUBIC * x.powi(3)) / MASS];
    let add = |a: [f64; 2], b: [f64; 2], times: f64| [a[0] + times * b[0], a[1] + times * b[1]];
    let (mut state, mut found) = ([0.0; 2], [vec![c64::new(0.0, 0.0); 3], vec![c64::new(0.0, 0.0); 3]]);
    for k in 0..PERIODS * STEPS {
        let t = k as f64 * step;
        if k >= (PERIODS - 1) * STEPS {
            for (values, now) in found.iter_mut().zip([force(t, state[1]), state[0]]) {
                for (h, value) in values.iter_mut().enumerate() {
                    let angle = -((h + 1) as f64) * OMEGA * t;
                    *value += c64::new(angle.cos(), angle.sin()) * (2.0 * now / STEPS as f64);
                }
            }
        }
        let first = slope(t, state);
        let second = slope(t + 0.5 * step, add(state, first, 0.5 * step));
        let third = slope(t + 0.5 * step, add(state, second, 0.5 * step));
        let fourth = slope(t + step, add(state, third, step));
        for (derivative, share) in [(first, 1.0), (second, 2.0), (third, 2.0), (fourth, 1.0)] {
            state = add(state, derivative, share * step / 6.0);
        }
    }
    found
}

/// An exciter whose force yields to the motion holds the middle motion, which no constant force does: it is the one compared.
#[test]
fn a_motion_that_an_exciter_held_is_compared_though_it_is_unstable_under_a_constant_force() {
    let middle = amplitudes()[1];
    let drive = (c64::new(FORCE, 0.0) + motion(middle) * c64::new(0.0, OMEGA * IMPEDANCE)).norm();
    let [force, displacement] = on_exciter(drive);
    assert!((displacement[0].norm() / middle - 1.0).abs() < 0.05, "the test's own numbers: {displacement:?}, {middle}");
    let structure = oscillator(MASS, STIFFNESS);
    // A model that is exact, and one that is 1 % off.
    for off in [1.0, 1.01] {
        let sources = [source(Effect::Viscous, &[0], &[DASHPOT]), source(Effect::CubicStiffness, &[0], &[off * CUBIC])];
        let channels = vec![
            channel(Quantity::Force, 0, force.clone(), 1e-4),
            channel(Quantity::Displacement, 0, displacement.clone(), 1e-4),
        ];
        let runs = [run("on an exciter".into(), OMEGA, channels)];
        let problem = Problem { structure: &structure, sources: &sources, runs: &runs };
        let data = Data::new(&problem).unwrap();
        let predictor = Predictor::new(&structure, sources.to_vec(), &data).unwrap();
        let (prediction, branch) = nearest(&predictor, 0, &data.runs[0], &[], &Control::unattended()).unwrap();
        let branch = branch.unwrap();
        assert_eq!((branch.name().as_str(), branch.held, branch.stable, branch.all), ("middle", true, 2, 3), "{off}");
        let error = (prediction.response.amplitude(0, 1) - displacement[0]).norm() / displacement[0].norm();
        assert!(error < 3.0 * (off - 1.0) + 1e-3, "{off}: {error}");
    }
}

/// A model that is wrong passes near any motion by chance: an unstable one is taken only where it is clearly the one measured.
#[test]
fn in_doubt_a_stable_motion_is_compared() {
    let chosen = |errors: [f64; 3]| {
        let motion = |k: usize| Motion { stable: k != 1, size: 1.0 + k as f64, error: errors[k] };
        let (number, branch) = measured(&[motion(0), motion(1), motion(2)]);
        assert_eq!(branch.held, number == 1);
        (number, branch.name())
    };
    assert_eq!(chosen([0.8, 0.01, 0.5]), (1, "middle".to_owned()));
    // Both are far: the model is wrong. The stable one is as near as models are, or nearly as near: a fold.
    assert_eq!(chosen([0.9, 0.15, 0.6]), (2, "upper".to_owned()));
    assert_eq!(chosen([0.9, 0.001, 0.05]), (2, "upper".to_owned()));
    assert_eq!(chosen([0.2, 0.08, 0.9]), (0, "lower".to_owned()));
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
