//! Methods that take the full receptance matrix.

use super::support::*;
use dashpot::classical::chen::chen;
use dashpot::classical::fritzen::fritzen;
use dashpot::classical::instrumental::instrumental;
use dashpot::classical::lee_kim::{lee_kim, lee_kim_viscous};
use dashpot::classical::phani_woodhouse::phani_woodhouse;
use dashpot::classical::{ClassicalError, ReceptanceData};
use faer::{Mat, c64};
use rand::{RngExt, SeedableRng};

#[test]
fn chen_lee_kim_and_instrumental_variables_are_exact() {
    let (structure, c) = (five_masses(), damping());
    let none = Mat::zeros(5, 5);
    let data = receptance(&structure, &c, &none, &lines());
    assert_exact(&chen(&data).unwrap().viscous, &c);
    assert_exact(&lee_kim_viscous(&data).unwrap().viscous, &c);
    assert_exact(&lee_kim(&data).unwrap().viscous, &c);
    let found = instrumental(&data).unwrap();
    assert_exact(&found.damping.viscous, &c);
    assert_exact(&found.mass, &structure.matrices().unwrap().mass);
    assert_exact(&found.stiffness, &structure.matrices().unwrap().stiffness);
}

#[test]
fn lee_kim_tells_viscous_from_structural() {
    let (structure, c) = (five_masses(), damping());
    let d = scaled(&structure.matrices().unwrap().stiffness, 0.003);
    let found = lee_kim(&receptance(&structure, &c, &d, &lines())).unwrap();
    assert_exact(&found.viscous, &c);
    assert_exact(found.structural.as_ref().unwrap(), &d);
    let one = receptance(&structure, &c, &d, &[30.0, 30.0]);
    assert!(matches!(lee_kim(&one), Err(ClassicalError::Few { .. })));
}

#[test]
fn fritzen_needs_one_exciter_only() {
    let (structure, c) = (five_masses(), damping());
    let data = receptance(&structure, &c, &Mat::zeros(5, 5), &lines());
    let found = fritzen(&loads(&data, 4)).unwrap();
    assert_exact(&found.damping.viscous, &c);
    assert_exact(&found.mass, &structure.matrices().unwrap().mass);
    assert!(matches!(fritzen(&loads(&data, 4)[..3]), Err(ClassicalError::Few { .. })));
}

/// The series (3.128) neglects `(i w)^2 C_0 A^-1 C_0`, of first order in C relative to what is kept: halving C halves the
/// error. Its imaginary part is even of second order where A is real, far from the resonances.
#[test]
fn phani_woodhouse_errs_by_its_neglected_term() {
    let structure = five_masses();
    let modes = structure.modes().unwrap();
    let error = |factor: f64| {
        let c = scaled(&damping(), factor);
        let modal = modal(&structure, &c, 5);
        let ratios: Vec<f64> = (0..5).map(|p| modal.damping_ratio(p)).collect();
        let data = receptance(&structure, &c, &Mat::zeros(5, 5), &lines());
        distance(&phani_woodhouse(&data, &modes, &ratios).unwrap().viscous, &c)
    };
    let (whole, half, tiny) = (error(1.0), error(0.5), error(1e-3));
    assert!(whole < 0.01, "{whole:.2e}");
    assert!(half < 0.55 * whole, "{half:.2e} of {whole:.2e}");
    assert!(tiny < 1e-5, "{tiny:.2e}");
}

/// 1 % noise: least squares on `H Z = I` is biased, instrumental variables much less (Fritzen's conclusion).
#[test]
fn instrumental_variables_take_the_bias_out() {
    let (structure, c) = (five_masses(), scaled(&damping(), 5.0));
    let clean = receptance(&structure, &c, &Mat::zeros(5, 5), &lines());
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(3);
    let mut noisy = |h: &Mat<c64>| {
        Mat::from_fn(5, 5, |i, j| {
            let (a, b) = (random.random_range(-1.0..1.0), random.random_range(-1.0..1.0));
            h[(i, j)] + h.norm_max() * 0.01 * c64::new(a, b)
        })
    };
    let data = ReceptanceData { omega: clean.omega.clone(), matrices: clean.matrices.iter().map(&mut noisy).collect() };
    let error = distance(&instrumental(&data).unwrap().damping.viscous, &c);
    let inverted = distance(&lee_kim_viscous(&data).unwrap().viscous, &c);
    assert!(error < 0.5 * inverted, "{error:.3} against {inverted:.3} by inversion");
}
