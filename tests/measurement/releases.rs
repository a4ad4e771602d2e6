//! Where a decay begins in a record that begins before it.

use dashpot::measurement::{Channel, Flag, Kind, Quantity, Record, TimeSpan, TransientLabel, TransientRun};
use std::f64::consts::TAU;
use std::sync::Arc;

/// First instant (s) that is used of four seconds of a motion, with a force where there is one, and whether the record says so.
fn begun(
    quantity: Quantity,
    motion: &dyn Fn(f64) -> f64,
    force: Option<&dyn Fn(f64) -> f64>,
    part: TimeSpan,
) -> (f64, bool) {
    let time: Vec<f64> = (0..4000).map(|n| 0.001 * f64::from(n)).collect();
    let signal = |y: &dyn Fn(f64) -> f64| time.iter().map(|&t| y(t)).collect::<Vec<f64>>();
    let channel = |quantity| Channel { quantity, dof: 0, label: "1".into() };
    let channels = std::iter::once(quantity).chain(force.map(|_| Quantity::Force)).map(channel).collect();
    let samples = std::iter::once(signal(motion)).chain(force.map(signal)).collect();
    let record = Record::new(time.clone(), channels, samples).unwrap();
    let label = TransientLabel { file: "decay".into(), kind: Kind::Decay, enabled: true, part, ..Default::default() };
    let run = TransientRun::new(label, Arc::new(record), &[]).unwrap();
    (run.time()[0], run.findings.iter().any(|f| f.flag == Flag::BeforeRelease))
}

fn sine(t: f64) -> f64 {
    (TAU * 20.0 * t).sin()
}

#[test]
fn rest_a_drive_and_a_blow_before_a_release_are_left_out() {
    let waits = |t: f64| if t < 1.0 { 0.0 } else { sine(t) * (1.0 - t).exp() };
    let rings = |t: f64| if t < 2.0 { sine(t) } else { sine(t) * (2.0 * (2.0 - t)).exp() };
    let struck = |t: f64| if t < 0.5 { 0.0 } else { sine(t) * (0.5 - t).exp() };
    let hit = |t: f64| if (0.5..0.51).contains(&t) { 1.0 } else { 0.0 };
    let whole = TimeSpan::default();
    for (motion, force, [from, to]) in [
        (&waits as &dyn Fn(f64) -> f64, None, [1.0, 1.2]),
        (&rings, None, [1.96, 2.08]),
        (&struck, Some(&hit as &dyn Fn(f64) -> f64), [0.51, 0.7]),
    ] {
        let (start, said) = begun(Quantity::Acceleration, motion, force, whole);
        assert!(start >= from && start <= to && said, "{start} not in {from} to {to}");
    }
    // A displacement that is held and let go begins where it was largest.
    let held = |t: f64| if t < 1.0 { 0.002 } else { 0.002 * (TAU * 5.0 * (t - 1.0)).cos() * (2.0 * (1.0 - t)).exp() };
    let (start, said) = begun(Quantity::Displacement, &held, None, whole);
    assert!((0.96..1.1).contains(&start) && said, "{start}");
}

#[test]
fn a_decay_that_begins_at_once_keeps_its_beginning() {
    let decay = |t: f64| sine(t) * (-1.5 * t).exp();
    let slow = |t: f64| sine(t) * (-0.2 * t).exp();
    let beats = |t: f64| (TAU * 1.2 * t).cos() * sine(t) * (-0.1 * t).exp();
    let stops = |t: f64| sine(t) * (1.0 - 0.3 * t).max(0.0);
    for motion in [&decay as &dyn Fn(f64) -> f64, &slow, &beats, &stops] {
        assert_eq!(begun(Quantity::Acceleration, motion, None, TimeSpan::default()), (0.0, false));
    }
}

/// Whoever says where it begins is not corrected.
#[test]
fn a_given_start_stands() {
    let waits = |t: f64| if t < 1.0 { 0.0 } else { sine(t) * (1.0 - t).exp() };
    let part = TimeSpan { start_s: Some(0.5), end_s: None };
    assert_eq!(begun(Quantity::Acceleration, &waits, None, part), (0.5, false));
}
