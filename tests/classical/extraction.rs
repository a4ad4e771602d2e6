//! Complex modes extracted from frequency responses with noise, and the methods that run on them.

use super::support::*;
use crate::common::models::cantilever;
use dashpot::classical::FrequencyResponses;
use dashpot::classical::poly_reference::extract;
use dashpot::control::Control;
use dashpot::structure::Structure;
use dashpot::structure::damped_modes::{DampedMode, damped_modes};
use faer::{Mat, c64};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;

fn beam() -> (Structure, Mat<f64>) {
    let mut c = Mat::zeros(20, 20);
    for (label, value) in [(3, 0.2), (13, 0.5), (17, 0.15)] {
        c[(label - 1, label - 1)] = value;
    }
    (cantilever(10), c)
}

fn exact(structure: &Structure, c: &Mat<f64>) -> Vec<DampedMode> {
    let matrices = structure.matrices().unwrap();
    damped_modes(matrices.mass.as_ref(), matrices.stiffness.as_ref(), c.as_ref()).unwrap()
}

/// Sums over the modes with complex noise of a standard deviation in proportion to each value.
fn measured(
    modes: &[DampedMode],
    hz: &[f64],
    sensors: Vec<usize>,
    drives: Vec<usize>,
    noise: f64,
    seed: u64,
) -> FrequencyResponses {
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    let mut gauss = || -> f64 { StandardNormal.sample(&mut random) };
    let value = |w: f64, i: usize, j: usize| -> c64 {
        let s = c64::new(0.0, w);
        let term = |m: &DampedMode| {
            let residue = m.shape[i] * m.shape[j];
            residue / (s - m.lambda) + residue.conj() / (s - m.lambda.conj())
        };
        modes.iter().map(term).sum()
    };
    let omega: Vec<f64> = hz.iter().map(|f| TAU * f).collect();
    let mut values = Vec::new();
    for &w in &omega {
        let mut h = Mat::<c64>::zeros(sensors.len(), drives.len());
        for (b, &drive) in drives.iter().enumerate() {
            for (a, &sensor) in sensors.iter().enumerate() {
                let factor = c64::new(1.0, 0.0) + c64::new(gauss(), gauss()) * (noise / 2f64.sqrt());
                h[(a, b)] = value(w, sensor, drive) * factor;
            }
        }
        values.push(h);
    }
    FrequencyResponses { omega, sensors, drives, values, deviations: Vec::new() }
}

#[test]
fn modes_1_to_8_of_the_beam_with_one_per_cent_noise() {
    let (structure, c) = beam();
    let modes = exact(&structure, &c);
    let lines: Vec<f64> = (0..17_600).map(|k| 4.0 + 0.1 * f64::from(k)).collect();
    for seed in 1..=2 {
        let responses = measured(&modes, &lines, vec![6, 10, 18], vec![18], 0.01, seed);
        let found = extract(&responses, &Control::unattended()).unwrap();
        assert_eq!(
            found.modes.len(),
            8,
            "{:?}",
            found.modes.iter().map(dashpot::classical::extracted_mode::ExtractedMode::frequency_hz).collect::<Vec<_>>()
        );
        for (r, (mode, known)) in found.modes.iter().zip(&modes).enumerate() {
            let frequency = mode.frequency_hz() / known.frequency_hz - 1.0;
            let ratio = mode.damping_ratio() / known.damping_ratio - 1.0;
            assert!(frequency.abs() < 5e-4, "mode {}: frequency off by {frequency:.1e}", r + 1);
            assert!(ratio.abs() < 0.03, "mode {}: ratio off by {ratio:.1e}", r + 1);
            // The deviation stated is honest.
            assert!((mode.pole - known.lambda).norm() < 5.0 * mode.deviation, "mode {}", r + 1);
        }
        assert!(found.diagram.iter().filter(|pole| pole.stable).count() > 24);
    }
}

#[test]
fn five_masses_with_five_drives() {
    let (structure, c) = (five_masses(), scaled(&damping(), 4.0));
    let modes = exact(&structure, &c);
    let lines: Vec<f64> = (0..1400).map(|k| 15.0 + 0.04 * f64::from(k)).collect();
    let all: Vec<usize> = (0..5).collect();
    let responses = measured(&modes, &lines, all.clone(), all, 0.0, 0);
    let found = extract(&responses, &Control::unattended()).unwrap();
    assert_eq!(found.modes.len(), 5, "{:?}", found.modes.iter().map(|m| m.pole).collect::<Vec<_>>());
    for (mode, known) in found.modes.iter().zip(&modes) {
        assert!((mode.pole - known.lambda).norm() < 1e-6 * known.lambda.re.abs(), "{} {}", mode.pole, known.lambda);
    }
    let data = found.modal_data(&responses);
    assert!(data.scaled);
}

#[test]
fn lines_too_few_are_said() {
    let (structure, c) = (five_masses(), damping());
    let lines = [21.876, 32.13, 42.481, 52.443, 64.361];
    let responses = measured(&exact(&structure, &c), &lines, vec![0, 4], vec![4], 0.0, 0);
    let error = extract(&responses, &Control::unattended()).unwrap_err();
    assert_eq!(error.to_string(), "needs 16 lines of frequency response around a resonance, but there are 5");
}
