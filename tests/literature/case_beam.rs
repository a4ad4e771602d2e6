//! Cases 1, 1a and 2 of section 5.2: tables 5.2 to 5.5 and 5.7, noise-free with the thesis' settings.

use super::energy_support::*;
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::identify::{Outcome, SelectionStatus, identify};
use dashpot::structure::damped_modes::damped_modes;
use faer::Mat;

/// Label and coefficient, N s/m.
type Dashpot = (usize, f64);

const CASE_1: [Dashpot; 4] = [(3, 0.1), (5, 0.1), (13, 0.1), (17, 0.1)];
const CASE_2: [(usize, f64); 4] = [(3, 0.01), (5, 0.5), (13, 0.1), (17, 1.0)];

fn solve(dashpots: &[(usize, f64)], sources: &[Source]) -> Outcome {
    let structure = cantilever(10);
    let runs = resonant_runs(&structure, dashpots);
    identify(&structure, sources, &runs, &thesis_settings(), &Control::unattended()).unwrap()
}

#[test]
fn table_5_2_single_angles() {
    let sources = each_dof(&cantilever(10), Effect::Viscous);
    let outcome = solve(&CASE_1, &sources);
    let step = &outcome.steps[0];
    let mut angles = vec![(told(step, &sources).0[0], step.angle_deg)];
    for other in &step.alternatives {
        let Place::Dofs(dofs) = &sources[other.sources[0]].place else { panic!() };
        angles.push((dofs[0] + 1, other.angle_deg));
    }
    let printed = [(19, 6.498), (17, 6.811), (13, 7.726), (15, 13.431), (11, 17.636)];
    for ((label, angle), (expected, printed)) in angles.iter().zip(printed) {
        assert_eq!(*label, expected, "{angles:?}");
        assert!((angle - printed).abs() < 6e-4, "{angles:?}");
    }
}

#[test]
fn table_5_3_case_1() {
    let sources = each_dof(&cantilever(10), Effect::Viscous);
    let outcome = solve(&CASE_1, &sources);
    assert_step(&outcome, &sources, &[19], &[0.1071], 6.498, 6e-5);
    assert_step(&outcome, &sources, &[13, 19], &[0.1506, 0.0590], 0.405, 6e-5);
    assert_step(&outcome, &sources, &[5, 15, 17], &[0.2116, 0.1272, 0.0547], 0.125, 6e-5);
    assert_step(&outcome, &sources, &[3, 5, 13, 17], &[0.1, 0.1, 0.1, 0.1], 0.0, 1e-5);
    assert_eq!((outcome.accepted_step().count, outcome.status), (4, SelectionStatus::BelowAngle));
    assert!((outcome.sources.iter().map(|s| s.energy_percent).sum::<f64>() - 100.0).abs() < 1e-9);
}

#[test]
fn table_5_4_damping_ratios() {
    let structure = cantilever(10);
    let matrices = structure.matrices().unwrap();
    let ratios = |dashpots: &[(usize, f64)]| -> Vec<f64> {
        let mut c = Mat::<f64>::zeros(20, 20);
        for &(label, value) in dashpots {
            c[(label - 1, label - 1)] = value;
        }
        let modes = damped_modes(matrices.mass.as_ref(), matrices.stiffness.as_ref(), c.as_ref()).unwrap();
        modes.iter().map(|m| m.damping_ratio).collect()
    };
    let original = ratios(&CASE_1);
    // The printed coefficients of one, two and three equivalent dashpots, and the printed errors in per cent.
    let rows: [(&[Dashpot], [f64; 10]); 3] = [
        (&[(19, 0.107)], [4.09, 44.15, 24.74, 16.66, 73.13, 14.82, 2.68, 53.99, 35.49, 47.96]),
        (&[(13, 0.151), (19, 0.059)], [0.14, 0.07, 12.60, 9.68, 7.97, 1.99, 4.23, 15.07, 31.11, 27.87]),
        (&[(5, 0.212), (15, 0.127), (17, 0.055)], [0.13, 0.22, 1.22, 0.95, 2.90, 4.51, 11.37, 15.81, 0.51, 2.62]),
    ];
    for (dashpots, printed) in rows {
        let equivalent = ratios(dashpots);
        for (mode, error) in printed.iter().enumerate() {
            let found = 100.0 * (equivalent[mode] / original[mode] - 1.0).abs();
            // The coefficients are printed to three digits, which moves the ratios by up to half a per cent.
            assert!((found - error).abs() < 0.55, "mode {}: {found} instead of {error}", mode + 1);
        }
    }
}

#[test]
fn table_5_5_case_1a() {
    let mut sources = each_dof(&cantilever(10), Effect::Viscous);
    force_candidate(&mut sources, 3);
    let outcome = solve(&CASE_1, &sources);
    assert_eq!(told(&outcome.steps[0], &sources).0, [3]);
    assert_step(&outcome, &sources, &[3, 17], &[0.250, 0.149], 2.956, 6e-4);
    assert_step(&outcome, &sources, &[3, 13, 19], &[0.012, 0.156, 0.057], 0.358, 6e-4);
    assert_step(&outcome, &sources, &[3, 5, 13, 17], &[0.1, 0.1, 0.1, 0.1], 0.0, 1e-5);
}

#[test]
fn table_5_7_case_2() {
    let sources = each_dof(&cantilever(10), Effect::Viscous);
    let outcome = solve(&CASE_2, &sources);
    assert_step(&outcome, &sources, &[17], &[1.0837], 12.558, 6e-5);
    assert_step(&outcome, &sources, &[5, 17], &[0.5812, 1.0417], 1.029, 6e-5);
    assert_step(&outcome, &sources, &[5, 13, 17], &[0.5064, 0.1235, 0.9891], 0.264, 6e-5);
    assert_step(&outcome, &sources, &[3, 5, 13, 17], &[0.01, 0.5, 0.1, 1.0], 0.0, 5e-5);
}
