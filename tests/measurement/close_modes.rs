//! Two modes that a record is too short to tell apart are named where the motion is free; lines of a force are no modes.

use dashpot::measurement::{Channel, Flag, Kind, Quantity, Record, TransientLabel, TransientRun};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Whether four seconds (lines of 0.25 Hz) of a motion of two modes at these frequencies, Hz, are said to be too short, with the
/// force that acts.
fn is_too_short(frequencies: [f64; 2], force: &dyn Fn(f64) -> f64, kind: Kind) -> bool {
    let time: Vec<f64> = (0..4000).map(|n| 0.001 * f64::from(n)).collect();
    let motion = |t: f64| frequencies.iter().map(|f| (TAU * f * t).sin()).sum::<f64>() * (-0.3 * t).exp();
    let channel = |quantity| Channel { quantity, dof: 0, label: "1".into() };
    let samples = vec![time.iter().map(|&t| motion(t)).collect(), time.iter().map(|&t| force(t)).collect()];
    let channels = vec![channel(Quantity::Displacement), channel(Quantity::Force)];
    let record = Record::new(time, channels, samples).unwrap();
    let label = TransientLabel { file: "record".into(), kind, enabled: true, ..Default::default() };
    let run = TransientRun::new(label, Arc::new(record), &[]).unwrap();
    run.findings.iter().any(|f| f.flag == Flag::TooShort)
}

#[test]
fn modes_between_few_lines_of_a_free_motion_are_told_and_no_others() {
    let none = |_: f64| 0.0;
    assert!(is_too_short([20.0, 20.8], &none, Kind::Decay));
    assert!(!is_too_short([20.0, 23.0], &none, Kind::Decay));
    let blow = |t: f64| if t < 0.005 { (TAU * 100.0 * t).sin() } else { 0.0 };
    assert!(is_too_short([20.0, 20.8], &blow, Kind::Transient));
    // Under a multisine the response has the lines of the force.
    let multisine = |t: f64| (60..100).map(|k| (TAU * 0.25 * f64::from(k) * t + f64::from(k * k)).sin()).sum::<f64>();
    assert!(!is_too_short([20.0, 20.8], &multisine, Kind::Transient));
}
