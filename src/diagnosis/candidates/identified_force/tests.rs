//! Regressions of free forces against closed forms, and against forces of laws by quadrature.
#![allow(clippy::unwrap_used, reason = "tests")]
use super::*;
use crate::effects::Leg;
use std::f64::consts::{PI, TAU};

const OMEGAS: [f64; 3] = [40.0, 55.0, 70.0];

/// Harmonics 1 to 3 of the motion of every run, m.
fn motions() -> Vec<Vec<c64>> {
    let motion = |r: usize| {
        let size = 1e-3 * [1.0, 2.5, 0.6][r];
        vec![c64::new(size, 0.3 * size), c64::new(0.0, 0.0), c64::new(-0.04 * size, 0.07 * size)]
    };
    (0..OMEGAS.len()).map(motion).collect()
}

/// The place of a spring of a motion with these free forces, `[run][harmonic]`, of weights that differ.
fn place(forces: &[Vec<c64>]) -> PlaceData {
    let sampling = Sampling::with_harmonics(SAMPLES, 3);
    let motions: Vec<Motion> =
        motions().iter().zip(OMEGAS).map(|(harmonics, omega)| sampling.motion(omega, 0.0, harmonics)).collect();
    let free = |r: usize, h: usize| FreeForce { value: forces[r][h], weight: 50.0 / (1.0 + r as f64 + h as f64) };
    let forces: Vec<Vec<FreeForce>> =
        (0..OMEGAS.len()).map(|r| (0..forces[r].len()).map(|h| free(r, h)).collect()).collect();
    PlaceData {
        spot: Spot::Leg(Leg { first: 0, second: None }),
        histories: forces.iter().map(|list| history(&sampling, list)).collect(),
        range: Range::of(&motions),
        forces,
        motions,
        impedances: vec![100.0; OMEGAS.len()],
        static_compliance: 1e-4,
        sampling,
        freedom: None,
    }
}

/// Dashpot of 3 N s/m with an error beside it.
fn wrong(r: usize, h: usize, d: c64) -> c64 {
    let w = (h + 1) as f64 * OMEGAS[r];
    c64::new(0.0, 3.0 * w) * d + c64::new(0.01 * (r as f64 - 1.0), 0.004 * (h as f64 + 1.0))
}

/// The coefficient of a dashpot is that of the weighted straight line through the origin, and so is what it leaves.
#[test]
fn a_dashpot_is_the_weighted_regression_on_the_velocity() {
    let motions = motions();
    let of_run = |(r, list): (usize, &Vec<c64>)| list.iter().enumerate().map(|(h, d)| wrong(r, h, *d)).collect();
    let forces: Vec<Vec<c64>> = motions.iter().enumerate().map(of_run).collect();
    let data = place(&forces);
    let velocity = |r: usize, h: usize| c64::new(0.0, (h + 1) as f64 * OMEGAS[r]) * motions[r][h];
    let over = |term: &dyn Fn(FreeForce, c64) -> f64| -> f64 {
        (0..3).flat_map(|r| (0..3).map(move |h| (r, h))).map(|(r, h)| term(data.forces[r][h], velocity(r, h))).sum()
    };
    let c = over(&|f, v| f.weight * (v.conj() * f.value).re) / over(&|f, v| f.weight * v.norm_sqr());
    let left = over(&|f, v| f.weight * (f.value - v * c).norm_sqr());
    let fit = data.fit_within(Effect::DASHPOT, f64::INFINITY, &data).unwrap();
    assert!((fit.source.parameters[0] / c - 1.0).abs() < 1e-9, "{} for {c}", fit.source.parameters[0]);
    assert!((fit.misfit / left - 1.0).abs() < 1e-9, "{} for {left}", fit.misfit);
    assert_eq!(data.count(), 18);
    for (r, ratio) in data.ratios_by_run() {
        let (d, free) = (motions[r][0], data.forces[r][0]);
        assert!((ratio.ratio - free.value / d).norm() < 1e-12 * ratio.ratio.norm());
        assert!((ratio.deviation * d.norm() * free.weight.sqrt() - 1.0).abs() < 1e-12);
    }
}

/// Harmonics 1 to 3 of `c |v|^p sgn v` along a motion, by quadrature.
fn power(harmonics: &[c64], omega: f64, [c, p]: [f64; 2]) -> Vec<c64> {
    const POINTS: usize = 20_000;
    let velocity = |phase: f64| -> f64 {
        let term = |(h, d): (usize, &c64)| {
            let h = (h + 1) as f64;
            (c64::new(0.0, h * omega) * d * c64::from_polar(1.0, h * phase)).re
        };
        harmonics.iter().enumerate().map(term).sum()
    };
    let force = |n: usize| {
        let v = velocity(TAU * n as f64 / POINTS as f64);
        c * v.abs().powf(p) * v.signum()
    };
    let harmonic = |h: usize| {
        let term = |n: usize| c64::from_polar(force(n), -TAU * (h * n) as f64 / POINTS as f64);
        (0..POINTS).map(term).sum::<c64>() * (2.0 / POINTS as f64)
    };
    (1..=harmonics.len()).map(harmonic).collect()
}

/// A force that follows the power of the velocity gives size and exponent back, and leaves more with the wrong law.
#[test]
fn a_power_of_the_velocity_is_found_from_its_harmonics() {
    let truth = [4.0, 1.6];
    let forces: Vec<Vec<c64>> =
        motions().iter().zip(OMEGAS).map(|(harmonics, omega)| power(harmonics, omega, truth)).collect();
    let data = place(&forces);
    let fit = |effect| data.fit_within(effect, f64::INFINITY, &data).unwrap();
    let found = fit(Effect::Power);
    for (value, expected) in found.source.parameters.iter().zip(truth) {
        assert!((value / expected - 1.0).abs() < 1e-2, "{:?}", found.source.parameters);
    }
    assert!(fit(Effect::DASHPOT).misfit > 100.0 * found.misfit, "{}", found.misfit);
}

/// A spring answers the fundamental in phase: none of its work is that of a dashpot.
#[test]
fn a_spring_leaves_a_dashpot_nothing() {
    let forces: Vec<Vec<c64>> = motions().iter().map(|list| list.iter().map(|d| d * 2e3).collect()).collect();
    let data = place(&forces);
    assert!(data.fit_within(Effect::DASHPOT, f64::INFINITY, &data).is_none_or(|fit| {
        let work = PI * OMEGAS[0] * fit.source.parameters[0] * motions()[0][0].norm_sqr();
        work.abs() < 1e-12
    }));
}
