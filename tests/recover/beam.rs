//! The cantilever with three accelerometers: friction, damping of some elements, a stiffness that is wrong.

use super::support::*;
use dashpot::control::Control;
use dashpot::effects::{Effect, Family, Place, Source};
use dashpot::identify::{Form, Settings, identify};

fn each_translation(effect: Effect) -> Vec<Source> {
    Family::EachTranslation.candidates(effect, &cantilever(10))
}

#[test]
fn dynamic_expansion_from_three_accelerometers_off_resonance() {
    let structure = cantilever(10);
    let truth = [(2, 0.01), (4, 0.5), (12, 0.1), (16, 1.0)];
    let sources: Vec<Source> = truth.iter().map(|&(d, c)| source(Effect::Viscous, &[d], &[c])).collect();
    let mut rig = Rig::near_modes(&structure, 1, 1.0, 18, &[6, 10, 18]);
    rig.frequencies_hz = vec![10.0, 65.0, 182.0, 358.0, 593.0, 889.0, 1247.0, 1671.0];
    let settings = Settings { stop_angle_deg: 1e-4, ..all_sets() };
    let runs = rig.runs(&structure, &sources);
    let outcome =
        identify(&structure, &each_translation(Effect::Viscous), &runs, &settings, &Control::unattended()).unwrap();
    let expected: Vec<(usize, f64)> = truth.iter().map(|&(d, c)| (d / 2, c)).collect();
    assert_found(&outcome, &expected, 1e-6);
}

#[test]
fn proportional_damping_of_a_range_of_elements() {
    let structure = cantilever(10);
    let part = |range| Source::known(Effect::StiffnessProportional, Place::Whole(Some(range)), &[2e-6]);
    let mut sources = each_translation(Effect::Viscous);
    for range in [[0, 2], [3, 6], [7, 9]] {
        sources.push(Source::candidate(Effect::StiffnessProportional, Place::Whole(Some(range))));
    }
    let rig = Rig::near_modes(&structure, 8, 1.003, 18, &[6, 10, 18]);
    let runs = rig.runs(&structure, &[part([3, 6]), source(Effect::Viscous, &[4], &[0.3])]);
    let settings = Settings { stop_angle_deg: 1e-4, ..all_sets() };
    let outcome = identify(&structure, &sources, &runs, &settings, &Control::unattended()).unwrap();
    assert_found(&outcome, &[(2, 0.3), (11, 2e-6)], 1e-6);
}

#[test]
fn a_wrong_stiffness_falls_back_on_the_energy() {
    let truth = [source(Effect::Viscous, &[4], &[0.5]), source(Effect::Viscous, &[16], &[1.0])];
    let mut rig = Rig::near_modes(&cantilever(10), 6, 1.0, 18, &[6, 10, 18]);
    rig.sensors = vec![2, 6, 10, 14, 18];
    let runs = with_noise(&rig.runs(&cantilever(10), &truth), 1e-3, 5);
    let mut beam = cantilever_parameters(10);
    beam.youngs_modulus *= 1.02;
    let structure = beam.build(&[]).unwrap();
    let candidates = each_translation(Effect::Viscous);
    let outcome = identify(&structure, &candidates, &runs, &all_sets(), &Control::unattended()).unwrap();
    assert_eq!(outcome.form, Form::Energy, "{}", outcome.reason);
    let two = outcome.steps.iter().find(|s| s.count == 2).unwrap();
    assert_eq!(two.sources.iter().map(|e| e.source).collect::<Vec<_>>(), [2, 8], "{}", outcome.reason);
    assert!(
        (two.sources[0].coefficient - 0.5).abs() < 0.05 && (two.sources[1].coefficient - 1.0).abs() < 0.05,
        "{two:?}"
    );
}
