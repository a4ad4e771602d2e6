//! Two states of a structure: a change is found where it is, and noise alone makes none.

use super::support::*;
use dashpot::control::Control;
use dashpot::effects::{Effect, Source};
use dashpot::identify::change::{Change, ChangeError, Condition, change};
use dashpot::identify::{Measurements, Settings};
use dashpot::measurement::Run;
use dashpot::structure::Structure;

const NOISE: f64 = 0.01;

fn sources() -> Vec<Source> {
    let ground = (0..5).map(|i| candidate(Effect::Viscous, &[i]));
    ground.chain((0..4).map(|i| candidate(Effect::Viscous, &[i, i + 1]))).collect()
}

fn settings() -> Settings {
    Settings { max_sources: 3, ..all_sets() }
}

fn measured(structure: &Structure, second: f64) -> Vec<Run> {
    let mut rig = Rig::near_modes(structure, 5, 1.005, 0, &[0, 2, 4]);
    rig.frequencies_hz.extend(rig.frequencies_hz.clone().iter().map(|f| f * 0.99));
    rig.runs(structure, &[source(Effect::Viscous, &[1, 2], &[15.0]), source(Effect::Viscous, &[3, 4], &[second])])
}

fn between(structure: &Structure, runs: [&[Run]; 2]) -> Change {
    let (sources, settings) = (sources(), settings());
    let state = |runs| Condition {
        structure,
        sources: &sources,
        measured: Measurements { runs, transient_runs: &[], ratios: &[] },
        settings: &settings,
    };
    change(runs.map(state), &Control::unattended()).unwrap()
}

#[test]
fn noise_alone_makes_no_change() {
    let structure = five_masses();
    let runs = measured(&structure, 4.0);
    let seeds = 60;
    let (mut false_alarms, mut together, mut squares) = (0, 0, 0.0);
    for seed in 0..seeds {
        let found = between(&structure, [&with_noise(&runs, NOISE, seed), &with_noise(&runs, NOISE, 1000 + seed)]);
        false_alarms += usize::from(found.changed().next().is_some());
        together += usize::from(found.chance.unwrap() < 0.05);
        squares += found.chi_square.unwrap() / found.sources.len() as f64;
    }
    // 1 % and 5 % are promised; 60 seeds leave room for one and for eight.
    assert!(false_alarms <= 2 && together <= 8, "{false_alarms} and {together} of {seeds}");
    // Chi-square over its degrees of freedom has mean 1.
    assert!((0.7..1.4).contains(&(squares / seeds as f64)), "{}", squares / seeds as f64);
}

#[test]
fn a_change_is_found_where_it_is() {
    let structure = five_masses();
    let (before, after) = (measured(&structure, 4.0), measured(&structure, 5.0));
    for seed in 0..10 {
        let found = between(&structure, [&with_noise(&before, NOISE, seed), &with_noise(&after, NOISE, 500 + seed)]);
        let changed: Vec<&Source> = found.changed().map(|s| &s.source).collect();
        assert_eq!(changed.len(), 1, "{changed:?}");
        assert!(changed[0].is_same(&candidate(Effect::Viscous, &[3, 4])));
        let pair = found.changed().next().unwrap().coefficient;
        assert!((pair.difference - 1.0).abs() < 4.0 * pair.deviation, "{pair:?}");
        assert!(found.modes.iter().any(|m| m.ratio.is_significant()));
    }
}

#[test]
fn a_source_of_one_state_only_is_held_against_none_in_the_other() {
    let structure = five_masses();
    let rig = Rig::near_modes(&structure, 5, 1.005, 0, &[0, 2, 4]);
    let before = rig.runs(&structure, &[source(Effect::Viscous, &[1, 2], &[15.0])]);
    let after =
        rig.runs(&structure, &[source(Effect::Viscous, &[1, 2], &[15.0]), source(Effect::Viscous, &[4], &[6.0])]);
    let found = between(&structure, [&with_noise(&before, NOISE, 1), &with_noise(&after, NOISE, 2)]);
    let new = found.changed().next().unwrap();
    assert!(new.source.is_same(&candidate(Effect::Viscous, &[4])));
    assert_eq!(new.accepted, [false, true]);
    assert!(new.coefficient.values[0].abs() < 3.0 * new.coefficient.deviations[0]);
}

#[test]
fn states_with_other_places_are_refused_in_one_line() {
    let (chain, beam) = (five_masses(), cantilever(10));
    let (sources, settings) = (sources(), settings());
    let far = [candidate(Effect::Viscous, &[16])];
    let (runs, bent) = (measured(&chain, 4.0), Rig::near_modes(&beam, 4, 1.0, 18, &[4, 10, 18]));
    let bent = with_noise(&bent.runs(&beam, &[source(Effect::Viscous, &[16], &[0.5])]), NOISE, 3);
    let condition = |structure, sources, runs| Condition {
        structure,
        sources,
        measured: Measurements { runs, transient_runs: &[], ratios: &[] },
        settings: &settings,
    };
    let again = with_noise(&runs, NOISE, 4);
    let states = [condition(&chain, &sources[..], &again[..]), condition(&beam, &far[..], &bent[..])];
    let error = change(states, &Control::unattended()).unwrap_err();
    assert!(matches!(&error, ChangeError::NoDof { .. }), "{error}");
    assert!(error.to_string().contains("DOF \"17\"") && !error.to_string().contains('\n'));
}
