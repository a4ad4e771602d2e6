//! The rows themselves against what the integrator knows.

use crate::support::{Case, cases, sweep};
use dashpot::balance::windows::window_rows;
use dashpot::control::Control;
use dashpot::effects::{Effect, Source};
use dashpot::measurement::{Channel, Quantity};
use dashpot::response::recording::{TestSetup, record_test};

/// Work of the true sources between two instants, from velocities that the integrator gives at every sample.
fn work(case: &Case, [from, to]: [f64; 2]) -> f64 {
    let dofs: Vec<usize> = case.truth.iter().map(|s| s.place.legs()[0].first).collect();
    let channels: Vec<Channel> = dofs
        .iter()
        .map(|&dof| Channel { quantity: Quantity::Velocity, dof, label: case.structure.label(dof).to_owned() })
        .collect();
    let setup = TestSetup {
        loading: &case.loading,
        dof: case.dof,
        channels: &channels,
        sensors: &[],
        rate_hz: 8.0 * case.rate_hz,
        samples: 8 * case.samples,
        filter: false,
    };
    let made = record_test(&case.structure, &case.truth, &setup, &Control::unattended()).unwrap();
    let step = made.time[1];
    let power = |source: &Source, v: f64| match source.effect {
        Effect::Viscous => source.coefficient() * v * v,
        _ => source.coefficient() * v.abs(),
    };
    let inside = (0..made.time.len()).filter(|&n| made.time[n] >= from && made.time[n] < to);
    inside.map(|n| case.truth.iter().enumerate().map(|(k, s)| power(s, made.samples[k][n])).sum::<f64>()).sum::<f64>()
        * step
}

#[test]
fn windows_hold_the_energy_that_the_sources_take_out() {
    for case in cases() {
        let run = case.run(&case.clean(), 0.0, 0);
        let rows = window_rows(&case.structure, &[], &case.truth, &[&run], &Control::unattended()).unwrap().remove(0);
        let span = [rows.span_s[0][0], rows.span_s[rows.len() - 1][1]];
        let coefficients: Vec<f64> = case.truth.iter().map(Source::coefficient).collect();
        let taken: f64 = (0..rows.len())
            .map(|k| (0..coefficients.len()).map(|j| rows.g[(k, j)] * coefficients[j]).sum::<f64>())
            .sum();
        let given: f64 = rows.e.iter().sum();
        let truth = work(&case, span);
        println!("{}: {span:?} {} rows: given {given:.6e} taken {taken:.6e} truth {truth:.6e}", case.name, rows.len());
        assert!((given / truth - 1.0).abs() < 0.03, "{}", case.name);
        assert!((taken / truth - 1.0).abs() < 0.03, "{}", case.name);
    }
}

/// Between its resonances a sweep sinks into the noise: the windows end there and go on at the next one. Linear from 10 to 130 Hz in
/// 24 s, it passes the lower one before 5 s and the upper one at 18 s.
#[test]
fn windows_of_a_sweep_reach_its_second_resonance() {
    let case = sweep();
    let run = case.run(&case.clean(), 0.006, 1);
    let rows = window_rows(&case.structure, &[], &case.truth, &[&run], &Control::unattended()).unwrap().remove(0);
    let gap = rows.span_s.windows(2).find(|pair| pair[1][0] > pair[0][1] + 1.0);
    println!("{:?} to {:?}, gap {gap:?}, {} rows", rows.span_s[0], rows.span_s[rows.len() - 1], rows.len());
    assert!(
        gap.is_some_and(|pair| pair[0][1] < 8.0 && pair[1][0] < 18.0),
        "the motion sinks into the noise between the resonances"
    );
    assert!(rows.span_s[rows.len() - 1][1] > 18.5);
    // What the dashpots take out beyond the gap is the work of the force there.
    let beyond: Vec<usize> = (0..rows.len()).filter(|&k| rows.span_s[k][0] > 17.0).collect();
    let coefficients: Vec<f64> = case.truth.iter().map(Source::coefficient).collect();
    let taken: f64 = beyond.iter().map(|&k| (0..2).map(|j| rows.g[(k, j)] * coefficients[j]).sum::<f64>()).sum();
    let given: f64 = beyond.iter().map(|&k| rows.e[k]).sum();
    assert!((given / taken - 1.0).abs() < 0.1, "{given} {taken}");
}
