//! Methods of one degree of freedom.

use dashpot::classical::circle_fit::circle_fit;
use dashpot::classical::energy_single::{SteadyState, viscous_and_friction};
use dashpot::classical::half_power::peaks;
use dashpot::classical::hysteresis_loop::from_harmonics;
use dashpot::classical::log_decrement::{log_decrement, ratio};
use dashpot::classical::{ClassicalError, DecayRecord};
use faer::c64;
use std::f64::consts::{PI, TAU};

const M: f64 = 2.0;
const K: f64 = 8000.0;

fn receptance(zeta: f64, eta: f64, omega: &[f64]) -> Vec<c64> {
    let wn = (K / M).sqrt();
    let z = |w: f64| c64::new(K - w * w * M, 2.0 * zeta * wn * w * M + eta * K);
    omega.iter().map(|&w| c64::new(1.0, 0.0) / z(w)).collect()
}

fn lines(first: f64, last: f64, count: usize) -> Vec<f64> {
    let wn = (K / M).sqrt();
    (0..count).map(|i| wn * (first + (last - first) * i as f64 / (count - 1) as f64)).collect()
}

#[test]
fn decrement_of_light_and_heavy_damping() {
    for zeta in [0.005, 0.2] {
        let (wn, wd) = (40.0, 40.0 * f64::sqrt(1.0 - zeta * zeta));
        let step = 1e-4;
        let samples = (0..20_000).map(|i| f64::from(i) * step).map(|t| (-zeta * wn * t).exp() * (wd * t + 0.3).sin());
        let found = log_decrement(&DecayRecord { step, samples: samples.collect() }).unwrap();
        assert!((found.damping_ratio / zeta - 1.0).abs() < 1e-6, "{}", found.damping_ratio);
        assert!((found.frequency_hz * TAU / wd - 1.0).abs() < 1e-6);
        assert!(found.scatter < 1e-6);
        // (3.8) from the definition.
        let delta = 3.0 * TAU * zeta / (1.0 - zeta * zeta).sqrt();
        assert!((ratio(delta, 3.0) - zeta).abs() < 1e-15);
    }
    let few = DecayRecord { step: 0.1, samples: vec![1.0, 0.0] };
    assert!(matches!(log_decrement(&few), Err(ClassicalError::Few { found: 0, .. })));
}

#[test]
fn friction_bends_the_line_of_peaks() {
    // Peaks of a mass on a spring with friction fall by 4 F / k a period: a straight line, not an exponential.
    let samples: Vec<f64> = (0..4000)
        .map(|i| {
            let t = f64::from(i) * 0.01;
            let half = (t / PI).floor();
            let (amplitude, offset) = (20.0 - 2.0 * half - 1.0, if half % 2.0 == 0.0 { 1.0 } else { -1.0 });
            amplitude * (if half % 2.0 == 0.0 { 1.0 } else { -1.0 }) * (t - half * PI).cos() + offset
        })
        .take(2200)
        .collect();
    let found = log_decrement(&DecayRecord { step: 0.01, samples }).unwrap();
    assert!(found.scatter > 0.02, "{}", found.scatter);
}

#[test]
fn half_power_is_exact_for_hysteretic_and_off_by_zeta_squared_for_viscous() {
    let omega = lines(0.5, 1.5, 801);
    let hysteretic = peaks(&omega, &receptance(0.0, 0.08, &omega));
    assert_eq!(hysteretic.len(), 1);
    assert!((hysteretic[0].loss_factor / 0.08 - 1.0).abs() < 1e-9, "{}", hysteretic[0].loss_factor);
    for zeta in [0.005, 0.02, 0.04] {
        let found = peaks(&omega, &receptance(zeta, 0.0, &omega))[0].damping_ratio();
        // |H|^-2 = (1 - r)^2 + 4 zeta^2 r, r = (w / wn)^2, is a parabola with its least value 4 zeta^2 (1 - zeta^2) at
        // r = 1 - 2 zeta^2: half-width 2 zeta sqrt(1 - zeta^2), so the ratio is zeta sqrt(1 - zeta^2) / (1 - 2 zeta^2).
        let expected = zeta * (1.0 - zeta * zeta).sqrt() / (1.0 - 2.0 * zeta * zeta);
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    }
}

#[test]
fn half_power_finds_every_peak() {
    let omega = lines(0.5, 2.5, 2001);
    let (first, second) =
        (receptance(0.01, 0.0, &omega), receptance(0.01, 0.0, &omega.iter().map(|w| w / 2.0).collect::<Vec<_>>()));
    let sum: Vec<c64> = first.iter().zip(&second).map(|(a, b)| a + b).collect();
    let found = peaks(&omega, &sum);
    assert_eq!(found.len(), 2);
    assert!(found.iter().all(|peak| (peak.damping_ratio() / 0.01 - 1.0).abs() < 0.02), "{found:?}");
}

#[test]
fn circle_fit_is_exact_for_one_viscous_mode() {
    let omega = lines(0.9, 1.13, 41);
    for zeta in [0.002, 0.03] {
        let found = circle_fit(&omega, &receptance(zeta, 0.0, &omega)).unwrap();
        assert!((found.damping_ratio / zeta - 1.0).abs() < 1e-6, "{found:?}");
        assert!((found.omega / (K / M).sqrt() - 1.0).abs() < 1e-6);
        // The diameter is 1 / c.
        assert!((2.0 * found.radius * 2.0 * zeta * (K * M).sqrt() - 1.0).abs() < 1e-6);
        assert!(found.scatter < 1e-9);
    }
    assert!(matches!(circle_fit(&omega[..2], &[c64::new(1.0, 0.0); 2]), Err(ClassicalError::Few { .. })));
}

#[test]
fn circle_fit_lets_other_modes_be_constant() {
    let omega = lines(0.97, 1.03, 31);
    let rest = |w: f64| c64::new(0.0, w).inv() * c64::new(3e-4, -2e-3);
    let sum: Vec<c64> = receptance(0.01, 0.0, &omega).iter().zip(&omega).map(|(h, &w)| h + rest(w)).collect();
    let found = circle_fit(&omega, &sum).unwrap();
    assert!((found.damping_ratio / 0.01 - 1.0).abs() < 1e-6, "{found:?}");
}

fn steady(omega: f64, x: f64, c: f64, friction: f64) -> SteadyState {
    // The fundamental of the force that keeps x cos(w t) up: k x - w^2 m x + i (w c x + 4 F / pi).
    let force = c64::new((K - omega * omega * M) * x, omega * c * x + 4.0 * friction / PI);
    SteadyState { omega, displacement: vec![c64::new(x, 0.0)], force: vec![force] }
}

/// Area of a closed polygon of samples of one period, J: short of the smooth loop by about `(2 pi / samples)^2 / 6` of itself.
fn polygon_area(displacement: &[f64], force: &[f64]) -> f64 {
    let n = displacement.len().min(force.len());
    // The loop is run clockwise in the plane of x and f when energy is lost, so twice the area is sum f dx - x df.
    (0..n)
        .map(|i| {
            let j = (i + 1) % n;
            0.5 * (force[i] * displacement[j] - force[j] * displacement[i])
        })
        .sum()
}

#[test]
fn loop_area_is_the_energy_lost() {
    let state = steady(50.0, 0.01, 12.0, 0.0);
    let found = from_harmonics(state.omega, &state.displacement, &state.force, K);
    assert!((found.viscous / 12.0 - 1.0).abs() < 1e-12);
    assert!((found.loss_factor / (12.0 * 50.0 / K) - 1.0).abs() < 1e-12);
    // The drawn loop.
    let samples = |y: c64| -> Vec<f64> {
        (0..2000).map(|i| (y * c64::from_polar(1.0, TAU * f64::from(i) / 2000.0)).re).collect()
    };
    let drawn = polygon_area(&samples(state.displacement[0]), &samples(state.force[0]));
    assert!((drawn / found.area - 1.0).abs() < 2e-6, "{drawn} {}", found.area);
}

#[test]
fn energy_of_one_degree_of_freedom() {
    let runs: Vec<SteadyState> =
        [(50.0, 0.002), (55.0, 0.01), (60.0, 0.03)].iter().map(|&(w, x)| steady(w, x, 12.0, 1.5)).collect();
    let found = viscous_and_friction(&runs).unwrap();
    assert!((found.c / 12.0 - 1.0).abs() < 1e-9 && (found.friction / 1.5 - 1.0).abs() < 1e-9, "{found:?}");
    let parallel = [steady(50.0, 0.01, 12.0, 1.5), steady(25.0, 0.02, 12.0, 1.5)];
    assert!(matches!(viscous_and_friction(&parallel), Err(ClassicalError::Missing { .. })));
    assert!(matches!(viscous_and_friction(&runs[..1]), Err(ClassicalError::Few { .. })));
}

#[test]
fn path_of_several_harmonics() {
    // x = cos t - cos(3 t) / 9 has extremes at 0 and pi only: the path is twice their distance.
    let displacement = vec![c64::new(1.0, 0.0), c64::new(0.0, 0.0), c64::new(-1.0 / 9.0, 0.0)];
    let state = SteadyState { omega: 7.0, force: displacement.clone(), displacement };
    assert!((state.friction() - 4.0 * (1.0 - 1.0 / 9.0)).abs() < 1e-5, "{}", state.friction());
}
