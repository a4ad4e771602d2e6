//! Amplitude curves of decays whose frequency and damping ratio are known.

use dashpot::diagnosis::records::amplitude::{AmplitudePoint, Band, amplitude_curve, line};
use std::f64::consts::TAU;

fn curve(signal: impl Fn(f64) -> f64, frequency_hz: f64) -> Vec<AmplitudePoint> {
    let step = 0.01;
    let samples: Vec<f64> = (0..4000).map(|n| signal(step * f64::from(n))).collect();
    amplitude_curve(&samples, step, 0.0, Band { frequency_hz, width: 0.0 })
}

#[test]
fn a_linear_decay_has_one_frequency_and_one_ratio() {
    let (omega, zeta) = (TAU * 1.5, 0.004);
    let points = curve(|t| 2.0 * (-zeta * omega * t).exp() * (omega * t + 0.3).cos() + 0.1, 1.55);
    assert!(points.len() > 20);
    for point in points {
        assert!((point.frequency_hz - 1.5).abs() < 1e-7 && (point.damping_ratio - zeta).abs() < 1e-7);
        assert!((point.amplitude / (2.0 * (-zeta * omega * point.time_s).exp()) - 1.0).abs() < 1e-6);
    }
}

/// Dry friction: the amplitude falls in a straight line, so that `zeta A` is the same everywhere.
#[test]
fn friction_falls_with_slope_minus_one() {
    let omega = TAU * 1.5;
    let points = curve(|t| (2.0 - 0.04 * t) * (omega * t).cos(), 1.5);
    for point in &points {
        let rate = point.damping_ratio * point.amplitude * omega / 0.04;
        assert!((rate - 1.0).abs() < 2e-2, "{rate} at {} s", point.time_s);
    }
    let logs: Vec<[f64; 3]> = points
        .iter()
        .map(|p| [p.amplitude.ln(), p.damping_ratio.ln(), p.damping_deviation / p.damping_ratio])
        .collect();
    assert!((line(&logs).unwrap().slope + 1.0).abs() < 0.03);
}

/// The frequency of a cubic spring: `f^2 = f_0^2 (1 + 3/4 k_3 A^2 / k)` for small amplitudes.
#[test]
fn a_frequency_that_moves_is_followed() {
    let phase = |t: f64| TAU * (1.5 * t + 0.002 * t * t);
    let points = curve(|t| phase(t).cos() * (-0.01 * t).exp(), 1.5);
    for point in points {
        assert!((point.frequency_hz - (1.5 + 0.004 * point.time_s)).abs() < 1e-6);
    }
}
