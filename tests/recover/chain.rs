//! Five masses: every expansion, relative dashpots, a chain of dashpots, hysteretic and proportional damping.

use super::support::*;
use dashpot::balance::{Expansion, Weights};
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source, State};
use dashpot::identify::{Form, Settings, identify};

/// Dashpots to the ground at each mass and between neighbours.
fn candidates() -> Vec<Source> {
    let ground = (0..5).map(|i| candidate(Effect::Viscous, &[i]));
    let between = (0..4).map(|i| candidate(Effect::Viscous, &[i, i + 1]));
    ground.chain(between).collect()
}

fn truth() -> Vec<Source> {
    vec![
        source(Effect::Viscous, &[1, 2], &[15.0]),
        source(Effect::Viscous, &[3, 4], &[4.0]),
        source(Effect::Viscous, &[0], &[2.0]),
    ]
}

/// Indices among the candidates.
const EXPECTED: [(usize, f64); 3] = [(0, 2.0), (6, 15.0), (8, 4.0)];

#[test]
fn exact_expansions_give_the_coefficients_back() {
    let structure = five_masses();
    for (expansion, sensors) in [
        (Expansion::None, vec![0, 1, 2, 3, 4]),
        (Expansion::Modes, vec![0, 1, 2, 3, 4]),
        (Expansion::Dynamic, vec![0, 1, 2, 3, 4]),
        (Expansion::Dynamic, vec![0, 2]),
        (Expansion::Dynamic, vec![1, 3, 4]),
    ] {
        let mut rig = Rig::near_modes(&structure, 5, 1.01, 0, &sensors);
        rig.frequencies_hz.extend(rig.frequencies_hz.clone().iter().map(|f| f * 0.97));
        let settings = Settings { expansion, stop_angle_deg: 1e-5, ..all_sets() };
        let runs = rig.runs(&structure, &truth());
        let outcome = identify(&structure, &candidates(), &runs, &settings, &Control::unattended()).unwrap();
        assert_found(&outcome, &EXPECTED, 1e-7);
        for run in &outcome.runs {
            assert!(
                (run.input_energy - run.identified_energy).abs() < 1e-7 * run.input_energy,
                "{expansion:?} {run:?}"
            );
        }
    }
}

#[test]
fn energy_form_with_dynamic_expansion_is_exact_too() {
    let structure = five_masses();
    let mut rig = Rig::near_modes(&structure, 5, 1.01, 0, &[0, 2]);
    rig.frequencies_hz.extend(rig.frequencies_hz.clone().iter().map(|f| f * 0.97));
    let settings =
        Settings { expansion: Expansion::Dynamic, weights: Weights::Energy, stop_angle_deg: 0.01, ..all_sets() };
    let outcome =
        identify(&structure, &candidates(), &rig.runs(&structure, &truth()), &settings, &Control::unattended())
            .unwrap();
    assert_eq!(outcome.form, Form::Energy);
    assert_found(&outcome, &EXPECTED, 1e-3);
}

#[test]
fn single_mode_expansion_is_near_at_resonance() {
    let structure = five_masses();
    let light: Vec<Source> = truth().iter().map(|s| s.with_coefficient(s.coefficient() * 1e-4)).collect();
    let rig = Rig::near_modes(&structure, 5, 1.0, 0, &[0, 2, 4]);
    let settings = Settings { expansion: Expansion::SingleMode, stop_angle_deg: 0.01, ..all_sets() };
    let outcome =
        identify(&structure, &candidates(), &rig.runs(&structure, &light), &settings, &Control::unattended()).unwrap();
    let expected: Vec<(usize, f64)> = EXPECTED.iter().map(|&(s, c)| (s, c * 1e-4)).collect();
    assert_found(&outcome, &expected, 1e-2);
}

#[test]
fn single_mode_expansion_warns_of_one_equation_a_mode() {
    let structure = five_masses();
    let mut rig = Rig::near_modes(&structure, 2, 1.0, 0, &[0, 2, 4]);
    rig.frequencies_hz.extend(rig.frequencies_hz.clone().iter().map(|f| f * 1.001));
    let settings = Settings { expansion: Expansion::SingleMode, max_sources: 2, ..all_sets() };
    let outcome =
        identify(&structure, &candidates(), &rig.runs(&structure, &truth()), &settings, &Control::unattended())
            .unwrap();
    assert!(outcome.warnings.iter().any(|w| w.contains("4 runs excite 2 modes")), "{:?}", outcome.warnings);
}

#[test]
fn chain_of_dashpots_is_one_source() {
    let structure = five_masses();
    let whole = [0, 1, 2, 3, 4];
    let mut sources = candidates();
    sources.push(candidate(Effect::Viscous, &whole));
    let rig = Rig::near_modes(&structure, 5, 1.02, 0, &[0, 2, 4]);
    let runs = rig.runs(&structure, &[source(Effect::Viscous, &whole, &[3.0])]);
    let settings = Settings { stop_angle_deg: 1e-5, ..all_sets() };
    let outcome = identify(&structure, &sources, &runs, &settings, &Control::unattended()).unwrap();
    assert_found(&outcome, &[(9, 3.0)], 1e-8);
    // C = sum over legs: 3 at the ends, 6 between, -3 beside the diagonal.
    let c = &outcome.results.viscous;
    assert!((c[(0, 0)] - 3.0).abs() < 1e-6 && (c[(2, 2)] - 6.0).abs() < 1e-6 && (c[(2, 3)] + 3.0).abs() < 1e-6);
}

#[test]
fn hysteretic_and_proportional_damping() {
    let structure = five_masses();
    let mut sources = candidates();
    sources.extend((0..5).map(|i| candidate(Effect::Hysteretic, &[i])));
    sources.push(Source::candidate(Effect::LossFactor, Place::Whole(None)));
    sources.push(Source::candidate(Effect::StiffnessProportional, Place::Whole(None)));
    sources.push(Source::candidate(Effect::MassProportional, Place::Whole(None)));
    let truth = [
        source(Effect::Hysteretic, &[2], &[500.0]),
        Source::known(Effect::LossFactor, Place::Whole(None), &[0.002]),
        source(Effect::Viscous, &[3, 4], &[4.0]),
    ];
    for sensors in [vec![0, 1, 2, 3, 4], vec![0, 2, 4]] {
        let mut rig = Rig::near_modes(&structure, 5, 1.01, 0, &sensors);
        rig.frequencies_hz.extend([15.0, 27.0, 37.0, 58.0]);
        let runs = rig.runs(&structure, &truth);
        let settings = Settings { stop_angle_deg: 1e-5, ..all_sets() };
        let outcome = identify(&structure, &sources, &runs, &settings, &Control::unattended()).unwrap();
        assert_found(&outcome, &[(8, 4.0), (11, 500.0), (14, 0.002)], 1e-6);
        assert_eq!(outcome.results.others.len(), 2);
    }
}

#[test]
fn known_and_forced_sources() {
    let structure = five_masses();
    let mut sources = candidates();
    sources[8] = source(Effect::Viscous, &[3, 4], &[4.0]);
    sources[6].state = State::Forced;
    sources[0].state = State::Off;
    sources[1].state = State::Reference;
    let rig = Rig::near_modes(&structure, 5, 1.01, 0, &[0, 2, 4]);
    let truth = [source(Effect::Viscous, &[1, 2], &[15.0]), source(Effect::Viscous, &[3, 4], &[4.0])];
    let settings = Settings { stop_angle_deg: 1e-5, ..all_sets() };
    let runs = rig.runs(&structure, &truth);
    let outcome = identify(&structure, &sources, &runs, &settings, &Control::unattended()).unwrap();
    assert_found(&outcome, &[(6, 15.0)], 1e-8);
    assert!(outcome.steps.iter().all(|step| step.sources.iter().any(|e| e.source == 6)));
    assert_eq!(outcome.sources.iter().map(|e| e.source).collect::<Vec<_>>(), [6, 8]);
    assert!((outcome.results.viscous[(4, 4)] - 4.0).abs() < 1e-12);
}

#[test]
fn damped_modes_of_the_answer_are_those_of_the_truth() {
    let structure = five_masses();
    let rig = Rig::near_modes(&structure, 5, 1.01, 0, &[0, 2, 4]);
    let runs = rig.runs(&structure, &truth());
    let settings = Settings { stop_angle_deg: 1e-5, ..all_sets() };
    let outcome = identify(&structure, &candidates(), &runs, &settings, &Control::unattended()).unwrap();
    let linear = dashpot::response::linear_matrices::LinearMatrices::new(&structure, &truth()).unwrap();
    let exact = dashpot::structure::damped_modes::damped_modes(
        linear.mass.as_ref(),
        linear.stiffness.as_ref(),
        linear.viscous.as_ref(),
    )
    .unwrap();
    for (mode, exact) in outcome.results.modes.iter().zip(&exact) {
        assert!((mode.damping_ratio - exact.damping_ratio).abs() < 1e-7 * exact.damping_ratio);
        // Half-power points are those of a sum of modes, so they are near, not equal.
        if let Some(half_power) = mode.half_power_ratio {
            assert!((half_power - exact.damping_ratio).abs() < 0.2 * exact.damping_ratio, "{half_power} {exact:?}");
        }
    }
    assert!(outcome.results.modes.iter().filter(|m| m.half_power_ratio.is_some()).count() >= 3);
}
