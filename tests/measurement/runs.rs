//! Runs: known errors taken out, motions integrated, channels at one DOF combined.

use crate::signals::{Signal, even, record, z};
use dashpot::measurement::{Channel, ChannelCorrection, Quantity, Run};
use faer::c64;
use std::f64::consts::TAU;
use std::sync::Arc;

const FREQUENCY_HZ: f64 = 10.0;

fn motion(quantity: Quantity, dof: usize, noise: f64, delay: f64, gain: f64) -> Signal {
    let omega = TAU * FREQUENCY_HZ;
    let truth = displacement();
    let k = quantity.derivatives().unwrap_or(0);
    let recorded: Vec<c64> = truth
        .iter()
        .enumerate()
        .map(|(i, x)| {
            let w = (i + 1) as f64 * omega;
            *x * z(0.0, w).powi(k) * z(0.0, -w * delay).exp() * gain
        })
        .collect();
    Signal::new(quantity, dof, &recorded, noise)
}

fn displacement() -> Vec<c64> {
    vec![z(1e-3, -2e-4), z(1e-5, 3e-5)]
}

fn run(signals: &[Signal], corrections: &[ChannelCorrection]) -> Run {
    let record = Arc::new(record(signals, FREQUENCY_HZ, even(2000, 1000.0), 2));
    Run::from_record("run.csv".to_owned(), None, true, record, Some(FREQUENCY_HZ), 2, corrections).unwrap()
}

fn close(found: &[c64], expected: &[c64]) -> bool {
    found.iter().zip(expected).all(|(a, b)| (a - b).re.hypot((a - b).im) < 1e-12 * 1e-3)
}

#[test]
fn every_quantity_becomes_the_same_displacement() {
    for quantity in [Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration] {
        let run = run(&[motion(quantity, 3, 0.0, 0.0, 1.0)], &[]);
        assert!(close(&run.fit.displacement(3).unwrap().amplitudes, &displacement()), "{quantity:?}");
        assert!(run.fit.displacement(2).is_none() && run.fit.force(3).is_none());
    }
}

#[test]
fn known_errors_are_taken_out_with_their_effect_on_the_deviation() {
    let signals = [motion(Quantity::Acceleration, 3, 0.0, 1e-3, 1.1)];
    let channel = Channel { quantity: Quantity::Acceleration, dof: 3, label: "4".to_owned() };
    let correction = ChannelCorrection { channel, delay: 1e-3, gain: 1.1 };
    let wrong = run(&signals, &[]);
    let right = run(&signals, std::slice::from_ref(&correction));
    assert!(!close(&wrong.fit.displacement(3).unwrap().amplitudes, &displacement()));
    assert!(close(&right.fit.displacement(3).unwrap().amplitudes, &displacement()));
    let ratio = wrong.fit.channels[0].deviation(2) / right.fit.channels[0].deviation(2);
    assert!((ratio - 1.1).abs() < 1e-9);
}

#[test]
fn two_sensors_at_one_dof_are_weighted_by_their_noise() {
    let signals = [motion(Quantity::Displacement, 3, 1e-4, 0.0, 1.0), motion(Quantity::Velocity, 3, 1e-4, 0.0, 1.0)];
    let run = run(&signals, &[]);
    assert_eq!(run.response_channels().len(), 2);
    let [first, second] = [0, 1].map(|c| run.fit.displacement_of(c));
    let both = run.fit.displacement(3).unwrap();
    let variance = |a: &dashpot::measurement::Amplitudes| a.covariance[(0, 0)] + a.covariance[(1, 1)];
    let expected = 1.0 / (1.0 / variance(&first) + 1.0 / variance(&second));
    assert!((variance(&both) / expected - 1.0).abs() < 1e-9);
}

#[test]
fn the_frequency_is_found_where_none_is_given() {
    let record =
        Arc::new(record(&[motion(Quantity::Velocity, 0, 1e-4, 0.0, 1.0)], FREQUENCY_HZ, even(2000, 1000.0), 2));
    let run = Run::from_record("run.csv".to_owned(), Some(2), true, record, None, 2, &[]).unwrap();
    assert!((run.frequency_hz() - FREQUENCY_HZ).abs() < 1e-3);
    assert!(run.fit.omega_deviation > 0.0);
    assert!(run.noise_ratio > 1e-4 && run.noise_ratio < 1e-2);
}

#[test]
fn deviations_of_displacements_are_those_found_by_many_records() {
    let (mut squares, seeds) = (0.0, 300);
    for seed in 0..seeds {
        let signals = [motion(Quantity::Acceleration, 0, 0.2, 0.0, 1.0)];
        let record = Arc::new(record(&signals, FREQUENCY_HZ, even(400, 1000.0), seed));
        let run = Run::from_record(String::new(), None, true, record, Some(FREQUENCY_HZ), 2, &[]).unwrap();
        let found = run.fit.displacement(0).unwrap();
        squares += (found.amplitudes[0].re - displacement()[0].re).powi(2) / found.covariance[(0, 0)] / seeds as f64;
    }
    assert!((squares.sqrt() - 1.0).abs() < 0.13, "{}", squares.sqrt());
}
