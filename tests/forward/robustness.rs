//! Random models of one to three nonlinear sources, from far below to far above resonance: every one must end in a
//! response that balances all its forces, or say why not.

use super::support::{cantilever, five_masses, source, whole};
use dashpot::control::Control;
use dashpot::effects::{Effect, Source};
use dashpot::response::harmonic_balance::{Attempt, Excitation, ForwardModel, ResponseError, Settings};
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
