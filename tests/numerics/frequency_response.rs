//! Frequency responses by factorisation against sums over modes, and half-power damping against its closed form.

use crate::common::models::{cantilever, oscillator, source, whole};
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::response::dynamic_stiffness::{DynamicStiffness, DynamicStiffnessError};
use dashpot::response::frequency_response::{ResponseForm, direct, half_power, modal};
use dashpot::response::linear_matrices::LinearMatrices;
use dashpot::response::steady_state::steady_state;
use dashpot::structure::SystemMatrices;
use dashpot::structure::damped_modes::{damped_modes, damped_modes_from};
use dashpot::structure::modes::modes;
use faer::c64;
use nalgebra::DMatrix;

#[test]
fn viscous_by_factorisation_and_by_modes() {
    let structure = cantilever(5);
    let sources = [
        source(Effect::Viscous, &[2], &[0.2]),
        source(Effect::Viscous, &[4, 8], &[0.7]),
        source(Effect::Stiffness, &[6], &[300.0]),
        source(Effect::Mass, &[8], &[0.02]),
        whole(Effect::StiffnessProportional, 1e-6),
        whole(Effect::MassProportional, 0.4),
    ];
    let z = DynamicStiffness::new(&structure, &sources).unwrap();
    let constant = LinearMatrices::new(&structure, &sources).unwrap();
    assert!(constant.others.is_empty());
    let found = damped_modes(constant.mass.as_ref(), constant.stiffness.as_ref(), constant.viscous.as_ref()).unwrap();
    for omega in [5.0, 70.0, 411.0, 5000.0] {
        let one = direct(&z, 8, 2, &[omega], ResponseForm::Receptance, &Control::unattended()).unwrap()[0];
        let other = modal(&found, 8, 2, omega).unwrap();
        assert!((one - other).norm() < 1e-9 * one.norm(), "{omega}: {one} {other}");
    }
}

#[test]
fn hysteretic_against_a_solver_of_its_own() {
    let structure = cantilever(5);
    let sources = [
        source(Effect::Hysteretic, &[4], &[50.0]),
        Source::known(Effect::LossFactor, Place::Whole(Some([1, 2])), &[0.03]),
    ];
    let z = DynamicStiffness::new(&structure, &sources).unwrap();
    let h = LinearMatrices::new(&structure, &sources).unwrap().hysteretic;
    let matrices = structure.matrices().unwrap();
    for omega in [5.0, 70.0, 411.0] {
        let one = z.factorise(omega).receptance_column(2).unwrap()[8];
        let dense = DMatrix::from_fn(10, 10, |i, j| {
            c64::new(matrices.stiffness[(i, j)] - omega * omega * matrices.mass[(i, j)], h[(i, j)])
        });
        let other = dense.try_inverse().unwrap()[(8, 2)];
        assert!((one - other).norm() < 1e-9 * one.norm(), "{omega}: {one} {other}");
    }
}

#[test]
fn laws_that_depend_on_frequency_enter_at_each() {
    let structure = oscillator(2.0, 800.0);
    let maxwell = source(Effect::Maxwell, &[0], &[500.0, 30.0]);
    let z = DynamicStiffness::new(&structure, &[maxwell]).unwrap();
    for omega in [3.0, 20.0, 90.0] {
        let dashpot = c64::new(0.0, omega * 30.0);
        let series = dashpot * 500.0 / (dashpot + 500.0);
        let expected = c64::new(800.0 - 2.0 * omega * omega, 0.0) + series;
        assert!((z.matrix(omega)[(0, 0)] - expected).norm() < 1e-9);
    }
}

#[test]
fn one_degree_of_freedom_at_its_resonance() {
    // |H(wn)| = 1 / (c wn), phase -90 degrees; mobility and accelerance follow.
    let structure = oscillator(2.0, 800.0);
    let z = DynamicStiffness::new(&structure, &[source(Effect::Viscous, &[0], &[4.0])]).unwrap();
    let at_resonance = |q| direct(&z, 0, 0, &[20.0], q, &Control::unattended()).unwrap()[0];
    assert!((at_resonance(ResponseForm::Receptance) - c64::new(0.0, -1.0 / 80.0)).norm() < 1e-15);
    assert!((at_resonance(ResponseForm::Mobility) - c64::new(0.25, 0.0)).norm() < 1e-14);
    assert!((at_resonance(ResponseForm::Accelerance) - c64::new(0.0, 5.0)).norm() < 1e-13);
}

#[test]
fn half_power_points_give_the_damping_back() {
    let structure = oscillator(2.0, 800.0);
    let omega: Vec<f64> = (0..400).map(|k| 15.0 + 0.025 * f64::from(k)).collect();
    let half_power_of = |source: Source| {
        let z = DynamicStiffness::new(&structure, &[source]).unwrap();
        half_power(&omega, &direct(&z, 0, 0, &omega, ResponseForm::Receptance, &Control::unattended()).unwrap())
            .unwrap()
    };
    // Exact for hysteretic damping, at any loss factor; for viscous damping to second order in zeta.
    let hysteretic = half_power_of(source(Effect::Hysteretic, &[0], &[800.0 * 0.07]));
    assert!((hysteretic.loss_factor - 0.07).abs() < 1e-10, "{hysteretic:?}");
    assert!((hysteretic.omega_peak - 20.0).abs() < 1e-9);
    let zeta = 0.02;
    let viscous = half_power_of(source(Effect::Viscous, &[0], &[2.0 * zeta * 2.0 * 20.0]));
    let exact = zeta * (1.0 - zeta * zeta).sqrt() / (1.0 - 2.0 * zeta * zeta);
    assert!((viscous.damping_ratio() - exact).abs() < 1e-10, "{viscous:?}");
    assert!((viscous.omega_peak - 20.0 * (1.0 - 2.0 * zeta * zeta).sqrt()).abs() < 1e-9);
    assert_eq!(half_power(&omega[..50], &vec![c64::new(1.0, 0.0); 50]), None);
}

#[test]
fn harmonics_are_solved_one_by_one() {
    let structure = cantilever(5);
    let z = DynamicStiffness::new(&structure, &[source(Effect::Viscous, &[8], &[0.3])]).unwrap();
    let mut force = vec![vec![c64::new(0.0, 0.0); 10]; 3];
    force[0][8] = c64::new(1.0, 0.5);
    force[2][8] = c64::new(0.0, -0.1);
    let x = steady_state(&z, 50.0, &force).unwrap();
    let third = z.factorise(150.0).receptance_column(8).unwrap();
    assert!(x[1].iter().all(|v| v.norm() == 0.0));
    assert!((0..10).all(|i| (x[2][i] - third[i] * c64::new(0.0, -0.1)).norm() < 1e-18));
    // Work of the force over a period equals pi sum_h c h omega |X_h|^2.
    let work: f64 = (0..3)
        .map(|h| {
            let velocity = c64::new(0.0, (h + 1) as f64 * 50.0) * x[h][8];
            std::f64::consts::PI / 50.0 * (velocity.conj() * force[h][8]).re
        })
        .sum();
    let lost: f64 =
        (0..3).map(|h| std::f64::consts::PI * 0.3 * (h + 1) as f64 * (h + 1) as f64 * 50.0 * x[h][8].norm_sqr()).sum();
    assert!((work / lost - 1.0).abs() < 1e-9);
}

#[test]
fn errors_name_the_law_and_the_place() {
    let structure = cantilever(5);
    let coulomb = source(Effect::Coulomb, &[2, 4], &[1.0]);
    let error = DynamicStiffness::new(&structure, &[coulomb]).err().unwrap();
    assert_eq!(
        error.to_string(),
        "the response is not linear because of Coulomb friction between DOF 3 and 5: use harmonic balance"
    );
    let far = DynamicStiffness::new(&structure, &[source(Effect::Viscous, &[10], &[1.0])]).err().unwrap();
    assert!(matches!(far, DynamicStiffnessError::Row { row: 10, size: 10, .. }));
    let z = DynamicStiffness::new(&structure, &[]).unwrap();
    assert_eq!(z.solve(1.0, &[]), Err(DynamicStiffnessError::ForceSize { found: 0, size: 10 }));
    let free = SystemMatrices { mass: faer::mat![[1.0]], stiffness: faer::mat![[0.0]] };
    let rigid = damped_modes_from(&modes(&free).unwrap(), faer::mat![[0.0]].as_ref()).unwrap();
    assert_eq!(modal(&rigid, 0, 0, 1.0), Err(DynamicStiffnessError::RigidBody));
}
