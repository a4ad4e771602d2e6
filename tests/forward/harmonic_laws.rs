//! Laws that are defined harmonic by harmonic, against routes through time: the fractional element against stepping with
//! the derivative of Gruenwald and Letnikov, hysteretic elements and the loss factor against dashpots that take as much
//! out of each cycle, and by their energy.

use super::support::{balanced, cantilever, difference, elastic, five_masses, source, stepped, whole};
use dashpot::effects::{Effect, Source};
use dashpot::response::harmonic_balance::{Excitation, Response, Settings};
use dashpot::structure::Structure;
use dashpot_numerics::RealLu;
use faer::{Mat, c64};
use std::f64::consts::{PI, TAU};

/// Both structures with proportional damping `beta` K, the row that is driven, the force (N) and a frequency (Hz).
fn structures() -> [(&'static str, Structure, f64, Excitation); 2] {
    [
        ("masses", five_masses(), 1e-3, Excitation::sine(TAU * 21.0, 4, c64::new(20.0, 0.0))),
        ("beam", cantilever(4), 1e-3, Excitation::sine(TAU * 10.0, 6, c64::new(1.0, 0.0))),
    ]
}

/// Weights of Gruenwald and Letnikov: `w_0 = 1`, `w_j = w_(j-1) (1 - (order + 1) / j)`.
fn weights(order: f64, count: usize) -> Vec<f64> {
    let mut w = 1.0;
    (0..count)
        .map(|j| {
            w *= if j == 0 { 1.0 } else { 1.0 - (order + 1.0) / j as f64 };
            w
        })
        .collect()
}

/// Amplitude of the fundamental of every DOF under `c` times the derivative of fractional order at row `dof`, from rest by
/// the trapezoidal rule (Newmark). The weighted sum of past motions is the derivative half an order of steps ago, to the
/// second order in the step; two of them give it now.
fn stepped_fractional(
    structure: &Structure,
    beta: f64,
    (dof, c, order): (usize, f64, f64),
    excitation: &Excitation,
    steps: usize,
) -> Vec<c64> {
    const PERIODS: usize = 40;
    let n = structure.len();
    let matrices = structure.matrices().unwrap();
    let (m, k) = (&matrices.mass, &matrices.stiffness);
    let step = TAU / excitation.omega / steps as f64;
    let gain = c * step.powf(-order);
    let w = weights(order, PERIODS * steps + 1);
    let effective = Mat::from_fn(n, n, |i, j| {
        let own = if i == dof && j == dof { gain * (1.0 + 0.5 * order) } else { 0.0 };
        k[(i, j)] * (1.0 + 2.0 / step * beta) + 4.0 / (step * step) * m[(i, j)] + own
    });
    let lu = RealLu::new(effective.as_ref());
    let mut x = vec![0.0; n];
    let (mut v, mut a) = (x.clone(), x.clone());
    let (mut past, mut sum_before) = (vec![0.0], 0.0);
    let force = &excitation.forces[0];
    let mut amplitude = vec![c64::new(0.0, 0.0); n];
    for count in 1..=PERIODS * steps {
        let memory: f64 = past.iter().rev().zip(&w[1..]).map(|(d, w)| d * w).sum();
        let angle = TAU * (count % steps) as f64 / steps as f64;
        let inertia: Vec<f64> = (0..n).map(|i| 4.0 / (step * step) * x[i] + 4.0 / step * v[i] + a[i]).collect();
        let drag: Vec<f64> = (0..n).map(|i| beta * (2.0 / step * x[i] + v[i])).collect();
        let mut load = Mat::from_fn(n, 1, |i, _| (0..n).map(|j| m[(i, j)] * inertia[j] + k[(i, j)] * drag[j]).sum());
        load[(force.dof, 0)] += force.harmonics[0].re * angle.cos();
        load[(dof, 0)] -= gain * ((1.0 + 0.5 * order) * memory - 0.5 * order * sum_before);
        lu.solve_in_place(load.as_mut());
        for i in 0..n {
            let next = load[(i, 0)];
            let speed = 2.0 / step * (next - x[i]) - v[i];
            a[i] = 2.0 / step * (speed - v[i]) - a[i];
            (x[i], v[i]) = (next, speed);
        }
        sum_before = memory + x[dof];
        past.push(x[dof]);
        if count > (PERIODS - 1) * steps {
            let wave = c64::new(angle.cos(), -angle.sin()) * (2.0 / steps as f64);
            amplitude.iter_mut().zip(&x).for_each(|(y, x)| *y += wave * *x);
        }
    }
    amplitude
}

#[test]
fn fractional_elements_against_stepping_with_their_memory() {
    for (name, structure, beta, excitation) in structures() {
        let (dof, scale) = if name == "masses" { (2, 1500.0) } else { (4, 6.0) };
        for order in [0.3, 0.7] {
            let fractional = source(Effect::Fractional, &[dof], &[scale * 10.0_f64.powf(0.7 - order), order]);
            let element = (dof, fractional.parameters[0], order);
            let sources = [whole(Effect::StiffnessProportional, beta), fractional];
            let response = balanced(&structure, &sources, &excitation, &Settings::default());
            let bare = balanced(&structure, &sources[..1], &excitation, &Settings::default());
            // The error falls with the square of the step: two steps give its limit.
            let with_steps = |steps: usize| stepped_fractional(&structure, beta, element, &excitation, steps);
            let (coarse, fine) = (with_steps(64), with_steps(128));
            let limit = Mat::from_fn(structure.len(), 1, |i, _| fine[i] + (fine[i] - coarse[i]) / 3.0);
            let error = difference(&response, &limit, 1);
            assert!(error < 1e-3, "{name}, order {order}: off by {error:.1e}");
            assert!(difference(&bare, &limit, 1) > 0.02, "{name}, order {order}: the element does nothing");
        }
    }
}

/// At one frequency a hysteretic element is a dashpot of `loss_stiffness / w`, and the loss factor damping of
/// `loss_factor / w` times the stiffness.
#[test]
fn hysteretic_elements_and_the_loss_factor_against_dashpots_in_time() {
    for (name, structure, beta, excitation) in structures() {
        let (dofs, loss) = if name == "masses" { ([1, 3], 2e3) } else { ([2, 6], 60.0) };
        let omega = excitation.omega;
        let cases: [(&str, Source, Source); 3] = [
            ("hysteretic", source(Effect::Hysteretic, &dofs, &[loss]), source(Effect::Viscous, &dofs, &[loss / omega])),
            (
                "hysteretic to the ground",
                source(Effect::Hysteretic, &dofs[..1], &[loss]),
                source(Effect::Viscous, &dofs[..1], &[loss / omega]),
            ),
            ("loss factor", whole(Effect::LossFactor, 0.03), whole(Effect::StiffnessProportional, 0.03 / omega)),
        ];
        for (law, own, equal) in cases {
            let damping = whole(Effect::StiffnessProportional, beta);
            let response = balanced(&structure, &[damping.clone(), own], &excitation, &Settings::default());
            let reference = stepped(&structure, &[damping, equal], &excitation, 1000);
            let error = difference(&response, &reference, 1);
            assert!(error < 1e-3, "{law} on the {name}: off by {error:.1e}");
        }
    }
}

/// Energy that a force of amplitudes `force` takes out of a motion of amplitudes `motion` in a cycle.
fn taken(force: &[c64], motion: impl Fn(usize) -> c64) -> f64 {
    let energy_of_harmonic = |(i, f): (usize, &c64)| PI * (i + 1) as f64 * (f * motion(i + 1).conj()).im;
    force.iter().enumerate().map(energy_of_harmonic).sum()
}

fn input(response: &Response, excitation: &Excitation) -> f64 {
    let force = &excitation.forces[0];
    taken(&force.harmonics, |h| response.amplitude(force.dof, h))
}

/// A hysteretic element loses `pi loss_stiffness |D|^2` a cycle at any frequency, the loss factor `2 pi loss_factor` times
/// the greatest elastic energy: together all that the force puts in, also where another damper makes harmonics.
#[test]
fn what_hysteresis_takes_out_of_a_cycle_does_not_depend_on_frequency() {
    for (name, structure, _, excitation) in structures() {
        let (dof, loss, eta) = if name == "masses" { (3, 2e3, 0.02) } else { (6, 60.0, 0.02) };
        let driven = excitation.forces[0].dof;
        let quadratic = if name == "masses" { 500.0 } else { 0.3 };
        for share in [0.5, 1.0, 1.9] {
            let excitation = excitation.at(share * excitation.omega);
            let sources = [
                source(Effect::Hysteretic, &[dof], &[loss]),
                whole(Effect::LossFactor, eta),
                source(Effect::Quadratic, &[driven], &[quadratic]),
            ];
            let settings = Settings { estimate: false, ..Settings::fixed(9) };
            let response = balanced(&structure, &sources, &excitation, &settings);
            let hysteretic: f64 = (1..=9).map(|h| PI * h as f64 * loss * response.amplitude(dof, h).norm_sqr()).sum();
            let structural: f64 = (1..=9).map(|h| PI * h as f64 * eta * elastic(&structure, &response, h)).sum();
            let force = response.forces.iter().find(|f| f.source == 2).unwrap();
            let dragged = taken(&force.harmonics, |h| response.amplitude(driven, h));
            let all = hysteretic + structural + dragged;
            let given = input(&response, &excitation);
            assert!(hysteretic > 0.01 * given && structural > 0.01 * given, "{name}: too weak to be seen");
            assert!((all / given - 1.0).abs() < 1e-8, "{name} at {share}: {all} {given}");
        }
    }
}
