//! Methods that take complex modes.

use super::support::*;
use dashpot::classical::adhikari_woodhouse::{original, projection_error, symmetric};
use dashpot::classical::frf_inverse::frf_inverse;
use dashpot::classical::ibrahim::ibrahim;
use dashpot::classical::lancaster::lancaster;
use dashpot::classical::minas_inman::minas_inman;
use dashpot::classical::{ClassicalError, pilkey_inman};
use dashpot::structure::damped_modes::damped_modes;

#[test]
fn lancaster_and_pilkey_inman_are_exact() {
    let (structure, c) = (five_masses(), damping());
    let matrices = structure.matrices().unwrap();
    let (m, k) = (matrices.mass.as_ref(), matrices.stiffness.as_ref());
    let modes = modal(&structure, &c, 5);
    assert_exact(&lancaster(m, &modes).unwrap().viscous, &c);
    let any = unscaled(&modes);
    assert!(matches!(lancaster(m, &any), Err(ClassicalError::Missing { .. })));
    assert_exact(&pilkey_inman::iterative(m, &any).unwrap().viscous, &c);
    assert_exact(&pilkey_inman::direct(m, k, &any).unwrap().viscous, &c);
}

#[test]
fn truncated_lancaster_returns_the_measured_poles() {
    let (structure, c) = (five_masses(), damping());
    let matrices = structure.matrices().unwrap();
    let (m, k) = (matrices.mass.as_ref(), matrices.stiffness.as_ref());
    let modes = modal(&structure, &c, 3);
    let found = lancaster(m, &modes).unwrap().viscous;
    assert!(distance(&found, &c) > 0.05);
    // The property that the thesis states below (3.91), to first order in the coupling of the modes by damping.
    for (pole, mode) in modes.poles.iter().zip(damped_modes(m, k, found.as_ref()).unwrap()) {
        assert!((pole - mode.lambda).norm() < 1e-5 * pole.norm(), "{pole} {}", mode.lambda);
    }
}

#[test]
fn ibrahim_and_minas_inman_are_exact() {
    let (structure, c) = (five_masses(), damping());
    let matrices = structure.matrices().unwrap();
    let (m, k) = (matrices.mass.as_ref(), matrices.stiffness.as_ref());
    let modes = unscaled(&modal(&structure, &c, 5));
    assert_exact(&ibrahim(m, &structure.modes().unwrap(), &modes).unwrap().viscous, &c);
    assert_exact(&minas_inman(m, k, &modes).unwrap().viscous, &c);
    // Three modes fix all 15 entries: each gives ten rows.
    assert_exact(&minas_inman(m, k, &unscaled(&modal(&structure, &c, 3))).unwrap().viscous, &c);
}

#[test]
fn ibrahim_gives_the_rest_the_mean_ratio() {
    let (structure, c) = (five_masses(), damping());
    let matrices = structure.matrices().unwrap();
    let (m, k) = (matrices.mass.as_ref(), matrices.stiffness.as_ref());
    let modes = unscaled(&modal(&structure, &c, 3));
    let mean = (0..3).map(|p| modes.damping_ratio(p)).sum::<f64>() / 3.0;
    let found = ibrahim(m, &structure.modes().unwrap(), &modes).unwrap();
    let ratios = damped_modes(m, k, found.viscous.as_ref()).unwrap();
    for mode in &ratios[3..] {
        assert!((mode.damping_ratio / mean - 1.0).abs() < 0.02, "{} {mean}", mode.damping_ratio);
    }
    assert!(found.notes[0].starts_with("2 modes of the model"), "{:?}", found.notes);
}

/// First-order perturbation: what it neglects is of second order in C, so halving C divides the *relative* error by two
/// (original) or more; at the damping of (6.13) it is below one per cent.
#[test]
fn perturbation_errs_by_its_neglected_order() {
    let structure = five_masses();
    let matrices = structure.matrices().unwrap();
    let m = matrices.mass.as_ref();
    for method in [original, symmetric] {
        let error = |factor: f64| {
            let c = scaled(&damping(), factor);
            distance(&method(m, &unscaled(&modal(&structure, &c, 5))).unwrap().viscous, &c)
        };
        let (whole, half, tiny) = (error(1.0), error(0.5), error(1e-3));
        assert!(whole < 0.01, "{whole:.2e}");
        assert!(half < 0.55 * whole, "{half:.2e} of {whole:.2e}");
        assert!(tiny < 1e-5, "{tiny:.2e}");
    }
}

#[test]
fn projection_error_vanishes_when_all_modes_are_there() {
    let (structure, c) = (five_masses(), damping());
    let m = structure.matrices().unwrap().mass.as_ref();
    assert!(projection_error(m, &modal(&structure, &c, 5)).unwrap() < 1e-8);
    assert!(projection_error(m, &modal(&structure, &c, 3)).unwrap() > 1.0);
}

#[test]
fn inverse_of_the_completed_receptance_is_exact() {
    let (structure, c) = (five_masses(), damping());
    let found = frf_inverse(&structure.modes().unwrap(), &modal(&structure, &c, 5)).unwrap();
    assert_exact(&found.viscous, &c);
}
