//! Every law against closed forms, finite differences, quadrature and its own limits.
#![allow(clippy::unwrap_used, reason = "tests")]

mod energies;
mod knowledge;
mod limits;
mod memories;
mod names;
mod sources;
mod tangents;

use dashpot::effects::{Effect, Law, Motion};
use faer::c64;

/// All laws on a relative motion, with parameter sets that are neither neutral nor extreme.
fn cases() -> Vec<(Effect, &'static dyn Law, Vec<f64>)> {
    let sets: &[(Effect, &[&[f64]])] = &[
        (Effect::Viscous, &[&[0.7], &[12.0]]),
        (Effect::Coulomb, &[&[0.9], &[4.0]]),
        (Effect::Quadratic, &[&[3.0]]),
        (Effect::Power, &[&[2.0, 0.6], &[2.0, 1.0], &[0.5, 1.7], &[0.1, 3.0]]),
        (Effect::Hysteretic, &[&[50.0]]),
        (Effect::Stribeck, &[&[1.0, 1.8, 0.02], &[2.0, 1.0, 0.3]]),
        (Effect::ElasticSlider, &[&[1e4, 1.0], &[500.0, 0.7], &[1e3, 50.0]]),
        (Effect::Maxwell, &[&[2e3, 9.0], &[1e4, 0.4]]),
        (
            Effect::Iwan,
            &[&[1e4, 1.0, -0.5, 1.0], &[2e3, 3.0, -0.8, 0.2], &[3e3, 1.5, 0.0, 0.0], &[900.0, 80.0, -0.3, 2.0]],
        ),
        (Effect::Fractional, &[&[4.0, 0.3], &[4.0, 0.8]]),
        (Effect::BoucWen, &[&[1e4, 1.0, 2.0], &[2e3, 1.5, 1.0], &[5e3, 2.0, 7.5]]),
        (Effect::StiffeningBoucWen, &[&[1e4, 5.0, 0.3], &[2e3, 1.5, 0.8], &[5e3, 2.0, -0.6], &[5e3, 2.0, 0.0]]),
        (Effect::Dahl, &[&[1e4, 1.0], &[2e3, 2.0]]),
        (Effect::ElasticSliderBacklash, &[&[1e4, 1.0, 4e-4], &[4e3, 0.9, 1e-3], &[1e4, 2.0, 0.0]]),
        (Effect::AsymmetricViscous, &[&[3.0, 0.5], &[0.4, 2.0]]),
        (Effect::AsymmetricCoulomb, &[&[0.9, 0.3], &[2.0, -1.0]]),
        (Effect::Stiffness, &[&[-300.0]]),
        (Effect::CubicStiffness, &[&[2e7]]),
        (Effect::QuadraticStiffness, &[&[-3e4]]),
        (Effect::Gap, &[&[4e3, 4e-4], &[4e3, 0.0]]),
        (Effect::Stop, &[&[4e3, 4e-4], &[4e3, -3e-4]]),
        (Effect::Mass, &[&[0.3]]),
    ];
    let mut cases = Vec::new();
    for (effect, parameters) in sets {
        for p in *parameters {
            assert_eq!(effect.parameters().len(), p.len());
            assert!(effect.parameters().iter().zip(*p).all(|(q, &v)| q.allows(v)), "{effect} {p:?}");
            cases.push((*effect, effect.law().unwrap(), p.to_vec()));
        }
    }
    let named: std::collections::HashSet<_> = cases.iter().map(|case| case.0).collect();
    let laws = Effect::ALL.iter().filter(|effect| effect.law().is_some()).count();
    assert_eq!(named.len(), laws, "every law of Effect::ALL is tested");
    cases
}

/// A motion of several harmonics with inner loops.
fn rich(samples: usize) -> Motion {
    let harmonics = [c64::new(8e-4, 3e-4), c64::new(-1e-4, 2e-4), c64::new(3e-4, -3.2e-4), c64::new(1e-5, 6e-5)];
    Motion::new(60.0, 1e-4, &harmonics, samples)
}

/// A direction unlike the motion.
fn direction(samples: usize) -> Motion {
    let harmonics = [c64::new(0.3, -0.7), c64::new(0.2, 0.4), c64::new(-0.5, 0.1), c64::new(0.1, -0.3)];
    Motion::new(60.0, 0.4, &harmonics, samples)
}

fn sampled(law: &dyn Law, p: &[f64], motion: &Motion) -> Vec<f64> {
    let mut force = vec![0.0; motion.len()];
    law.force(p, motion, &mut force);
    force
}

fn assert_close(found: f64, wanted: f64, relative: f64, what: &str) {
    let size = found.abs().max(wanted.abs());
    assert!((found - wanted).abs() <= relative * size, "{what}: {found} instead of {wanted}");
}
