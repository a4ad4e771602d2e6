//! The diagnosis names the hidden effect, its place and its size, and nothing where nothing is hidden.

use super::random::Random;
use super::suite::{Hidden, Kindness, hidden};
use dashpot::control::Control;
use dashpot::diagnosis::diagnose::{diagnose, diagnose_without};
use dashpot::diagnosis::result::{Diagnosis, Suggestion, Verdict};
use dashpot::effects::{Effect, Source};
use std::sync::Mutex;

fn project(effects: &[Effect], beam: bool, seed: u64) -> (Hidden, Diagnosis) {
    let kindness = Kindness {
        beam,
        points: false,
        sensors: 5,
        runs: 9,
        levels: 3,
        noise: 0.01,
        size: 0.25,
        detuned: 0.0,
        unsettled: false,
    };
    let project = hidden(effects, kindness, &mut Random::new(seed)).unwrap();
    let diagnosis = diagnose(&project.problem(), &Control::unattended()).unwrap();
    (project, diagnosis)
}

fn is_named(effect: Effect, beam: bool, seed: u64) {
    let (project, diagnosis) = project(&[effect], beam, seed);
    let truth = &project.truth[0];
    let first = &diagnosis.suggestions[0];
    let named: Vec<_> = diagnosis.suggestions.iter().map(|s| (&s.added.source, s.probability, s.error_after)).collect();
    assert!(first.added.source.is_same(truth), "hidden {truth:?}, named {named:#?}");
    for ((found, exact), deviation) in
        first.added.source.parameters.iter().zip(&truth.parameters).zip(&first.added.deviations)
    {
        assert!((found - exact).abs() < 5.0 * deviation + 0.01 * exact.abs(), "{found} +- {deviation}, hidden {exact}");
    }
    assert_eq!(diagnosis.verdict, Verdict::Missing);
    let last = &diagnosis.steps[diagnosis.steps.len() - 1];
    // Integrated friction is itself wrong by a few tenths of the noise at its higher harmonics.
    assert!(last.error < 1.3 * diagnosis.noise_floor, "{} above the floor {}", last.error, diagnosis.noise_floor);
}

#[test]
fn linear_effects_are_named() {
    is_named(Effect::Viscous, true, 1);
    is_named(Effect::Hysteretic, false, 2);
    is_named(Effect::Stiffness, false, 3);
    is_named(Effect::Mass, true, 4);
}

#[test]
fn friction_is_named() {
    is_named(Effect::Coulomb, true, 11);
    is_named(Effect::Coulomb, false, 12);
}

#[test]
fn a_cubic_spring_is_named() {
    is_named(Effect::CubicStiffness, false, 13);
}

#[test]
fn faults_of_channels_are_not_explained_by_damping() {
    is_named(Effect::Delay, true, 21);
    is_named(Effect::Gain, false, 22);
}

/// Its misfit has a valley for every turn of the phase, and the model beside it is detuned.
#[test]
fn a_delay_of_more_than_half_a_period_is_named() {
    let kindness = Kindness {
        beam: true,
        points: false,
        sensors: 5,
        runs: 9,
        levels: 3,
        noise: 0.01,
        size: 1.6,
        detuned: 0.01,
        unsettled: false,
    };
    let project = hidden(&[Effect::Delay], kindness, &mut Random::new(21)).unwrap();
    let truth = &project.truth[0];
    let fastest = project.runs.iter().map(|run| run.fit.omega).fold(0.0, f64::max);
    assert!(fastest * truth.parameters[0] > std::f64::consts::PI, "{} s at {fastest} rad/s", truth.parameters[0]);
    let diagnosis = diagnose(&project.problem(), &Control::unattended()).unwrap();
    let first = &diagnosis.suggestions[0].added.source;
    assert!(first.is_same(truth), "{:?}", diagnosis.suggestions);
    assert!((first.parameters[0] / truth.parameters[0] - 1.0).abs() < 0.05, "{first:?}, hidden {truth:?}");
}

#[test]
fn what_is_ruled_out_is_not_suggested_and_the_search_finds_what_else_it_could_be() {
    let (project, first) = project(&[Effect::Mass], false, 4);
    let excluded = [first.suggestions[0].added.source.clone()];
    let allowed = |source: &Source| !excluded[0].is_same(source);
    let told = Mutex::new(Vec::new());
    let early = |found: &[Suggestion]| told.lock().unwrap().extend(found.iter().map(|s| s.added.source.clone()));
    let second = diagnose_without(&project.problem(), &excluded, &Control::unattended(), &early).unwrap();
    let open = matches!(second.verdict, Verdict::Detuned | Verdict::Unexplained);
    assert!((open || !second.suggestions.is_empty()) && second.verdict != Verdict::Adequate);
    let said = second.suggestions.iter().flat_map(|s| s.indistinguishable_from.iter().chain([&s.added.source]));
    let steps = second.steps.iter().flat_map(|step| step.added.iter().map(|a| &a.source));
    assert!(said.chain(steps).all(allowed) && told.into_inner().unwrap().iter().all(allowed));
    let (left, before) = (second.steps.last().unwrap().error, second.error_before);
    assert!(open || left < 0.7 * before, "what comes next leaves {left} of {before}");
}

#[test]
fn a_model_that_agrees_gets_no_suggestion() {
    for (beam, seed) in [(true, 31), (false, 32), (false, 33)] {
        let (_, diagnosis) = project(&[], beam, seed);
        assert_eq!(diagnosis.verdict, Verdict::Adequate);
        assert!(diagnosis.suggestions.is_empty());
    }
}
