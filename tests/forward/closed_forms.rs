//! Harmonic balance against solutions known in closed form.

use super::support::{balanced, five_masses, source, whole};
use crate::common::models::{chain, oscillator};
use dashpot::effects::{Effect, Source};
use dashpot::response::dynamic_stiffness::DynamicStiffness;
use dashpot::response::harmonic_balance::{Excitation, Response, Settings};
use dashpot::structure::Part;
use faer::c64;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn driven(sources: &[Source], omega: f64, force: f64, settings: &Settings) -> Response {
    balanced(&oscillator(2.0, 800.0), sources, &Excitation::sine(omega, 0, c64::new(force, 0.0)), settings)
}

/// Greatest displacement of DOF 0 over the period.
fn peak(response: &Response) -> f64 {
    let period = TAU / response.omega;
    (0..20_000).fold(0.0_f64, |m, n| m.max(response.state_at(period * f64::from(n) / 20_000.0).0[0].abs()))
}

/// Energy per cycle taken out by source force number `index`: `pi sum_h h Im(F_h conj(D_h))`.
fn energy(response: &Response, index: usize) -> f64 {
    let force = &response.forces[index];
    let term = |h: usize| {
        let d = force.leg.relative(|i| response.amplitude(i, h));
        h as f64 * (force.harmonics[h - 1] * d.conj()).im
    };
    PI * (1..=force.harmonics.len()).map(term).sum::<f64>()
}

/// Den Hartog (1931): motion without stops, `x_max / (P/k) = sqrt(V^2 - (R/P)^2 U^2)`, `V = 1/(1 - b^2)`,
/// `U = sin(pi/b) / (b (1 + cos(pi/b)))`, `b = w/wn`.
#[test]
fn den_hartogs_oscillator_with_dry_friction() {
    let (stiffness, force) = (800.0, 10.0);
    for (b, ratio) in [(0.6_f64, 0.2_f64), (0.8, 0.3), (1.3, 0.25), (1.8, 0.3)] {
        let response =
            driven(&[source(Effect::Coulomb, &[0], &[ratio * force])], b * 20.0, force, &Settings::default());
        let v = 1.0 / (1.0 - b * b);
        let u = (PI / b).sin() / (b * (1.0 + (PI / b).cos()));
        let expected = force / stiffness * (v * v - (ratio * u).powi(2)).sqrt();
        let found = peak(&response);
        assert!((found / expected - 1.0).abs() < 1e-3, "w/wn {b}: {found} {expected}");
    }
}

/// The sum of modes, each with its own damping: `x = sum_r phi_r phi_r^T F / (w_r^2 - w^2 + i w f_r (alpha + beta w_r^2))`, of few
/// masses, whose receptance is an inverse, and of many, whose receptance is a sum of modes; the matrix of the dynamic stiffness and
/// the energy that the laws take agree with it.
#[test]
fn modes_damped_each_by_itself() {
    let (alpha, beta) = (0.8, 2e-5);
    let sources = [whole(Effect::MassProportional, alpha), whole(Effect::StiffnessProportional, beta)];
    for count in [5, 70] {
        let masses: Vec<f64> = (0..count).map(|i| 1.0 + 0.1 * (i % 3) as f64).collect();
        let ground: Vec<f64> = (0..count).map(|i| if i == 0 { 5e4 } else { 0.0 }).collect();
        let stated = chain(&masses, &ground, &vec![7e4; count - 1]);
        let factors = [(0, 1.6), (1, 0.4), (3, 2.5)];
        let structure = stated.with_factors(&factors.map(|(mode, f)| (Part::ModeDamping(mode), f)));
        let modes = stated.modes().unwrap();
        let omega = 1.01 * modes.omega[1];
        let excitation = Excitation::sine(omega, 2, c64::new(3.0, 0.0));
        let response = balanced(&structure, &sources, &excitation, &Settings::default());
        let factor = |mode: usize| factors.iter().find(|(m, _)| *m == mode).map_or(1.0, |(_, f)| *f);
        let motion_of_dof = |dof: usize| {
            let term = |r: usize| {
                let square = modes.omega[r].powi(2);
                let z = c64::new(square - omega * omega, omega * factor(r) * (alpha + beta * square));
                c64::new(3.0 * modes.shapes[(dof, r)] * modes.shapes[(2, r)], 0.0) / z
            };
            (0..count).map(term).sum::<c64>()
        };
        let motion: Vec<c64> = (0..count).map(motion_of_dof).collect();
        for (dof, expected) in motion.iter().enumerate() {
            let found = response.amplitude(dof, 1);
            assert!((found - expected).norm() < 1e-9 * motion[1].norm(), "{count}, DOF {dof}: {found} {expected}");
        }
        let z = DynamicStiffness::new(&structure, &sources).unwrap().matrix(omega);
        let force = (0..count).map(|j| z[(2, j)] * motion[j]).sum::<c64>();
        assert!((force - c64::new(3.0, 0.0)).norm() < 1e-8, "{count}: {force}");
    }
}

/// Structural damping `i eta omega_r^2` of a mode that goes with frequency as viscous damping does, twice an octave higher, is
/// viscous damping `i omega eta omega_r`: the sum of modes.
#[test]
fn structural_damping_that_doubles_by_octave_is_viscous() {
    let (eta, sources) = (0.03, [whole(Effect::LossFactor, 0.03)]);
    for count in [4, 70] {
        let masses: Vec<f64> = (0..count).map(|i| 1.0 + 0.1 * (i % 3) as f64).collect();
        let stated = chain(&masses, &vec![2e4; count], &vec![7e4; count - 1]);
        let all: Vec<(Part, f64)> = (0..count).map(|mode| (Part::ModeDampingPerOctave(mode), 2.0)).collect();
        let structure = stated.with_factors(&all);
        let modes = stated.modes().unwrap();
        for ratio in [0.6, 1.0, 1.9] {
            let omega = ratio * modes.omega[1];
            let response =
                balanced(&structure, &sources, &Excitation::sine(omega, 2, c64::new(3.0, 0.0)), &Settings::default());
            let largest = response.amplitude(2, 1).norm();
            for dof in 0..count {
                let term = |r: usize| {
                    let z = c64::new(modes.omega[r].powi(2) - omega * omega, omega * eta * modes.omega[r]);
                    c64::new(3.0 * modes.shapes[(dof, r)] * modes.shapes[(2, r)], 0.0) / z
                };
                let (found, expected) = (response.amplitude(dof, 1), (0..count).map(term).sum::<c64>());
                assert!((found - expected).norm() < 1e-9 * largest, "{count}, {dof}: {found} {expected}");
            }
        }
    }
}

/// Friction above the driving force holds everything.
#[test]
fn dry_friction_above_the_force_holds() {
    let response = driven(&[source(Effect::Coulomb, &[0], &[10.5])], 18.0, 10.0, &Settings::default());
    assert!(peak(&response) < 1e-8 * 10.0 / 800.0);
    assert!((response.forces[0].harmonics[0] - c64::new(10.0, 0.0)).norm() < 1e-6);
}

/// One harmonic: `F_1 = 8/(3 pi) c w^2 |X| X i`, and `4/pi F_c` for friction.
#[test]
fn equivalent_dampers_of_one_harmonic() {
    let (c, omega) = (30.0, 18.0);
    let response = driven(&[source(Effect::Quadratic, &[0], &[c])], omega, 10.0, &Settings::fixed(1));
    let x = response.amplitude(0, 1);
    let expected = x * c64::new(0.0, 8.0 / (3.0 * PI) * c * omega * omega * x.norm());
    assert!((response.forces[0].harmonics[0] - expected).norm() < 1e-4 * expected.norm());
    let settings = Settings { estimate: false, ..Settings::fixed(1) };
    let response = driven(&[source(Effect::Coulomb, &[0], &[2.0])], omega, 10.0, &settings);
    assert!((response.forces[0].harmonics[0].norm() - 8.0 / PI).abs() < 5e-3);
}

#[test]
fn energy_of_jenkins_and_iwan_elements() {
    for element in
        [source(Effect::ElasticSlider, &[0], &[600.0, 3.0]), source(Effect::Iwan, &[0], &[600.0, 3.0, -0.4, 1.5])]
    {
        let response =
            driven(&[element.clone(), source(Effect::Viscous, &[0], &[2.0])], 20.0, 10.0, &Settings::default());
        let law = element.effect.law().unwrap();
        let expected = law.energy_per_cycle(&element.parameters, peak(&response), 20.0).unwrap();
        assert!(expected > 0.0);
        let found = energy(&response, 0);
        assert!((found / expected - 1.0).abs() < 2e-3, "{}: {found} {expected}", element.effect);
    }
}

#[test]
fn a_fractional_element_on_an_oscillator() {
    let (c, order, omega) = (40.0, 0.35_f64, 18.0_f64);
    let response = driven(&[source(Effect::Fractional, &[0], &[c, order])], omega, 10.0, &Settings::default());
    let (sin, cos) = (order * FRAC_PI_2).sin_cos();
    let element = c64::new(cos, sin) * (c * omega.powf(order));
    let expected = c64::new(10.0, 0.0) / (c64::new(800.0 - 2.0 * omega * omega, 0.0) + element);
    assert!((response.amplitude(0, 1) - expected).norm() < 1e-9 * expected.norm());
}

/// Laws without a force in time: `k + i h` and `k (1 + i eta)`.
#[test]
fn hysteretic_elements_and_the_loss_factor_on_an_oscillator() {
    let omega = 19.5;
    for (law, loss) in
        [(source(Effect::Hysteretic, &[0], &[30.0]), 30.0), (whole(Effect::LossFactor, 0.03), 0.03 * 800.0)]
    {
        let response = driven(&[law], omega, 10.0, &Settings::default());
        let expected = c64::new(10.0, 0.0) / c64::new(800.0 - 2.0 * omega * omega, loss);
        assert!((response.amplitude(0, 1) - expected).norm() < 1e-10 * expected.norm());
    }
}

/// What the exciter puts in, all sources together take out.
#[test]
fn energy_is_balanced() {
    let sources = [
        source(Effect::Viscous, &[2], &[20.0]),
        source(Effect::Quadratic, &[1, 2], &[500.0]),
        source(Effect::CubicStiffness, &[3], &[1e11]),
        source(Effect::ElasticSlider, &[4], &[2e4, 3.0]),
    ];
    let excitation = Excitation::sine(TAU * 21.5, 4, c64::new(20.0, 5.0));
    let response = balanced(&five_masses(), &sources, &excitation, &Settings::default());
    // Power of f on v = i w x over a cycle: pi Im(F conj(X)).
    let input = PI * (c64::new(20.0, 5.0) * response.amplitude(4, 1).conj()).im;
    let taken: f64 = (0..response.forces.len()).map(|i| energy(&response, i)).sum();
    assert!((taken / input - 1.0).abs() < 1e-7, "{taken} {input}");
}

/// The linear path agrees with the closed form of a damped oscillator, at its very resonance as well.
#[test]
fn a_linear_oscillator_at_resonance() {
    let response = driven(&[source(Effect::Viscous, &[0], &[0.4])], 20.0, 10.0, &Settings::default());
    let expected = c64::new(10.0, 0.0) / c64::new(0.0, 20.0 * 0.4);
    assert!((response.amplitude(0, 1) - expected).norm() < 1e-7 * expected.norm());
}

/// A structure that floats, of many DOFs, where modes stand in for the inverse.
#[test]
fn modes_satisfy_the_equations_of_motion() {
    let mut masses = vec![1.0; 70];
    masses[0] = 2.0;
    let structure = chain(&masses, &[0.0; 70], &[1e6; 69]);
    let sources = [
        whole(Effect::LossFactor, 0.02),
        source(Effect::Viscous, &[30, 31], &[40.0]),
        source(Effect::Coulomb, &[69], &[1.0]),
    ];
    let excitation = Excitation::sine(100.0, 0, c64::new(30.0, 0.0));
    let response = balanced(&structure, &sources, &excitation, &Settings { estimate: false, ..Settings::fixed(7) });
    // The seventh harmonic is not extrapolated: it must satisfy the equations of motion.
    let matrices = structure.matrices().unwrap();
    let h = 7;
    let w = 100.0 * h as f64;
    let friction = response.forces.iter().find(|f| f.source == 2).unwrap().harmonics[h - 1];
    let dashpot = response.forces.iter().find(|f| f.source == 1).unwrap().harmonics[h - 1];
    let mut worst = 0.0_f64;
    for i in 0..70 {
        let mut sum = c64::new(0.0, 0.0);
        for j in 0..70 {
            let z = c64::new(matrices.stiffness[(i, j)], 0.02 * matrices.stiffness[(i, j)])
                - c64::new(w * w * matrices.mass[(i, j)], 0.0);
            sum += z * response.amplitude(j, h);
        }
        let external = match i {
            69 => -friction,
            30 => -dashpot,
            31 => dashpot,
            _ => c64::new(0.0, 0.0),
        };
        worst = worst.max((sum - external).norm());
    }
    assert!(friction.norm() > 0.01, "the test needs a seventh harmonic");
    assert!(worst < 1e-7 * friction.norm(), "{worst:.1e} {friction}");
}
