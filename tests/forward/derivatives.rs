//! Derivatives of the response by every parameter of every law and by the structure, against central differences.

use super::support::{balanced, five_masses, source, whole};
use crate::common::models::chain;
use dashpot::control::Control;
use dashpot::effects::{Effect, Source};
use dashpot::response::harmonic_balance::{Excitation, ForwardModel, Response, Settings};
use dashpot::response::sensitivity::{SensitivityError, Unknown, sensitivities};
use dashpot::structure::{Part, Structure};
use faer::{Mat, c64};
use std::f64::consts::TAU;

fn excitation() -> Excitation {
    Excitation::sine(TAU * 21.0, 4, c64::new(20.0, 0.0))
}

fn settings() -> Settings {
    Settings { estimate: false, tolerance: 1e-13, ..Settings::fixed(7) }
}

fn solved(structure: &Structure, sources: &[Source], start: Option<&Response>) -> Response {
    let model = ForwardModel::new(structure, sources).unwrap();
    model.respond(&excitation(), &settings(), start, &Control::unattended()).unwrap()
}

fn derived(structure: &Structure, sources: &[Source], unknowns: &[Unknown]) -> (Response, Vec<Mat<c64>>) {
    let response = solved(structure, sources, None);
    let run = ForwardModel::new(structure, sources).unwrap().at(excitation().omega);
    let derivatives =
        sensitivities(&run, sources, &excitation(), &response, &(0..run.len()).collect::<Vec<_>>(), unknowns).unwrap();
    (response, derivatives)
}

/// Largest difference relative to the largest derivative of each harmonic that matters.
fn mismatch(derivative: &Mat<c64>, plus: &Response, minus: &Response, step: f64) -> f64 {
    let mut worst = 0.0_f64;
    let overall = (0..5).fold(0.0_f64, |m, i| m.max(derivative[(i, 0)].norm()));
    // What moves the mean alone, as an offset force does, leaves the harmonics where they are, to rounding: the step is
    // 1e-4 of the parameter.
    let nothing = 1e-8 * (0..5).fold(0.0_f64, |m, i| m.max(plus.amplitude(i, 1).norm())) / (1e4 * step);
    for h in 1..=5 {
        let (mut error, mut size) = (0.0_f64, (1e-6 * overall).max(nothing));
        for i in 0..5 {
            let central = (plus.amplitude(i, h) - minus.amplitude(i, h)) / (2.0 * step);
            error = error.max((derivative[(i, h - 1)] - central).norm());
            size = size.max(central.norm());
        }
        worst = worst.max(error / size);
    }
    worst
}

fn with_parameter(sources: &[Source], source: usize, parameter: usize, value: f64) -> Vec<Source> {
    let mut changed = sources.to_vec();
    changed[source].parameters[parameter] = value;
    changed
}

#[test]
fn every_parameter_of_every_law() {
    let structure = five_masses();
    let laws = [
        source(Effect::Viscous, &[2, 3], &[30.0]),
        source(Effect::Coulomb, &[2], &[5.0]),
        source(Effect::Coulomb, &[2], &[14.0]),
        source(Effect::Quadratic, &[2], &[2000.0]),
        source(Effect::Power, &[2], &[300.0, 1.5]),
        source(Effect::Power, &[2], &[10.0, 0.5]),
        source(Effect::Hysteretic, &[2], &[500.0]),
        source(Effect::Stribeck, &[2], &[5.0, 7.0, 0.01]),
        source(Effect::ElasticSlider, &[2], &[2e4, 5.0]),
        source(Effect::ElasticSlider, &[2], &[1e7, 5.0]),
        source(Effect::Maxwell, &[2], &[2e4, 50.0]),
        source(Effect::Iwan, &[2], &[2e4, 5.0, -0.5, 1.0]),
        source(Effect::Fractional, &[2], &[100.0, 0.4]),
        source(Effect::BoucWen, &[2], &[2e4, 5.0, 2.0]),
        source(Effect::StiffeningBoucWen, &[2], &[2e4, 5.0, 0.3]),
        source(Effect::Dahl, &[2], &[2e4, 5.0]),
        source(Effect::ElasticSliderBacklash, &[2], &[4e4, 5.0, 1e-4]),
        source(Effect::AsymmetricViscous, &[2], &[60.0, 10.0]),
        source(Effect::AsymmetricCoulomb, &[2], &[5.0, 2.0]),
        source(Effect::Stiffness, &[1, 2], &[3e3]),
        source(Effect::CubicStiffness, &[2], &[1e11]),
        source(Effect::QuadraticStiffness, &[2], &[1e7]),
        source(Effect::Gap, &[2], &[1e5, 2e-4]),
        source(Effect::Stop, &[2], &[1e5, -2e-4]),
        source(Effect::Mass, &[2], &[0.3]),
        whole(Effect::LossFactor, 0.01),
        whole(Effect::StiffnessProportional, 1e-4),
        whole(Effect::MassProportional, 2.0),
    ];
    // Kinks pass from sample to sample within the difference quotient: those laws are differentiated to less.
    let rough = [
        Effect::Coulomb,
        Effect::Stribeck,
        Effect::ElasticSlider,
        Effect::Iwan,
        Effect::Gap,
        Effect::Stop,
        Effect::Power,
        Effect::BoucWen,
        Effect::StiffeningBoucWen,
        Effect::Dahl,
        Effect::ElasticSliderBacklash,
        Effect::AsymmetricViscous,
        Effect::AsymmetricCoulomb,
    ];
    for law in laws {
        let is_rough = rough.contains(&law.effect);
        let other =
            if is_rough { source(Effect::Coulomb, &[4], &[1.0]) } else { source(Effect::Quadratic, &[4], &[50.0]) };
        let sources = [whole(Effect::StiffnessProportional, 1e-5), law.clone(), other];
        let count = law.effect.parameters().len();
        let unknowns: Vec<Unknown> = (0..count).map(|parameter| Unknown::Source { source: 1, parameter }).collect();
        let (response, derivatives) = derived(&structure, &sources, &unknowns);
        for (k, derivative) in derivatives.iter().enumerate() {
            let value = law.parameters[k];
            let step = value.abs() * 1e-4;
            let plus = solved(&structure, &with_parameter(&sources, 1, k, value + step), Some(&response));
            let minus = solved(&structure, &with_parameter(&sources, 1, k, value - step), Some(&response));
            let error = mismatch(derivative, &plus, &minus, step);
            let bound = if is_rough { 2e-2 } else { 1e-4 };
            assert!(error < bound, "{} parameter {k}: {error:.2e}", law.effect);
        }
    }
}

#[test]
fn the_structure() {
    let sources = [whole(Effect::StiffnessProportional, 1e-5), source(Effect::Quadratic, &[2], &[2000.0])];
    let built = |stiffness: f64, mass: f64, lumped: f64| {
        let scaled = |values: &[f64], factor: f64| -> Vec<f64> { values.iter().map(|v| v * factor).collect() };
        let mut masses = scaled(&[1.727, 5.122, 8.213, 2.609, 1.339], mass);
        masses[3] += lumped;
        let ground_stiffness = scaled(&[94263.0, 0.0, 0.0, 0.0, 0.0], stiffness);
        let coupling_stiffness = scaled(&[75136.0, 67744.0, 75466.0, 83396.0], stiffness);
        chain(&masses, &ground_stiffness, &coupling_stiffness)
    };
    let modes: Vec<Unknown> = (0..5).map(Unknown::ModeStiffness).collect();
    let unknowns = [&[Unknown::Stiffness, Unknown::Mass, Unknown::Part(Part::PointMass(3))][..], &modes].concat();
    let (_, derivatives) = derived(&built(1.0, 1.0, 0.0), &sources, &unknowns);
    let step = 1e-5;
    let pairs = [
        (built(1.0 + step, 1.0, 0.0), built(1.0 - step, 1.0, 0.0)),
        (built(1.0, 1.0 + step, 0.0), built(1.0, 1.0 - step, 0.0)),
        (built(1.0, 1.0, step * 2.609), built(1.0, 1.0, -step * 2.609)),
    ];
    for (k, (plus, minus)) in pairs.iter().enumerate() {
        let error = mismatch(&derivatives[k], &solved(plus, &sources, None), &solved(minus, &sources, None), step);
        assert!(error < 1e-4, "{:?}: {error:.2e}", unknowns[k]);
    }
    // The modes' stiffnesses together are the stiffness, but for the damping in proportion to it, which K carries here.
    for i in 0..5 {
        let sum = (3..8).fold(c64::new(0.0, 0.0), |s, k| s + derivatives[k][(i, 0)]);
        assert!((sum - derivatives[0][(i, 0)]).norm() < 5e-3 * sum.norm());
    }
}

/// Stiffness of modes and their couplings, of a structure where some are corrected already.
#[test]
fn the_stiffness_of_modes_and_their_couplings() {
    let sources = [whole(Effect::MassProportional, 3.0), source(Effect::Quadratic, &[2], &[2000.0])];
    let parts = [
        Part::Mode(0),
        Part::Mode(3),
        Part::ModeCoupling([0, 1]),
        Part::ModeCoupling([1, 4]),
        Part::ModeCoupling([2, 3]),
    ];
    let values = [1.04, 0.97, 1.05, 0.96, 1.0];
    let built = |more: &[(Part, f64)]| {
        let corrected: Vec<(Part, f64)> = parts.into_iter().zip(values).collect();
        five_masses().with_factors(&[&corrected[..], &[(Part::Stiffness, 1.02)], more].concat())
    };
    let unknown = |part: &Part| match part {
        Part::Mode(mode) => Unknown::ModeStiffness(*mode),
        Part::ModeCoupling(pair) => Unknown::ModeCoupling(*pair),
        _ => Unknown::Stiffness,
    };
    let unknowns: Vec<Unknown> = parts.iter().map(unknown).collect();
    let (response, derivatives) = derived(&built(&[]), &sources, &unknowns);
    for (part, derivative) in parts.iter().zip(&derivatives) {
        let moved = |factor: f64| solved(&built(&[(*part, factor)]), &sources, Some(&response));
        let error = mismatch(derivative, &moved(1.0 + 1e-5), &moved(1.0 - 1e-5), 1e-5);
        assert!(error < 1e-4, "{part:?}: {error:.2e}");
    }
}

/// Damping of single modes, of a structure where it is corrected already: beside viscous and hysteretic laws, with parts and
/// laws themselves differentiated as well.
#[test]
fn the_damping_of_modes() {
    let sources = [
        whole(Effect::StiffnessProportional, 2e-5),
        whole(Effect::MassProportional, 1.5),
        whole(Effect::LossFactor, 0.004),
        source(Effect::Quadratic, &[2], &[2000.0]),
    ];
    let built = |more: &[(Part, f64)]| {
        let corrected =
            [(Part::ModeDamping(1), 1.7), (Part::ModeDamping(2), 0.6), (Part::ModeDampingPerOctave(2), 1.8)];
        five_masses().with_factors(&[&corrected[..], more].concat())
    };
    let parts: Vec<Part> = (0..4)
        .flat_map(|mode| [Part::ModeDamping(mode), Part::ModeDampingPerOctave(mode)])
        .chain([Part::Stiffness, Part::Mass])
        .collect();
    let unknown = |part: &Part| match part {
        Part::ModeDamping(mode) => Unknown::ModeDamping(*mode),
        Part::ModeDampingPerOctave(mode) => Unknown::ModeDampingPerOctave(*mode),
        Part::Stiffness => Unknown::Stiffness,
        _ => Unknown::Mass,
    };
    let sizes = (0..3).map(|source| Unknown::Source { source, parameter: 0 });
    let unknowns: Vec<Unknown> = parts.iter().map(unknown).chain(sizes).collect();
    let (response, derivatives) = derived(&built(&[]), &sources, &unknowns);
    for (part, derivative) in parts.iter().zip(&derivatives) {
        let moved = |factor: f64| solved(&built(&[(*part, factor)]), &sources, Some(&response));
        let error = mismatch(derivative, &moved(1.0 + 1e-5), &moved(1.0 - 1e-5), 1e-5);
        assert!(error < 1e-4, "{part:?}: {error:.2e}");
    }
    for (k, derivative) in derivatives[parts.len()..].iter().enumerate() {
        let (value, step) = (sources[k].parameters[0], 1e-4 * sources[k].parameters[0]);
        let moved = |value: f64| solved(&built(&[]), &with_parameter(&sources, k, 0, value), Some(&response));
        let error = mismatch(derivative, &moved(value + step), &moved(value - step), step);
        assert!(error < 1e-4, "size of {}: {error:.2e}", sources[k].effect);
    }
}

#[test]
fn unknowns_that_do_not_exist_are_named() {
    let structure = five_masses();
    let sources = [whole(Effect::MassProportional, 1.0)];
    let response = balanced(&structure, &sources, &excitation(), &settings());
    let run = ForwardModel::new(&structure, &sources).unwrap().at(excitation().omega);
    for unknown in [
        Unknown::Source { source: 1, parameter: 0 },
        Unknown::ForceScale(1),
        Unknown::ModeStiffness(7),
        Unknown::ModeDamping(7),
        Unknown::ModeDampingPerOctave(7),
    ] {
        let error =
            sensitivities(&run, &sources, &excitation(), &response, &(0..run.len()).collect::<Vec<_>>(), &[unknown])
                .unwrap_err();
        assert!(matches!(error, SensitivityError::NoSuchUnknown { .. }));
    }
}
