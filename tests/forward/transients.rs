//! Time stepping by itself: transients against closed forms, records, and what it refuses.

use super::support::{five_masses, source, stepped, whole};
use crate::common::models::oscillator;
use dashpot::effects::Effect;
use dashpot::response::harmonic_balance::Excitation;
use dashpot::response::time_integration::{TimeError, TimeModel};
use faer::c64;
use std::f64::consts::TAU;

/// From rest, `m x'' + k x = F sin(w t)`: `x = F/(k - m w^2) (sin w t - w/wn sin wn t)`.
#[test]
fn the_transient_of_an_oscillator_from_rest() {
    let (m, k, force, omega) = (2.0, 800.0, 3.0, 13.0_f64);
    let excitation = Excitation::sine(omega, 0, c64::new(0.0, -force));
    let mut model = TimeModel::new(&oscillator(m, k), &[], &excitation, 400).unwrap();
    let samples = model.record(2000).unwrap();
    let (wn, scale) = (20.0_f64, force / (k - m * omega * omega));
    for (row, &t) in samples.time.iter().enumerate() {
        let x = scale * ((omega * t).sin() - omega / wn * (wn * t).sin());
        let a = -scale * omega * (omega * (omega * t).sin() - wn * (wn * t).sin());
        assert!((samples.displacement[(row, 0)] - x).abs() < 1e-4 * scale.abs(), "{t}");
        assert!((samples.acceleration[(row, 0)] - a).abs() < 1e-4 * scale.abs() * wn * wn, "{t}");
    }
}

/// Free sliding under dry friction: the amplitude falls by `4 F_c / k` a cycle and stops within `F_c / k`.
#[test]
fn free_sliding_falls_in_a_straight_line() {
    let (k, friction) = (800.0, 4.0);
    let sources = [source(Effect::Coulomb, &[0], &[friction])];
    // Frequency and steps of a period that is the natural one; no force.
    let excitation = Excitation::sine(20.0, 0, c64::new(0.0, 0.0));
    let mut model = TimeModel::new(&oscillator(2.0, k), &sources, &excitation, 4000).unwrap();
    model.start(&[0.1], &[0.0]);
    for cycle in 1..=4 {
        model.run(4000).unwrap();
        let expected = 0.1 - f64::from(cycle) * 4.0 * friction / k;
        assert!((model.displacement(0) - expected).abs() < 2e-5, "{cycle}: {}", model.displacement(0));
    }
    model.run(4000 * 4).unwrap();
    assert!(model.displacement(0).abs() <= friction / k + 1e-9);
    assert!(model.velocity(0).abs() < 1e-12);
}

#[test]
fn the_error_of_smooth_laws_falls_with_the_square_of_the_step() {
    let structure = five_masses();
    let sources = [whole(Effect::MassProportional, 2.0), source(Effect::CubicStiffness, &[2], &[1e11])];
    let excitation = Excitation::sine(TAU * 21.0, 4, c64::new(20.0, 0.0));
    let [a, b, c] = [200, 400, 800].map(|steps| stepped(&structure, &sources, &excitation, steps)[(2, 0)]);
    let ratio = (a - b).norm() / (b - c).norm();
    assert!((3.5..4.6).contains(&ratio), "{ratio}");
}

/// `m x'' + c x' + k x + k_2 x^2 = F cos(w t)` pulls back for `x > -k / k_2` only: a force of five times the largest of that well takes
/// the mass beyond it, and nothing stops it there.
#[test]
fn a_mass_driven_beyond_the_limit_point_of_its_spring_is_refused() {
    let sources = [source(Effect::Viscous, &[0], &[0.2]), source(Effect::QuadraticStiffness, &[0], &[5000.0])];
    let excitation = Excitation::sine(8.2, 0, c64::new(2.5, 0.0));
    let mut model = TimeModel::new(&oscillator(1.0, 100.0), &sources, &excitation, 4000).unwrap();
    let refused = (0..100).find_map(|_| model.run(4000).err());
    assert!(matches!(refused, Some(TimeError::StepFailed { .. })), "{refused:?}");
}

#[test]
fn laws_without_a_force_in_time_are_refused() {
    let excitation = Excitation::sine(TAU * 21.0, 4, c64::new(20.0, 0.0));
    for law in [
        source(Effect::Hysteretic, &[0], &[1.0]),
        source(Effect::Fractional, &[0], &[1.0, 0.5]),
        whole(Effect::LossFactor, 0.01),
    ] {
        let refused = TimeModel::new(&five_masses(), &[law], &excitation, 100).err();
        assert!(matches!(refused, Some(TimeError::NoTimeDomain { source_index: 0, .. })));
    }
    let few = TimeModel::new(&five_masses(), &[], &excitation, 4).err();
    assert!(matches!(few, Some(TimeError::BadStep { steps: 4, .. })));
}
