//! Every law on the five masses and on the beam: harmonic balance against time stepping from rest, which knows nothing of
//! it. Fundamental within 0.1 % (amplitude and phase), third harmonic within 1 % of itself.

use super::support::{balanced, cantilever, difference, five_masses, source, stepped, stepped_from, whole};
use dashpot::effects::{Effect, Source};
use dashpot::response::harmonic_balance::{Excitation, Settings};
use dashpot::structure::Structure;
use faer::c64;
use std::f64::consts::TAU;

/// Compares; `odd` says whether there is a third harmonic to compare.
fn agrees(name: &str, structure: &Structure, sources: &[Source], excitation: &Excitation, steps: usize, odd: bool) {
    let response = balanced(structure, sources, excitation, &Settings::default());
    let reference = stepped(structure, sources, excitation, steps);
    let first = difference(&response, &reference, 1);
    assert!(first < 1e-3, "{name}: fundamental off by {first:.2e}");
    if odd {
        let third = difference(&response, &reference, 3);
        assert!(third < 1e-2, "{name}: third harmonic off by {third:.2e}");
    }
}

/// A source on the five masses with a little proportional damping, driven at the fifth by 20 N near the first mode.
fn on_masses(name: &str, sources: &[Source], steps: usize, odd: bool) {
    let structure = five_masses();
    let mut all = vec![whole(Effect::MassProportional, 1.0), whole(Effect::StiffnessProportional, 1e-5)];
    all.extend_from_slice(sources);
    agrees(name, &structure, &all, &Excitation::sine(TAU * 21.0, 4, c64::new(20.0, 0.0)), steps, odd);
}

#[test]
fn damping_laws_on_the_five_masses() {
    on_masses("viscous", &[source(Effect::Viscous, &[1, 2], &[30.0])], 1000, false);
    on_masses("quadratic", &[source(Effect::Quadratic, &[2], &[2000.0])], 1000, true);
    on_masses("power 1.5", &[source(Effect::Power, &[2], &[300.0, 1.5])], 1000, true);
    on_masses("power 0.5", &[source(Effect::Power, &[2], &[10.0, 0.5])], 2000, true);
    on_masses("maxwell", &[source(Effect::Maxwell, &[2], &[2e4, 50.0])], 1000, false);
}

#[test]
fn stiffness_and_mass_laws_on_the_five_masses() {
    on_masses("stiffness", &[source(Effect::Stiffness, &[2, 3], &[5e3])], 1000, false);
    on_masses("mass", &[source(Effect::Mass, &[2], &[0.5])], 1000, false);
    on_masses("cubic", &[source(Effect::CubicStiffness, &[2], &[1e11])], 4000, true);
    on_masses("gap", &[source(Effect::Gap, &[2], &[1e5, 2e-4])], 4000, true);
    on_masses("stop", &[source(Effect::Stop, &[2], &[3e4, -2e-4])], 4000, true);
    on_masses("stop between masses", &[source(Effect::Stop, &[1, 2], &[3e4, 1e-5])], 4000, true);
}

#[test]
fn even_harmonics_and_static_offset() {
    let structure = five_masses();
    let sources = [whole(Effect::MassProportional, 2.0), source(Effect::QuadraticStiffness, &[2], &[2e7])];
    let excitation = Excitation::sine(TAU * 21.0, 4, c64::new(20.0, 0.0));
    let response = balanced(&structure, &sources, &excitation, &Settings::default());
    let reference = stepped(&structure, &sources, &excitation, 2000);
    assert!(difference(&response, &reference, 1) < 1e-4);
    assert!(difference(&response, &reference, 2) < 1e-3);
    // The mean force of the source, carried by the static stiffness, is the static offset.
    let force = response.forces.iter().find(|f| f.leg.first == 2).unwrap();
    assert!(force.mean > 0.0 && response.mean[2] < 0.0);
}

#[test]
fn friction_on_the_five_masses() {
    on_masses("slipping", &[source(Effect::Coulomb, &[2], &[5.0])], 2000, true);
    on_masses("half stuck", &[source(Effect::Coulomb, &[2], &[14.0])], 8000, true);
    on_masses("between two masses", &[source(Effect::Coulomb, &[0, 1], &[10.0])], 16000, true);
    on_masses("stuck", &[source(Effect::Coulomb, &[0], &[50.0])], 1000, false);
    on_masses("stribeck", &[source(Effect::Stribeck, &[2], &[5.0, 7.0, 0.01])], 8000, true);
    let chain = source(Effect::Coulomb, &[0, 1, 2], &[6.0]);
    on_masses("three at once", &[chain, source(Effect::Coulomb, &[4], &[3.0])], 8000, true);
}

#[test]
fn sliders_on_the_five_masses() {
    on_masses("elastic slider", &[source(Effect::ElasticSlider, &[2], &[2e4, 5.0])], 2000, true);
    on_masses("stiff elastic slider", &[source(Effect::ElasticSlider, &[2], &[5e6, 5.0])], 8000, true);
    on_masses("iwan", &[source(Effect::Iwan, &[2], &[2e4, 5.0, -0.5, 1.0])], 2000, true);
}

#[test]
fn full_stick_is_the_held_structure() {
    let structure = five_masses();
    let excitation = Excitation::sine(TAU * 21.0, 4, c64::new(20.0, 0.0));
    let damping = whole(Effect::MassProportional, 1.0);
    let stuck = [damping.clone(), source(Effect::Coulomb, &[0], &[1e3])];
    let held = [damping, source(Effect::Stiffness, &[0], &[1e14])];
    let stuck = balanced(&structure, &stuck, &excitation, &Settings::default());
    let held = balanced(&structure, &held, &excitation, &Settings::default());
    for dof in 1..5 {
        let (a, b) = (stuck.amplitude(dof, 1), held.amplitude(dof, 1));
        assert!((a - b).norm() < 1e-7 * b.norm(), "{dof}: {a} {b}");
    }
    assert!(stuck.amplitude(0, 1).norm() < 1e-8 * stuck.amplitude(4, 1).norm());
}

#[test]
fn friction_and_sliders_on_the_beam() {
    let structure = cantilever(5);
    let damping = [whole(Effect::StiffnessProportional, 2e-5), source(Effect::Viscous, &[2], &[0.2])];
    let excitation = Excitation::sine(TAU * 10.0, 8, c64::new(1.0, 0.0));
    for (name, extra, steps) in [
        ("coulomb at the tip", source(Effect::Coulomb, &[8], &[0.3]), 4000),
        ("coulomb inside", source(Effect::Coulomb, &[4], &[0.8]), 8000),
        ("cubic", source(Effect::CubicStiffness, &[8], &[5e4]), 4000),
        ("iwan", source(Effect::Iwan, &[6], &[500.0, 1.0, -0.3, 2.0]), 2000),
    ] {
        let sources = [&damping[..], &[extra]].concat();
        agrees(name, &structure, &sources, &excitation, steps, true);
    }
}

/// A source on the beam with a little damping, driven at the tip by 1 N near the first mode. `harmonic` is the one that is
/// compared beside the fundamental, 0 for none.
fn on_beam(name: &str, extra: Source, steps: usize, harmonic: usize) {
    let structure = cantilever(5);
    let sources = [whole(Effect::StiffnessProportional, 2e-5), source(Effect::Viscous, &[2], &[0.2]), extra];
    let excitation = Excitation::sine(TAU * 10.0, 8, c64::new(1.0, 0.0));
    let response = balanced(&structure, &sources, &excitation, &Settings::default());
    let reference = stepped_from(&response, &structure, &sources, &excitation, steps);
    let first = difference(&response, &reference, 1);
    assert!(first < 1e-3, "{name}: fundamental off by {first:.2e}");
    if harmonic > 0 {
        assert!(response.amplitude(8, harmonic).norm() > 1e-5 * response.amplitude(8, 1).norm(), "{name}: too weak");
        let error = difference(&response, &reference, harmonic);
        assert!(error < 1e-2, "{name}: harmonic {harmonic} off by {error:.2e}");
    }
}

#[test]
fn linear_laws_on_the_beam() {
    on_beam("viscous", source(Effect::Viscous, &[4, 8], &[0.3]), 500, 0);
    on_beam("maxwell", source(Effect::Maxwell, &[6], &[200.0, 5.0]), 1000, 0);
    on_beam("stiffness", source(Effect::Stiffness, &[4], &[100.0]), 500, 0);
    on_beam("mass", source(Effect::Mass, &[8], &[0.05]), 500, 0);
    on_beam("mass-proportional", whole(Effect::MassProportional, 2.0), 500, 0);
    let part = Source::known(Effect::StiffnessProportional, dashpot::effects::Place::Whole(Some([1, 2])), &[1e-3]);
    on_beam("stiffness-proportional, two elements", part, 500, 0);
}

#[test]
fn smooth_laws_on_the_beam() {
    on_beam("quadratic", source(Effect::Quadratic, &[6], &[0.3]), 1000, 3);
    on_beam("power 1.5", source(Effect::Power, &[4, 8], &[0.3, 1.5]), 1000, 3);
    on_beam("power 0.5", source(Effect::Power, &[8], &[0.2, 0.5]), 2000, 3);
    on_beam("cubic", source(Effect::CubicStiffness, &[4], &[2e5]), 2000, 3);
    on_beam("quadratic stiffness", source(Effect::QuadraticStiffness, &[8], &[500.0]), 2000, 2);
    on_beam("gap", source(Effect::Gap, &[8], &[100.0, 5e-3]), 4000, 3);
}

#[test]
fn friction_laws_on_the_beam() {
    on_beam("slipping", source(Effect::Coulomb, &[8], &[0.3]), 2000, 3);
    on_beam("between two nodes", source(Effect::Coulomb, &[4, 8], &[0.3]), 4000, 3);
    on_beam("stuck", source(Effect::Coulomb, &[4], &[30.0]), 1000, 0);
    on_beam("stribeck", source(Effect::Stribeck, &[8], &[0.3, 0.4, 0.3]), 4000, 3);
    on_beam("elastic slider", source(Effect::ElasticSlider, &[8], &[200.0, 0.4]), 2000, 3);
    on_beam("stuck elastic slider", source(Effect::ElasticSlider, &[8], &[50.0, 40.0]), 1000, 0);
}
