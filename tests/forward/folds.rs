//! Turning points: Duffing's oscillator against its backbone and fold, all branches, stability against time stepping.

use super::support::{cantilever, elastic, five_masses, source, whole};
use crate::common::models::oscillator;
use dashpot::control::Control;
use dashpot::effects::{Effect, Source};
use dashpot::response::harmonic_balance::{
    Excitation, ForwardModel, Settings, Sweep, SweepEnd, SweepSettings, branches, multipliers, sweep,
};
use dashpot::response::time_integration::{Settling, TimeModel};
use dashpot::structure::Structure;
use faer::c64;
use std::f64::consts::TAU;

const M: f64 = 1.0;
const C: f64 = 0.1;
const K: f64 = 1.0;
const K3: f64 = 0.5;

fn duffing() -> Vec<Source> {
    vec![source(Effect::Viscous, &[0], &[C]), source(Effect::CubicStiffness, &[0], &[K3])]
}

/// With one harmonic the balance is `F^2 = A^2 ((k - m w^2 + 3/4 k3 A^2)^2 + (c w)^2)`: amplitudes `A` at `w`, by
/// bisection between the sign changes on a fine grid.
fn amplitudes(force: f64, w: f64) -> Vec<f64> {
    let gap = |a: f64| a * ((K - M * w * w + 0.75 * K3 * a * a).hypot(C * w)) - force;
    let grid: Vec<f64> = (0..20_000).map(|i| f64::from(i) * 5e-4).collect();
    let mut roots = Vec::new();
    for pair in grid.windows(2).filter(|p| gap(p[0]) * gap(p[1]) <= 0.0) {
        let (mut low, mut high) = (pair[0], pair[1]);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if gap(low) * gap(middle) <= 0.0 { high = middle } else { low = middle }
        }
        roots.push(low);
    }
    roots
}

#[test]
fn one_harmonic_of_duffing_has_the_textbook_branches() {
    let (force, omega) = (0.4, 1.5);
    let model = ForwardModel::new(&oscillator(M, K), &duffing()).unwrap();
    let excitation = Excitation::sine(omega, 0, c64::new(force, 0.0));
    let settings = SweepSettings { harmonics: 1, ..SweepSettings::default() };
    let found = branches(&model, &excitation, [0.3, 3.0], &settings, &Control::unattended()).unwrap();
    let mut amplitude: Vec<f64> = found.iter().map(|p| p.response.amplitude(0, 1).norm()).collect();
    amplitude.sort_by(f64::total_cmp);
    let expected = amplitudes(force, omega);
    assert_eq!(expected.len(), 3, "the test's own numbers");
    assert_eq!(amplitude.len(), 3, "{amplitude:?} {expected:?}");
    for (a, e) in amplitude.iter().zip(&expected) {
        assert!((a - e).abs() < 1e-7 * e, "{a} {e}");
    }
    // The middle one is unstable, the others are not.
    for point in &found {
        let middle = (point.response.amplitude(0, 1).norm() - expected[1]).abs() < 1e-6;
        assert_eq!(point.stable, !middle);
    }
}

#[test]
fn the_peak_of_duffing_lies_on_its_backbone() {
    let model = ForwardModel::new(&oscillator(M, K), &duffing()).unwrap();
    let excitation = Excitation::sine(1.0, 0, c64::new(0.2, 0.0));
    let settings = SweepSettings { largest_step: 0.003, ..SweepSettings::default() };
    let curve = sweep(&model, &excitation, [0.5, 2.5], &settings, &Control::unattended()).unwrap();
    assert_eq!(curve.end, SweepEnd::Reached);
    let peak = curve
        .points
        .iter()
        .max_by(|a, b| a.response.amplitude(0, 1).norm().total_cmp(&b.response.amplitude(0, 1).norm()))
        .unwrap();
    let (a, w) = (peak.response.amplitude(0, 1).norm(), peak.response.omega);
    // Energy: F = c w A at the peak; backbone: k + 3/4 k3 A^2 = m w^2, to the order of the third harmonic.
    assert!((C * w * a / 0.2 - 1.0).abs() < 1e-2, "{}", C * w * a);
    assert!(((K + 0.75 * K3 * a * a) / (M * w * w) - 1.0).abs() < 2e-2);
    // Up the curve, back past the fold, and on: two turning points, between them unstable.
    let turns = curve.points.windows(2).filter(|p| p[0].stable != p[1].stable).count();
    assert_eq!(turns, 2);
    let backwards = curve.points.windows(2).filter(|p| p[1].response.omega < p[0].response.omega);
    assert!(backwards.map(|p| p[1].stable).filter(|s| *s).count() <= 2);
}

/// At a fold of one harmonic the number of amplitudes in closed form changes between one and three.
#[test]
fn the_folds_of_duffing_are_where_its_closed_form_folds() {
    let force = 0.4;
    let model = ForwardModel::new(&oscillator(M, K), &duffing()).unwrap();
    let excitation = Excitation::sine(1.0, 0, c64::new(force, 0.0));
    let settings = SweepSettings { harmonics: 1, largest_step: 2e-3, ..SweepSettings::default() };
    let curve = sweep(&model, &excitation, [0.5, 3.0], &settings, &Control::unattended()).unwrap();
    let omega: Vec<f64> = curve.points.iter().map(|p| p.response.omega).collect();
    let folds: Vec<f64> = omega.windows(3).filter(|w| (w[1] - w[0]) * (w[2] - w[1]) < 0.0).map(|w| w[1]).collect();
    assert_eq!(folds.len(), 2, "{folds:?}");
    for fold in folds {
        let count = |share: f64| amplitudes(force, fold * share).len();
        let mut sides = [count(1.0 - 1e-3), count(1.0 + 1e-3)];
        sides.sort_unstable();
        assert_eq!(sides, [1, 3], "fold at {fold}");
    }
}

#[test]
fn both_stable_branches_hold_in_time_and_the_unstable_one_does_not() {
    let model = ForwardModel::new(&oscillator(M, K), &duffing()).unwrap();
    let excitation = Excitation::sine(1.5, 0, c64::new(0.4, 0.0));
    let settings = SweepSettings { harmonics: 9, ..SweepSettings::default() };
    let found = branches(&model, &excitation, [0.3, 3.0], &settings, &Control::unattended()).unwrap();
    assert_eq!(found.iter().filter(|p| p.stable).count(), 2);
    for point in &found {
        let mut time = TimeModel::new(&oscillator(M, K), &duffing(), &excitation, 2000).unwrap();
        time.start_from(&point.response);
        let waiting = Settling { accelerate: false, tolerance: 1e-7, most_periods: 400 };
        time.settle(&waiting, &Control::unattended()).unwrap();
        let settled = time.harmonics(1).unwrap()[(0, 0)];
        let stays = (settled - point.response.amplitude(0, 1)).norm() < 1e-3 * settled.norm();
        assert_eq!(stays, point.stable, "{settled} {}", point.response.amplitude(0, 1));
    }
}

#[test]
fn multipliers_of_a_linear_structure_are_those_of_its_damped_modes() {
    let structure = five_masses();
    // A cubic spring too weak to matter makes the response nonlinear in name only.
    let sources = [whole(Effect::MassProportional, 2.0), source(Effect::CubicStiffness, &[0], &[1e-9])];
    let model = ForwardModel::new(&structure, &sources).unwrap();
    let excitation = Excitation::sine(100.0, 0, c64::new(1.0, 0.0));
    let response = model.respond(&excitation, &Settings::default(), None, &Control::unattended()).unwrap();
    let found = multipliers(&model.at(100.0), &sources, &excitation, &response).unwrap();
    // With alpha M every mode decays as exp(-alpha t / 2).
    let expected = (-0.5 * 2.0 * TAU / 100.0_f64).exp();
    assert_eq!(found.len(), 10);
    assert!(found.iter().all(|m| (m.norm() - expected).abs() < 1e-9));
}

/// The beam with a cubic spring at its tip, damped by `beta` K and driven there by `force` N.
fn hardening_beam(beta: f64, force: f64) -> (Structure, Vec<Source>, Excitation) {
    let sources = vec![whole(Effect::StiffnessProportional, beta), source(Effect::CubicStiffness, &[8], &[5e6])];
    (cantilever(5), sources, Excitation::sine(60.0, 8, c64::new(force, 0.0)))
}

const BEAM_RANGE: [f64; 2] = [TAU * 6.0, TAU * 20.0];

/// Frequencies (rad/s) at which the curve turns back.
fn turns(curve: &Sweep) -> Vec<f64> {
    let omega: Vec<f64> = curve.points.iter().map(|p| p.response.omega).collect();
    omega.windows(3).filter(|w| (w[1] - w[0]) * (w[2] - w[1]) < 0.0).map(|w| w[1]).collect()
}

/// With damping of 0.07 % the peak is a thousand times as high as wide.
#[test]
fn a_sweep_of_a_hardly_damped_beam_passes_its_folds() {
    for (beta, force) in [(2e-4, 0.03), (2e-5, 0.003), (4e-6, 0.003)] {
        let (structure, sources, excitation) = hardening_beam(beta, force);
        let model = ForwardModel::new(&structure, &sources).unwrap();
        let control = Control::unattended();
        let curve = sweep(&model, &excitation, BEAM_RANGE, &SweepSettings::default(), &control).unwrap();
        assert_eq!(curve.end, SweepEnd::Reached, "{beta}: {} points", curve.points.len());
        assert!(curve.points.len() < 1500, "{beta}: {} points", curve.points.len());
        let turns = turns(&curve);
        assert_eq!(turns.len(), 2, "{beta}: {turns:?}");
        assert!(turns[0] > turns[1]);
        let between = excitation.at(0.5 * (turns[0] + turns[1]));
        let found = branches(&model, &between, BEAM_RANGE, &SweepSettings::default(), &control).unwrap();
        let stable: Vec<bool> = found.iter().map(|p| p.stable).collect();
        assert_eq!(stable, [true, false, true], "{beta}");
        let amplitude: Vec<f64> = found.iter().map(|p| p.response.amplitude(8, 1).norm()).collect();
        assert!(amplitude[0] > amplitude[1] && amplitude[1] > amplitude[2], "{beta}: {amplitude:?}");
        // Energy per cycle: what the force puts in, the damping of the structure takes out.
        for point in &found {
            let input = force * -point.response.amplitude(8, 1).im;
            let lost = |h: usize| (h as f64).powi(2) * beta * between.omega * elastic(&structure, &point.response, h);
            let taken: f64 = (1..=7).map(lost).sum();
            assert!((taken / input - 1.0).abs() < 1e-5, "{beta}: {taken} {input}");
        }
    }
}

/// Stepped through time, both stable motions stay and a motion beside the unstable one leaves it.
#[test]
fn both_stable_motions_of_the_beam_hold_in_time() {
    let (structure, sources, excitation) = hardening_beam(2e-4, 0.03);
    let model = ForwardModel::new(&structure, &sources).unwrap();
    let control = Control::unattended();
    let curve = sweep(&model, &excitation, BEAM_RANGE, &SweepSettings::default(), &control).unwrap();
    let turns = turns(&curve);
    let excitation = excitation.at(0.4 * turns[0] + 0.6 * turns[1]);
    let found = branches(&model, &excitation, BEAM_RANGE, &SweepSettings::default(), &control).unwrap();
    assert_eq!(found.len(), 3);
    for point in &found {
        let mut time = TimeModel::new(&structure, &sources, &excitation, 500).unwrap();
        let (mut displacement, velocity) = point.response.state_at(0.0);
        displacement.iter_mut().for_each(|x| *x *= 1.02);
        time.start(&displacement, &velocity);
        (0..150 * 500).for_each(|_| time.advance().unwrap());
        let settled = time.harmonics(1).unwrap()[(8, 0)];
        let expected = point.response.amplitude(8, 1);
        let stays = (settled - expected).norm() < 5e-3 * expected.norm();
        assert_eq!(stays, point.stable, "{settled} {expected}");
    }
}
