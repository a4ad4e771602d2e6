//! Energies against the work of the forces, their gradient against differences.
#![allow(clippy::unwrap_used, reason = "tests")]
use super::*;
use crate::common::models;
use crate::effects::{Effect, Place};
use crate::structure::Part;

fn chain() -> Structure {
    models::chain(&[1.0, 2.0], &[10.0, 0.0], &[20.0])
}

fn motion() -> Mat<c64> {
    Mat::from_fn(2, 2, |i, k| c64::new(0.3 + i as f64, 0.2 - k as f64) * 0.1)
}

fn all_sources() -> Vec<Source> {
    vec![
        Source::known(Effect::Viscous, Place::Dofs(vec![0, 1]), &[2.0]),
        Source::known(Effect::Viscous, Place::Dofs(vec![1]), &[2.0]),
        Source::known(Effect::LossFactor, Place::Whole(None), &[0.1]),
        Source::known(Effect::MassProportional, Place::Whole(None), &[0.1]),
        Source::known(Effect::StiffnessProportional, Place::Whole(None), &[0.1]),
    ]
}

/// Energy is the work of the force: `pi sum h Im(conj(X) F)`, an independent route.
#[test]
fn energy_is_the_work_of_the_force() {
    let (structure, x) = (chain(), motion());
    let field = Field { omega: 3.0, numbers: &[1, 3], x: &x };
    for source in all_sources() {
        let work: f64 = force(&source, &structure, field)
            .iter()
            .map(|(dof, f)| (0..2).map(|k| PI * field.numbers[k] as f64 * (x[(*dof, k)].conj() * f[k]).im).sum::<f64>())
            .sum();
        let exact = energy(&source, &structure, field);
        assert!(exact > 0.0 && (work - exact).abs() < 1e-13 * exact, "{source:?}: {work} {exact}");
    }
}

/// A loss factor that doubles by octave damps every mode as a dashpot does: `pi sum h eta omega_r h omega |q_r|^2`, `q = Phi^T M x`.
#[test]
fn a_loss_factor_that_doubles_by_octave_takes_the_energy_of_viscous_damping() {
    let (stated, x) = (chain(), motion());
    let corrected = stated.with_factors(&[0, 1].map(|mode| (Part::ModeDampingPerOctave(mode), 2.0)));
    let field = Field { omega: 3.0, numbers: &[1, 3], x: &x };
    let (modes, mass) = (stated.modes().unwrap(), [1.0, 2.0]);
    let of_mode = |r: usize, k: usize| {
        let q = (0..2).map(|i| x[(i, k)] * (modes.shapes[(i, r)] * mass[i])).sum::<c64>();
        PI * field.numbers[k] as f64 * 0.1 * modes.omega[r] * field.frequency(k) * q.norm_sqr()
    };
    let expected: f64 = (0..2).flat_map(|r| (0..2).map(move |k| (r, k))).map(|(r, k)| of_mode(r, k)).sum();
    let source = Source::known(Effect::LossFactor, Place::Whole(None), &[0.1]);
    let found = energy(&source, &corrected, field);
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected} J");
}

#[test]
fn gradient_agrees_with_finite_differences() {
    let structure = chain().with_factors(&[(Part::ModeDampingPerOctave(0), 1.7)]);
    let x = motion();
    for source in all_sources() {
        let mut gradient = Mat::zeros(2, 2);
        let field = Field { omega: 3.0, numbers: &[1, 3], x: &x };
        add_energy_gradient(&source, &structure, field, 1.0, &mut gradient);
        let step = c64::new(0.6, -0.8) * 1e-6;
        for (i, k) in [(0, 0), (1, 1)] {
            let energy_beside = |sign: f64| {
                let mut moved = x.clone();
                moved[(i, k)] += step * sign;
                energy(&source, &structure, Field { omega: 3.0, numbers: &[1, 3], x: &moved })
            };
            let (difference, expected) =
                ((energy_beside(1.0) - energy_beside(-1.0)) / 2.0, (gradient[(i, k)].conj() * step).re);
            assert!((difference - expected).abs() < 1e-12, "{source:?}");
        }
    }
}
/// A chain takes out what its pairs take out, on relative motion only; a law that takes out nothing none at all.
#[test]
fn the_energy_of_a_chain_is_that_of_its_pairs() {
    let x = Mat::from_fn(3, 2, |i, k| {
        let [re, im] = [[[1e-3, 0.0], [0.0, 2e-4]], [[4e-4, 1e-4], [0.0, 0.0]], [[4e-4, 1e-4], [1e-4, 0.0]]][i][k];
        c64::new(re, im)
    });
    let field = Field { omega: 80.0, numbers: &[1, 2], x: &x };
    let known = |effect, rows: &[usize], p: &[f64]| Source::known(effect, Place::Dofs(rows.to_vec()), p);
    for (effect, p) in [
        (Effect::Viscous, vec![2.0]),
        (Effect::Coulomb, vec![2.0]),
        (Effect::ElasticSlider, vec![1e4, 1.0]),
        (Effect::Hysteretic, vec![50.0]),
        (Effect::Maxwell, vec![1e4, 20.0]),
    ] {
        let energy_of = |rows: &[usize]| relative_energy(&known(effect, rows, &p), field);
        let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{effect}: {a} {b}");
        close(energy_of(&[0, 1, 2]), energy_of(&[0, 1]) + energy_of(&[1, 2]));
        close(energy_of(&[0, 1]), energy_of(&[1, 0]));
        let motion = Motion::new(80.0, 0.0, &[x[(0, 0)] - x[(1, 0)], x[(0, 1)] - x[(1, 1)]], SAMPLES);
        close(energy_of(&[0, 1]), effect.law().unwrap().energy(&p, &motion));
    }
    // Viscous, by hand: (T/2) sum_h c |h w D_h|^2 = pi w c sum_h h^2 |D_h|^2.
    let squares = 36e-8 + 1e-8 + 4.0 * 4e-8;
    let found = relative_energy(&known(Effect::Viscous, &[0, 1], &[2.0]), field);
    assert!((found / (PI * 80.0 * 2.0 * squares) - 1.0).abs() < 1e-13, "{found}");
    assert_eq!(relative_energy(&known(Effect::Gap, &[0], &[1e5, 0.0]), field), 0.0);
}
