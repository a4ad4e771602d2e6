//! Tangents against finite differences of the force, dynamic stiffness against the sampled force.

use super::{cases, direction, rich, sampled};
use dashpot::effects::{Effect, Motion};
use faer::c64;

const SAMPLES: usize = 240;

fn moved(step: f64) -> Motion {
    let (motion, along) = (rich(SAMPLES), direction(SAMPLES));
    let harmonics: Vec<c64> =
        motion.harmonics.iter().zip(&along.harmonics).map(|(d, e)| d + c64::new(step, 0.0) * e).collect();
    Motion::new(motion.omega, motion.mean + step * along.mean, &harmonics, SAMPLES)
}

/// Samples where two central differences of different steps disagree are at a kink and are left out, but only a few.
fn compare(found: &[f64], wide: &[f64], narrow: &[f64], what: &str) {
    let size = narrow.iter().chain(found).fold(0.0_f64, |most, f| most.max(f.abs()));
    let mut kinks = 0;
    for n in 0..found.len() {
        if (wide[n] - narrow[n]).abs() > 1e-4 * size + 1e-9 {
            kinks += 1;
        } else {
            let error = (found[n] - narrow[n]).abs();
            assert!(error <= 1e-4 * size + 1e-9, "{what}, sample {n}: {} instead of {}", found[n], narrow[n]);
        }
    }
    assert!(kinks <= found.len() / 12, "{what}: {kinks} kinks");
}

fn difference(high: &[f64], low: &[f64], step: f64) -> Vec<f64> {
    high.iter().zip(low).map(|(a, b)| (a - b) / (2.0 * step)).collect()
}

#[test]
fn the_tangent_is_the_derivative_of_the_force() {
    for (effect, law, p) in cases() {
        let force = |step: f64| sampled(law, &p, &moved(step));
        let central = |step: f64| difference(&force(step), &force(-step), step);
        let mut tangent = vec![0.0; SAMPLES];
        law.tangent(&p, &rich(SAMPLES), &direction(SAMPLES), &mut tangent);
        compare(&tangent, &central(1e-8), &central(3e-9), &format!("{effect} {p:?}"));
    }
}

#[test]
fn the_parameter_tangent_is_the_derivative_by_the_parameter() {
    let motion = rich(SAMPLES);
    for (effect, law, p) in cases() {
        for k in 0..p.len() {
            let scale = if p[k] == 0.0 { 1.0 } else { p[k].abs() };
            let force = |step: f64| {
                let mut p = p.clone();
                p[k] += step;
                sampled(law, &p, &motion)
            };
            let central = |step: f64| difference(&force(step), &force(-step), step);
            let mut tangent = vec![0.0; SAMPLES];
            law.parameter_tangent(&p, k, &motion, &mut tangent);
            let what = format!("{effect} {p:?} parameter {k}");
            compare(&tangent, &central(1e-5 * scale), &central(3e-6 * scale), &what);
        }
    }
}

/// The first linear parameter multiplies the whole force; an offset beside it is a mean that does no work.
#[test]
fn the_force_is_proportional_to_the_coefficient() {
    let motion = rich(SAMPLES);
    for (effect, law, p) in cases() {
        let Some(k) = effect.coefficient() else { continue };
        let mut doubled = p.clone();
        doubled[k] *= 2.0;
        let varying = |p: &[f64]| {
            let force = sampled(law, p, &motion);
            let mean = force.iter().sum::<f64>() / force.len() as f64;
            force.into_iter().map(move |f| f - mean).collect::<Vec<f64>>()
        };
        let (once, twice) = (varying(&p), varying(&doubled));
        let size = twice.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
        for (once, twice) in once.iter().zip(twice) {
            assert!((2.0 * once - twice).abs() <= 1e-12 * size, "{effect}");
        }
    }
}

#[test]
fn the_dynamic_stiffness_gives_the_sampled_force() {
    let motion = rich(SAMPLES);
    let mut linear = Vec::new();
    for (effect, law, p) in cases() {
        let Some(at_rest) = law.dynamic_stiffness(&p, 0.0) else { continue };
        linear.push(effect);
        let amplitudes: Vec<c64> = motion
            .harmonics
            .iter()
            .enumerate()
            .map(|(i, d)| law.dynamic_stiffness(&p, (i + 1) as f64 * motion.omega).unwrap() * d)
            .collect();
        let wanted = Motion::new(motion.omega, at_rest.re * motion.mean, &amplitudes, SAMPLES).displacement;
        let size = wanted.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
        for (found, wanted) in sampled(law, &p, &motion).iter().zip(&wanted) {
            assert!((found - wanted).abs() < 1e-11 * size, "{effect}: {found} instead of {wanted}");
        }
    }
    linear.dedup();
    assert_eq!(linear.len(), 6, "{linear:?}");
}

/// The force at one instant and the force at samples are the same law.
#[test]
fn the_point_force_is_the_sampled_force() {
    let motion = rich(SAMPLES);
    for (effect, law, p) in cases() {
        let mut force = vec![0.0; SAMPLES];
        law.force(&p, &motion, &mut force);
        for n in 0..SAMPLES {
            let Some(point) = law.point(&p, motion.displacement[n], motion.velocity[n]) else { break };
            assert!((point.force - force[n]).abs() <= 1e-14 * force[n].abs(), "{effect}");
        }
    }
    assert!(Effect::Iwan.law().unwrap().point(&[1.0; 4], 0.0, 0.0).is_none());
}
