//! The harmonic fit: exact without noise, unbiased and with an honest covariance with it.

use crate::signals::{Signal, beam, even, normal, record, rng, z};
use dashpot::measurement::{FitError, Quantity, fit};
use faer::c64;
use std::f64::consts::TAU;

fn amplitudes() -> Vec<c64> {
    vec![z(1.0, -0.5), z(0.02, 0.01), z(-0.1, 0.3), z(1e-4, 0.0), z(0.0, 0.05), z(1e-3, 1e-3), z(0.01, -0.02)]
}

fn relative_error(found: &[c64], expected: &[c64]) -> f64 {
    let size = |z: &c64| z.re.hypot(z.im);
    let largest = expected.iter().map(size).fold(0.0, f64::max);
    found.iter().zip(expected).map(|(a, b)| size(&(a - b))).fold(0.0, f64::max) / largest
}

#[test]
fn without_noise_the_amplitudes_are_exact() {
    let uneven = |n: usize| n as f64 * 1e-3 + 3e-4 * ((n * n) as f64).sin();
    // Whole periods; 3.7 periods; uneven steps; a record that starts late.
    let times = [
        even(1000, 1000.0),
        even(370, 1000.0),
        (0..2000).map(uneven).collect::<Vec<f64>>(),
        even(5000, 1000.0).iter().map(|t| t + 5.0).collect(),
    ];
    for (k, time) in times.into_iter().enumerate() {
        let signals = [Signal::new(Quantity::Force, 0, &amplitudes(), 0.0)];
        let fit = fit(&record(&signals, 10.0, time, 1), TAU * 10.0, 7).unwrap();
        let error = relative_error(&fit.channels[0].amplitudes, &amplitudes());
        assert!(error < 1e-12, "case {k}: {error}");
    }
}

#[test]
fn offset_and_slope_are_taken_out() {
    let signals = [Signal::new(Quantity::Force, 0, &amplitudes(), 0.0)];
    let record = crate::signals::changed(&signals, 10.0, even(1234, 1000.0), 1, |_, t, y| y + 1000.0 + 3.0 * t);
    let fit = fit(&record, TAU * 10.0, 7).unwrap();
    let channel = &fit.channels[0];
    assert!(relative_error(&channel.amplitudes, &amplitudes()) < 1e-12);
    assert!((channel.slope - 3.0).abs() < 1e-10);
    assert!((channel.offset - 1000.0 - 3.0 * 0.5 * 1.233).abs() < 1e-10);
}

#[test]
fn hundred_thousand_samples_lose_no_digits() {
    let signals = [Signal::new(Quantity::Force, 0, &amplitudes(), 0.0)];
    let fit = fit(&record(&signals, 37.3, even(100_000, 4096.0), 1), TAU * 37.3, 7).unwrap();
    let error = relative_error(&fit.channels[0].amplitudes, &amplitudes());
    assert!(error < 1e-12, "{error}");
}

/// Mean and spread of z-scores of every part of every amplitude, and of the noise, over many seeds.
fn z_scores(time: &[f64], frequency_hz: f64, signals: &[Signal]) -> (f64, f64, f64) {
    let (mut sum, mut squares, mut count, mut variance, seeds) = (0.0, 0.0, 0.0, 0.0, 400);
    for seed in 0..seeds {
        let fit = fit(&record(signals, frequency_hz, time.to_vec(), seed), TAU * frequency_hz, 3).unwrap();
        let channel = &fit.channels[0];
        variance += channel.noise.powi(2) / signals[0].noise.powi(2) / seeds as f64;
        for (h, truth) in signals[0].amplitudes.iter().take(3).enumerate() {
            for (i, error) in
                [channel.amplitudes[h].re - truth.re, channel.amplitudes[h].im - truth.im].iter().enumerate()
            {
                let score = error / channel.covariance[(2 * h + i, 2 * h + i)].sqrt();
                sum += score;
                squares += score * score;
                count += 1.0;
            }
        }
    }
    (sum / count, (squares / count).sqrt(), variance)
}

#[test]
fn the_covariance_is_honest_and_the_noise_unbiased() {
    let signals = [Signal::new(Quantity::Force, 0, &amplitudes()[..3], 0.05)];
    let uneven: Vec<f64> = (0..500).map(|n| f64::from(n) * 1e-3 + 2e-4 * f64::from(n * n).sin()).collect();
    // Many periods, whole and broken; less than two (noise from the residual); uneven steps.
    for (time, frequency_hz) in
        [(even(500, 1000.0), 20.0), (even(500, 1000.0), 17.3), (even(150, 1000.0), 10.0), (uneven, 23.0)]
    {
        let (mean, spread, variance) = z_scores(&time, frequency_hz, &signals);
        // 2400 scores: their mean is known to 0.02, their spread to 0.015; correlation between parts widens both a little.
        assert!(mean.abs() < 0.08, "{frequency_hz} Hz: mean {mean}");
        assert!((spread - 1.0).abs() < 0.06, "{frequency_hz} Hz: spread {spread}");
        // One variance is known to 5 to 15 %, the mean of 400 to under 1 %.
        assert!((variance - 1.0).abs() < 0.02, "{frequency_hz} Hz: variance {variance}");
    }
}

#[test]
fn correlations_of_a_broken_period_are_right() {
    // 1.1 periods: offset, slope and harmonics are correlated; the covariance must say so.
    let signals = [Signal::new(Quantity::Force, 0, &[z(1.0, 0.0), z(0.0, 0.1)], 0.05)];
    let (mut found, mut expected, seeds) = ([[0.0; 4]; 4], [[0.0; 4]; 4], 2000);
    for seed in 0..seeds {
        let fit = fit(&record(&signals, 10.0, even(110, 1000.0), seed), TAU * 10.0, 2).unwrap();
        let c = &fit.channels[0];
        let errors = [c.amplitudes[0].re - 1.0, c.amplitudes[0].im, c.amplitudes[1].re, c.amplitudes[1].im - 0.1];
        for i in 0..4 {
            for j in 0..4 {
                found[i][j] += errors[i] * errors[j];
                expected[i][j] += c.covariance[(i, j)];
            }
        }
    }
    let mut largest = 0.0_f64;
    for i in 0..4 {
        for j in 0..4 {
            let scale = (expected[i][i] * expected[j][j]).sqrt();
            assert!((found[i][j] - expected[i][j]).abs() < 0.08 * scale, "{i} {j}: {found:?} {expected:?}");
            largest = largest.max(if i == j { 0.0 } else { (expected[i][j] / scale).abs() });
        }
    }
    assert!(largest > 0.15, "the case must be one that matters: {largest}");
}

#[test]
fn harmonics_above_those_fitted_are_no_noise() {
    // A square wave, as friction makes it; 33.7 samples a period.
    let harmonics: Vec<c64> = (1..=15).map(|h| z(if h % 2 == 1 { 1.0 / f64::from(h) } else { 0.0 }, 0.0)).collect();
    let noise = 0.01;
    let signals = [Signal::new(Quantity::Force, 0, &harmonics, noise)];
    let fit = fit(&record(&signals, 10.0, even(4000, 1000.0), 3), TAU * 10.0, 7).unwrap();
    assert!((fit.channels[0].noise / noise - 1.0).abs() < 0.06, "{}", fit.channels[0].noise);
}

#[test]
fn rounding_that_repeats_is_counted_as_noise() {
    // Four digits and whole periods: every period is rounded alike and shows no scatter.
    let signals = [Signal::new(Quantity::Force, 0, &[z(1.0, 0.3)], 0.0)];
    let record = crate::signals::changed(&signals, 10.0, even(1000, 1000.0), 1, |_, _, y| (y * 1e3).round() / 1e3);
    let exact = fit(&record, TAU * 10.0, 1).unwrap();
    let stated = fit(&record.with_resolution(vec![1e-3]), TAU * 10.0, 1).unwrap();
    let error = (exact.channels[0].amplitudes[0] - z(1.0, 0.3)).re.abs();
    assert!(error > 10.0 * exact.channels[0].deviation(1), "{error}");
    assert!(error < 3.0 * stated.channels[0].deviation(1), "{error} {}", stated.channels[0].deviation(1));
}

#[test]
fn harmonics_that_sampling_cannot_resolve_are_left_out() {
    let signals = [Signal::new(Quantity::Force, 0, &[z(1.0, 0.0)], 0.0)];
    let fit = fit(&record(&signals, 10.0, even(1000, 85.0), 1), TAU * 10.0, 7).unwrap();
    assert_eq!(fit.harmonics(), 4);
    assert!(relative_error(&fit.channels[0].amplitudes[..1], &[z(1.0, 0.0)]) < 1e-12);
}

#[test]
fn what_cannot_be_fitted_says_why() {
    let signals = [Signal::new(Quantity::Force, 0, &[z(1.0, 0.0)], 0.0)];
    let record = record(&signals, 10.0, even(100, 1000.0), 1);
    let error = |frequency_hz: f64| fit(&record, TAU * frequency_hz, 7).unwrap_err();
    assert!(matches!(error(3.0), FitError::TooShort { .. }));
    assert!(matches!(error(495.0), FitError::Unresolved { .. }));
    assert!(matches!(error(-1.0), FitError::BadFrequency { .. }));
    assert!(matches!(error(f64::NAN), FitError::BadFrequency { .. }));
    let message = error(3.0).to_string();
    assert!(message.contains("less than one period of 3 Hz"), "{message}");
}

#[test]
fn the_channels_are_fitted_each_for_itself() {
    let signals = beam(0.05);
    let together = record(&signals, 10.3, even(1000, 1000.0), 4);
    let fit_together = fit(&together, TAU * 10.3, 2).unwrap();
    let mut rng = rng(4);
    let first = normal(&mut rng) * signals[0].noise + signals[0].value(TAU * 10.3, 0.0);
    assert_eq!(together.samples(0)[0], first);
    assert_eq!(fit_together.channels.len(), 3);
    for (channel, signal) in fit_together.channels.iter().zip(&signals) {
        let error = channel.amplitudes[0] - signal.amplitudes[0];
        assert!(error.re.hypot(error.im) < 4.0 * channel.deviation(1) * 1.5, "{}", channel.channel);
    }
}
