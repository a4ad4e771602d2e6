//! No mass, no stiffness: the energy balance alone.

use super::support::*;
use dashpot::control::Control;
use dashpot::effects::{Effect, Motion, Source};
use dashpot::identify::{SelectionStatus, Settings, identify};
use dashpot::measurement::{Quantity, Run};
use dashpot::structure::Structure;
use dashpot::structure::points::PointParameters;
use faer::c64;
use std::f64::consts::{PI, TAU};

pub(crate) fn five_points() -> Structure {
    let labels = (1..=5).map(|i| i.to_string()).collect();
    PointParameters { dofs: labels, positions: None }.build().unwrap()
}

fn candidates() -> Vec<Source> {
    let ground = (0..5).map(|i| candidate(Effect::Viscous, &[i]));
    ground.chain((0..4).map(|i| candidate(Effect::Viscous, &[i, i + 1]))).collect()
}

#[test]
fn coefficients_to_1e_8_and_closure_to_1e_10() {
    let truth = [source(Effect::Viscous, &[1, 2], &[15.0]), source(Effect::Viscous, &[3, 4], &[4.0])];
    let mut rig = Rig::near_modes(&five_masses(), 5, 1.01, 0, &[0, 1, 2, 3, 4]);
    rig.frequencies_hz.extend([25.0, 50.0]);
    let runs = rig.runs(&five_masses(), &truth);
    let settings = Settings { stop_angle_deg: 1e-6, ..all_sets() };
    let outcome = identify(&five_points(), &candidates(), &runs, &settings, &Control::unattended()).unwrap();
    assert_found(&outcome, &[(6, 15.0), (8, 4.0)], 1e-8);
    for run in &outcome.runs {
        assert!((run.input_energy - run.identified_energy).abs() < 1e-10 * run.input_energy, "{run:?}");
    }
    assert!(outcome.results.modes.is_empty());
}

/// Motions with harmonics, and the force that puts in what the sources take out, by integrals of their own.
fn runs_with_harmonics() -> Vec<Run> {
    (0..6)
        .map(|r| {
            let omega = TAU * (10.0 + r as f64);
            let level = [1.0, 2.0, 4.0][r % 3];
            let x: Vec<Vec<c64>> = (0..5)
                .map(|i| {
                    let phase = 0.3 * i as f64 + 0.7 * r as f64;
                    let size = 1e-3 * level * (1.0 + 0.5 * ((i * (r + 2)) as f64).sin());
                    vec![
                        c64::new(phase.cos(), phase.sin()) * size,
                        c64::new(0.0, 0.0),
                        c64::new(0.1, 0.02 * i as f64) * size,
                    ]
                })
                .collect();
            let relative: Vec<c64> = x[1].iter().zip(&x[2]).map(|(a, b)| a - b).collect();
            // 200 000 steps of the rectangle rule: jumps cost 1e-10.
            let motion = Motion::new(omega, 0.0, &relative, 200_000);
            let friction: f64 = motion.velocity.iter().map(|v| 3.0 * v.abs()).sum::<f64>() * motion.step();
            let dashpot = Motion::new(omega, 0.0, &x[4], 4096);
            let viscous: f64 = dashpot.velocity.iter().map(|v| 20.0 * v * v).sum::<f64>() * dashpot.step();
            // pi Im(conj(X) F) with F in quadrature with the first mass.
            let unit = x[0][0] / x[0][0].norm() * c64::new(0.0, 1.0);
            let force = unit * ((friction + viscous) / (PI * x[0][0].norm()));
            let zero = c64::new(0.0, 0.0);
            let mut channels = vec![channel(Quantity::Force, 0, vec![force, zero, zero], 0.0)];
            for (dof, amplitudes) in x.into_iter().enumerate() {
                channels.push(channel(Quantity::Displacement, dof, amplitudes, 0.0));
            }
            run(format!("run {r}"), omega, channels)
        })
        .collect()
}

#[test]
fn friction_between_two_points_with_harmonics() {
    let structure = five_points();
    let mut sources = candidates();
    sources.extend((0..5).map(|i| candidate(Effect::Coulomb, &[i])));
    sources.extend((0..4).map(|i| candidate(Effect::Coulomb, &[i, i + 1])));
    let settings = Settings { stop_angle_deg: 1e-5, ..all_sets() };
    let runs = runs_with_harmonics();
    let outcome = identify(&structure, &sources, &runs, &settings, &Control::unattended()).unwrap();
    assert_found(&outcome, &[(4, 20.0), (15, 3.0)], 1e-8);
    // The equivalent dashpot of friction falls with amplitude.
    let by_run = &outcome.results.equivalent.by_run;
    assert!(by_run[2][1] < by_run[0][1]);
}

#[test]
fn unmeasured_candidates_are_left_out_and_said_so() {
    let truth = [source(Effect::Viscous, &[1, 2], &[15.0])];
    let rig = Rig::near_modes(&five_masses(), 5, 1.01, 0, &[0, 1, 2]);
    let runs = rig.runs(&five_masses(), &truth);
    let outcome = identify(&five_points(), &candidates(), &runs, &all_sets(), &Control::unattended()).unwrap();
    assert_found(&outcome, &[(6, 15.0)], 1e-8);
    assert!(outcome.warnings.iter().any(|w| w.starts_with("4 candidates are left out")), "{:?}", outcome.warnings);
}

/// Two sources from two runs fit whatever they are: that is no agreement.
#[test]
fn as_many_sources_as_runs_leave_nothing_to_judge_by() {
    let truth = [source(Effect::Viscous, &[1, 2], &[15.0]), source(Effect::Viscous, &[3, 4], &[4.0])];
    let rig = Rig::near_modes(&five_masses(), 2, 1.01, 0, &[0, 1, 2, 3, 4]);
    let runs = rig.runs(&five_masses(), &truth);
    for runs in [runs.clone(), with_noise(&runs, 1e-3, 1)] {
        let outcome = identify(&five_points(), &candidates(), &runs, &all_sets(), &Control::unattended()).unwrap();
        if accepted(&outcome).len() == 2 {
            assert_eq!(outcome.status, SelectionStatus::NothingLeft, "{}", outcome.reason);
            assert!(outcome.reason.contains("nothing is left to judge them by"), "{}", outcome.reason);
        }
    }
    let exact = identify(&five_points(), &candidates(), &runs, &all_sets(), &Control::unattended()).unwrap();
    assert_eq!(exact.status, SelectionStatus::NothingLeft);
}
