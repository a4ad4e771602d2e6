//! Random models of one to three nonlinear sources, from far below to far above resonance: every one must end in a
//! response that balances all its forces, or say why not.

use super::support::{cantilever, five_masses, source, whole};
use crate::common::models::chain;
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::response::harmonic_balance::{Attempt, Excitation, ForwardModel, ResponseError, Settings};
use dashpot::structure::Structure;
use faer::c64;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// A law with parameters that matter for forces of the size `force` N and displacements of the size `d` m.
fn random_source(rng: &mut ChaCha8Rng, rows: &[usize], force: f64, d: f64, omega: f64) -> Source {
    let first = rows[rng.random_range(0..rows.len())];
    let second = rows[rng.random_range(0..rows.len())];
    let dofs = if rng.random_bool(0.5) || first == second { vec![first] } else { vec![first, second] };
    let f = force * 10f64.powf(rng.random_range(-1.5..0.5));
    let (v, k) = (omega * d, f / d);
    match rng.random_range(0..8) {
        0 | 1 => source(Effect::Coulomb, &dofs, &[f]),
        2 => source(Effect::Stribeck, &dofs, &[f, 1.3 * f, 0.3 * v]),
        3 => source(Effect::Quadratic, &dofs, &[f / (v * v)]),
        4 => source(Effect::Power, &dofs, &[f / v.powf(0.4), 0.4]),
        5 => source(Effect::ElasticSlider, &dofs, &[3.0 * k, f]),
        6 => source(Effect::Iwan, &dofs, &[3.0 * k, f, -0.5, 1.0]),
        _ => source(Effect::CubicStiffness, &dofs, &[0.3 * f / (d * d * d)]),
    }
}

#[test]
fn random_models_find_a_response() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let settings = Settings { estimate: false, ..Settings::fixed(7) };
    let (mut failed, mut by_arc) = (Vec::new(), 0);
    let (chain, beam) = (five_masses(), cantilever(5));
    for trial in 0..150 {
        let on_beam = trial % 2 == 1;
        let structure = if on_beam { &beam } else { &chain };
        let (drive, rows, force, d): (usize, &[usize], f64, f64) =
            if on_beam { (8, &[0, 2, 4, 6, 8], 1.0, 1e-2) } else { (4, &[0, 1, 2, 3, 4], 20.0, 5e-4) };
        let frequency = if on_beam { rng.random_range(5.0..150.0) } else { rng.random_range(10.0..60.0) };
        let omega = TAU * frequency;
        let mut sources = vec![whole(Effect::StiffnessProportional, 2e-5)];
        for _ in 0..rng.random_range(1..4) {
            sources.push(random_source(&mut rng, rows, force, d, omega));
        }
        let model = ForwardModel::new(structure, &sources).unwrap();
        let excitation = Excitation::sine(omega, drive, c64::new(force, 0.0));
        match model.respond(&excitation, &settings, None, &Control::unattended()) {
            Ok(response) => {
                assert!(response.amplitude(drive, 1).norm().is_finite());
                by_arc += usize::from(response.history.iter().any(|step| step.attempt == Attempt::Arc));
            }
            Err(ResponseError::NotConverged { .. }) => failed.push((trial, frequency, sources)),
            Err(other) => panic!("{other}"),
        }
    }
    println!("{} of 150 failed, {by_arc} needed the arc", failed.len());
    assert!(failed.is_empty(), "{} of 150 failed: {failed:#?}", failed.len());
}

/// Every law that acts on a structure, with the size of each of its parameters for forces of 1 N, motions of 1 m and a
/// circular frequency of 1 rad/s.
const LAWS: [(Effect, &[f64]); 18] = [
    (Effect::Viscous, &[1.0]),
    (Effect::Coulomb, &[0.5]),
    (Effect::Quadratic, &[1.0]),
    (Effect::Power, &[1.0, 0.6]),
    (Effect::Hysteretic, &[0.2]),
    (Effect::Stribeck, &[0.3, 0.5, 0.3]),
    (Effect::ElasticSlider, &[2.0, 0.5]),
    (Effect::Maxwell, &[1.0, 1.0]),
    (Effect::Iwan, &[2.0, 0.5, -0.5, 1.0]),
    (Effect::Fractional, &[0.3, 0.5]),
    (Effect::Stiffness, &[0.3]),
    (Effect::CubicStiffness, &[0.3]),
    (Effect::QuadraticStiffness, &[0.3]),
    (Effect::Gap, &[1.0, 0.5]),
    (Effect::Mass, &[0.2]),
    (Effect::LossFactor, &[0.02]),
    (Effect::StiffnessProportional, &[1e-3]),
    (Effect::MassProportional, &[0.1]),
];

/// A law anywhere, its parameters off their size by up to nine decades now and then, zero, or negative where that is
/// allowed. `force` N, `d` m and `omega` rad/s are the sizes of forces and motions.
fn any_source(rng: &mut ChaCha8Rng, size: usize, [force, d, omega]: [f64; 3]) -> Source {
    let (effect, sizes) = LAWS[rng.random_range(0..LAWS.len())];
    let parameters = effect.parameters().iter().zip(sizes).map(|(parameter, &size)| {
        let decades = if rng.random_bool(0.8) { 1.0 } else { 9.0 };
        let factor = 10f64.powf(rng.random_range(-decades..decades));
        let value = match parameter.name {
            "exponent" => rng.random_range(0.05..3.0),
            "order" => rng.random_range(0.02..0.98),
            "chi" => rng.random_range(-0.95..-0.05),
            "beta" if effect == Effect::Iwan => rng.random_range(0.0..10.0),
            "force" | "static_force" => size * force * factor,
            "velocity" => size * d * omega * factor,
            "gap" => size * d * factor,
            "c" if matches!(effect, Effect::Quadratic) => size * force / (d * omega).powi(2) * factor,
            "c" => size * force / (d * omega) * factor,
            "stiffness" if effect == Effect::CubicStiffness => size * force / d.powi(3) * factor,
            "stiffness" if effect == Effect::QuadraticStiffness => size * force / (d * d) * factor,
            "stiffness" | "loss_stiffness" => size * force / d * factor,
            "mass" => size * force / (d * omega * omega) * factor,
            _ => size * factor,
        };
        if rng.random_bool(0.03) { 0.0 } else { value }
    });
    let parameters: Vec<f64> = parameters.collect();
    let place = if matches!(effect, Effect::LossFactor | Effect::StiffnessProportional | Effect::MassProportional) {
        Place::Whole(None)
    } else {
        let mut dofs: Vec<usize> = (0..rng.random_range(1..4)).map(|_| rng.random_range(0..size)).collect();
        dofs.dedup();
        if dofs.len() == 3 && dofs[0] == dofs[2] {
            dofs.pop();
        }
        Place::Dofs(dofs)
    };
    Source::known(effect, place, &parameters)
}

/// Answers and one-line refusals of `count` random models, some of them with nothing that damps.
fn wild_models(seed: u64, count: usize) -> [usize; 2] {
    let floating = chain(&[1.0, 2.0, 3.0], &[0.0; 3], &[1e5; 2]);
    let structures: [(Structure, [f64; 3]); 3] =
        [(five_masses(), [20.0, 5e-4, 130.0]), (cantilever(4), [1.0, 1e-2, 65.0]), (floating, [10.0, 1e-3, 200.0])];
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let settings = Settings { harmonics: 5, most_harmonics: 11, ..Settings::default() };
    let mut ends = [0, 0];
    for trial in 0..count {
        let (structure, sizes) = &structures[trial % 3];
        let sources: Vec<Source> =
            (0..rng.random_range(0..5)).map(|_| any_source(&mut rng, structure.len(), *sizes)).collect();
        let omega = sizes[2] * 10f64.powf(rng.random_range(-1.5..1.5));
        let drive = rng.random_range(0..structure.len());
        let amplitude = sizes[0] * [1.0, 1.0, 1e-6, 1e4][rng.random_range(0..4)];
        let mut excitation = Excitation::sine(omega, drive, c64::new(amplitude, 0.0));
        if rng.random_bool(0.3) {
            excitation.forces[0].harmonics.push(c64::new(0.0, 0.05 * amplitude));
        }
        let answer = ForwardModel::new(structure, &sources)
            .map_err(ResponseError::from)
            .and_then(|model| model.at(omega).branches(&sources, &excitation, &settings, &Control::unattended()));
        match answer {
            Ok(found) => {
                assert!(!found.is_empty(), "trial {trial}: {sources:?}");
                let values = found.iter().flat_map(|(r, _)| (0..structure.len()).map(|i| r.amplitude(i, 1).norm()));
                for value in values {
                    assert!(value.is_finite(), "trial {trial} at {omega} rad/s: {sources:?}");
                }
                ends[0] += 1;
            }
            Err(error) => {
                assert_eq!(error.to_string().lines().count(), 1);
                ends[1] += 1;
            }
        }
    }
    ends
}

#[test]
fn wild_models_end_in_an_answer_or_one_line() {
    let [answers, refusals] = wild_models(3, 150);
    assert!(answers > 9 * refusals, "{answers} answers, {refusals} refusals");
}

#[test]
#[ignore = "minutes: by hand after a change of the solver"]
fn very_many_wild_models_end_in_an_answer_or_one_line() {
    for seed in 10..40 {
        println!("seed {seed}: {:?} answers and refusals", wild_models(seed, 300));
    }
}
