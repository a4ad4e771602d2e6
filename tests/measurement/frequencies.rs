//! The frequency found in a record.

use crate::signals::{Signal, beam, even, record, z};
use dashpot::measurement::{Channel, FitError, Quantity, Record, frequency::estimate};
use std::f64::consts::TAU;

#[test]
fn without_noise_the_frequency_is_exact() {
    for (frequency_hz, samples) in [(10.0, 1000), (17.234_567, 1000), (3.3, 2000), (2.1, 1000), (77.7, 10_000)] {
        let found = estimate(&record(&beam(0.0), frequency_hz, even(samples, 1000.0), 1), 3).unwrap();
        let error = (found.omega / TAU / frequency_hz - 1.0).abs();
        assert!(error < 1e-11, "{frequency_hz} Hz: {error}");
    }
}

#[test]
fn uneven_steps_are_no_obstacle() {
    let time = (0..1500).map(|n| f64::from(n) * 1e-3 + 3e-4 * f64::from(n * n).sin()).collect();
    let found = estimate(&record(&beam(0.0), 12.34, time, 1), 3).unwrap();
    assert!((found.omega / TAU / 12.34 - 1.0).abs() < 1e-11);
}

#[test]
fn the_deviation_is_that_of_the_bound_and_honest() {
    // One sine: the Cramer-Rao bound is sqrt(24) sigma / (A N^(3/2) dt), rad/s.
    let (samples, rate_hz, noise) = (500, 1000.0, 0.2);
    let signals = [Signal::new(Quantity::Force, 0, &[z(1.0, 0.0)], noise)];
    let bound = 24.0_f64.sqrt() * noise / (samples as f64).powf(1.5) * rate_hz;
    let (mut squares, seeds) = (0.0, 300);
    for seed in 0..seeds {
        let found = estimate(&record(&signals, 23.4, even(samples, rate_hz), seed), 1).unwrap();
        assert!((found.deviation / bound - 1.0).abs() < 0.3, "{} {bound}", found.deviation);
        squares += ((found.omega - TAU * 23.4) / found.deviation).powi(2) / f64::from(seeds as u32);
    }
    assert!((squares.sqrt() - 1.0).abs() < 0.12, "{}", squares.sqrt());
}

#[test]
fn a_long_record_has_the_deviation_of_the_bound_too() {
    // More than 2^20 samples: parts first, then the whole of it.
    let (samples, rate_hz, noise) = (2_300_000, 10_000.0, 0.5);
    let signals = [Signal::new(Quantity::Force, 0, &[z(1.0, 0.0)], noise)];
    let bound = 24.0_f64.sqrt() * noise / (samples as f64).powf(1.5) * rate_hz;
    let found = estimate(&record(&signals, 37.212_3, even(samples, rate_hz), 4), 2).unwrap();
    assert!((found.deviation / bound - 1.0).abs() < 0.1, "{} {bound}", found.deviation);
    assert!((found.omega - TAU * 37.212_3).abs() < 4.0 * found.deviation, "{found:?}");
}

#[test]
fn a_long_record_that_begins_in_silence_is_found_by_its_loudest_part() {
    let time = even(1_700_000, 5000.0);
    let (channel, from) = (Channel { quantity: Quantity::Force, dof: 0, label: "1".into() }, 200.0);
    let force = time.iter().map(|&t| if t < from { 0.0 } else { (TAU * 21.345 * t).cos() }).collect();
    let found = estimate(&Record::new(time, vec![channel], vec![force]).unwrap(), 1).unwrap();
    // A fit to the whole of it sees the switching on, by some thousandths of a line of the spectrum.
    assert!((found.omega / TAU - 21.345).abs() * 340.0 < 0.01, "{}", found.omega / TAU);
}

#[test]
fn a_response_at_the_third_harmonic_misleads_nobody() {
    let signals = [
        Signal::new(Quantity::Force, 0, &[z(1.0, 0.0), z(0.0, 0.0), z(0.05, 0.0)], 0.01),
        Signal::new(Quantity::Acceleration, 0, &[z(1.0, 0.0), z(0.0, 0.0), z(20.0, 5.0)], 0.01),
    ];
    let found = estimate(&record(&signals, 11.0, even(2000, 1000.0), 1), 7).unwrap();
    assert!((found.omega / TAU - 11.0).abs() < 1e-3);
    // Without a force channel the weaker line at a third of the highest is the fundamental.
    let found = estimate(&record(&signals[1..], 11.0, even(4000, 1000.0), 1), 7).unwrap();
    assert!((found.omega / TAU - 11.0).abs() < 1e-3, "{}", found.omega / TAU);
}

#[test]
fn silence_has_no_frequency() {
    let signals = [Signal::new(Quantity::Force, 0, &[z(0.0, 0.0)], 0.0)];
    assert_eq!(estimate(&record(&signals, 11.0, even(2000, 1000.0), 1), 7), Err(FitError::NoOscillation));
}
