//! A component in a testing machine: laws found from whole loops, and the energy of cycles.
#![allow(clippy::unwrap_used, reason = "tests")]

use dashpot::balance::loops::Loops;
use dashpot::control::Control;
use dashpot::diagnosis::component::{compare_component, diagnose_component};
use dashpot::diagnosis::result::{Diagnosis, Suggestion, Verdict};
use dashpot::effects::{Effect, Place, Source};
use dashpot::identify::{Measurements, Settings, identify_measured};
use dashpot::measurement::{Channel, Kind, Quantity, TransientLabel, TransientRun};
use dashpot::response::recording::{Loading, component_force};
use dashpot::response::synthesis::{Noise, record};
use dashpot::structure::Structure;
use dashpot::structure::component::ComponentParameters;
use std::sync::Arc;

const MASS: f64 = 8.0;

fn structure() -> Structure {
    ComponentParameters { dof: "1".into(), mass: MASS }.build().unwrap()
}

fn at(effect: Effect, parameters: &[f64]) -> Source {
    Source::known(effect, Place::Dofs(vec![0]), parameters)
}

/// Loops of three amplitudes and two frequencies with 0.3 % noise.
fn tests(truth: &[Source]) -> Vec<TransientRun> {
    sampled_tests(truth, 256.0)
}

/// The same, sampled at `rate`, Hz.
fn sampled_tests(truth: &[Source], rate: f64) -> Vec<TransientRun> {
    tests_of(rate, |loading, samples| component_force(truth, MASS, loading, rate, samples).unwrap())
}

/// The same of a component whose displacement and force, of as many samples, are computed by `force`.
fn tests_of(rate: f64, force: impl Fn(&Loading, usize) -> (Vec<f64>, Vec<f64>)) -> Vec<TransientRun> {
    let channel = |quantity| Channel { quantity, dof: 0, label: "1".into() };
    let recorded_test = |(k, (amplitude_m, frequency_hz)): (usize, (f64, f64))| {
        let loading = Loading::Cycles { amplitude_m, frequency_hz, ramp_s: 0.5 / frequency_hz };
        let samples = (rate * 4.0 / frequency_hz) as usize;
        let (d, f) = force(&loading, samples);
        let time: Vec<f64> = (0..samples).map(|n| n as f64 / rate).collect();
        let noise = Some(Noise { ratio: 0.003, seed: 3, stream: k as u64 });
        let made =
            record(&time, vec![channel(Quantity::Displacement), channel(Quantity::Force)], vec![d, f], noise).unwrap();
        let label =
            TransientLabel { file: format!("{k}.csv"), kind: Kind::Transient, enabled: true, ..Default::default() };
        TransientRun::new(label, Arc::new(made), &[]).unwrap()
    };
    let all = [0.005, 0.01, 0.02].into_iter().flat_map(|a| [0.5, 2.0].map(|f| (a, f)));
    all.enumerate().map(recorded_test).collect()
}

fn diagnosed(known: &[Source], runs: &[TransientRun]) -> Diagnosis {
    diagnosed_with(MASS, known, runs)
}

fn diagnosed_with(mass: f64, known: &[Source], runs: &[TransientRun]) -> Diagnosis {
    let structure = ComponentParameters { dof: "1".into(), mass }.build().unwrap();
    let loops = Loops::new(&structure, known, runs).unwrap();
    diagnose_component(&loops, &[], &Control::unattended(), &|_| {}).unwrap()
}

#[test]
fn a_sum_of_two_laws_is_found_in_its_loops() {
    let truth = [at(Effect::ElasticSlider, &[4e6, 9000.0]), at(Effect::Viscous, &[12000.0])];
    let diagnosis = diagnosed(&[], &tests(&truth));
    let set = &diagnosis.steps.last().unwrap().added;
    let names: Vec<String> = set.iter().map(|a| format!("{} {:?}", a.source.effect, a.source.parameters)).collect();
    assert_eq!(diagnosis.verdict, Verdict::Missing, "{names:?}");
    assert_eq!(set.len(), 2, "{names:?}");
    for source in &truth {
        let found = set.iter().find(|a| a.source.is_same(source)).unwrap_or_else(|| panic!("{names:?}"));
        for (value, expected) in found.source.parameters.iter().zip(&source.parameters) {
            assert!((value / expected - 1.0).abs() < 0.05, "{names:?}");
        }
    }
    assert!(diagnosis.suggestions[0].held_out_error_after < 0.1 * diagnosis.error_before);
}

/// A wire rope: smooth hysteresis on a spring that stiffens.
#[test]
fn a_sum_of_three_laws_is_found_in_its_loops() {
    let truth =
        [at(Effect::BoucWen, &[4e6, 9000.0, 1.5]), at(Effect::Stiffness, &[1.5e6]), at(Effect::CubicStiffness, &[8e9])];
    let diagnosis = diagnosed(&[], &tests(&truth));
    let set = &diagnosis.steps.last().unwrap().added;
    let names: Vec<String> = set.iter().map(|a| format!("{} {:?}", a.source.effect, a.source.parameters)).collect();
    assert_eq!((diagnosis.verdict, set.len()), (Verdict::Missing, 3), "{names:?}");
    for source in &truth {
        let found = set.iter().find(|a| a.source.is_same(source)).unwrap_or_else(|| panic!("{names:?}"));
        for (value, expected) in found.source.parameters.iter().zip(&source.parameters) {
            assert!((value / expected - 1.0).abs() < 0.1, "{names:?}");
        }
    }
    // Of laws that no sum of three gives, it is said that more is in the loops.
    let four = [&truth[..], &[at(Effect::Quadratic, &[250_000.0]), at(Effect::Coulomb, &[3000.0])]].concat();
    let said = &diagnosed(&[], &tests(&four)).suggestions[0].evidence;
    assert!(said.iter().any(|words| words.contains("times the noise")), "{said:?}");
}

/// Single laws and sums stand in one list, ranked by what they leave of loops that they were not fitted to.
#[test]
fn single_laws_stand_behind_the_sum_by_what_they_predict() {
    let truth = [at(Effect::ElasticSlider, &[4e6, 9000.0]), at(Effect::Viscous, &[12000.0])];
    let diagnosis = diagnosed(&[], &tests(&truth));
    let [first, second] = [&diagnosis.suggestions[0], &diagnosis.suggestions[1]];
    let in_sum = |s: &Suggestion| s.evidence.iter().any(|words| words.contains("in a sum with"));
    assert!(in_sum(first) && in_sum(second), "{:?}", first.evidence);
    assert!(first.probability >= second.probability && second.probability > 0.5, "the surest law of the sum first");
    // Single laws stand behind it, and predict the left-out loops clearly worse.
    let singles: Vec<&Suggestion> = diagnosis.suggestions[2..].iter().filter(|s| !in_sum(s)).collect();
    assert!(!singles.is_empty(), "{:?}", diagnosis.suggestions);
    assert!(singles.iter().all(|s| s.probability < 0.1));
    assert!(singles.iter().all(|s| s.held_out_error_after > 1.2 * first.held_out_error_after), "{singles:?}");
    // A single law alone is ranked before the sums that hold it and predict no better.
    let alone = diagnosed(&[], &tests(&[at(Effect::Quadratic, &[150_000.0])]));
    assert!(!in_sum(&alone.suggestions[0]) && alone.suggestions[0].probability > 0.3, "{:?}", alone.suggestions);
}

/// A rotary friction damper: after each reversal a play without force, which no other law has.
#[test]
fn a_slider_with_backlash_is_told_by_its_play() {
    let (truth, plain) = ([5e6, 9000.0, 4e-3], [4e6, 9000.0]);
    let diagnosis = diagnosed(&[], &tests(&[at(Effect::ElasticSliderBacklash, &truth)]));
    let set = &diagnosis.steps.last().unwrap().added;
    assert!(diagnosis.verdict == Verdict::Missing && set.len() == 1, "{set:?}");
    assert_eq!(set[0].source.effect, Effect::ElasticSliderBacklash);
    for (found, expected) in set[0].source.parameters.iter().zip(truth) {
        assert!((found / expected - 1.0).abs() < 0.01, "{set:?}");
    }
    // Without a play it is the plain slider.
    let diagnosis = diagnosed(&[], &tests(&[at(Effect::ElasticSlider, &plain)]));
    let set = &diagnosis.steps.last().unwrap().added;
    assert!(set.len() == 1 && set[0].source.effect == Effect::ElasticSlider, "{set:?}");
}

#[test]
fn one_law_is_not_made_two() {
    let truth = [at(Effect::Quadratic, &[150_000.0])];
    let diagnosis = diagnosed(&[], &tests(&truth));
    let set = &diagnosis.steps.last().unwrap().added;
    assert_eq!(set.len(), 1, "{set:?}");
    assert!(set[0].source.is_same(&truth[0]), "{set:?}");
    assert!((set[0].source.parameters[0] / 150_000.0 - 1.0).abs() < 0.02, "{set:?}");
}

/// Dry friction jumps between two samples, and its sign is that of a velocity that was differentiated: what that does to the force is no
/// second law.
#[test]
fn friction_that_jumps_between_samples_is_one_law() {
    let truth = [at(Effect::Coulomb, &[4000.0])];
    let diagnosis = diagnosed(&[], &sampled_tests(&truth, 2048.0));
    let last = diagnosis.steps.last().unwrap();
    assert_eq!(last.added.len(), 1, "{last:?}");
    assert_eq!(last.added[0].source.effect, Effect::Coulomb, "{last:?}");
    assert!((last.added[0].source.parameters[0] / 4000.0 - 1.0).abs() < 0.01, "{last:?}");
    // One sample in sixty may hold the jump, by which half of it is averaged.
    assert!(last.error < 0.03, "{}", last.error);
}

/// An Iwan joint beside drag begins as a slider beside it: the law is exchanged.
#[test]
fn a_law_of_a_sum_is_exchanged_for_the_right_one() {
    let truth = [at(Effect::Iwan, &[9e5, 4000.0, -0.6, 2.5]), at(Effect::Power, &[2e4, 1.5])];
    let diagnosis = diagnosed(&[], &tests(&truth));
    let mut laws: Vec<&str> = diagnosis.steps.last().unwrap().added.iter().map(|a| a.source.effect.name()).collect();
    laws.sort_unstable();
    assert_eq!(laws, ["iwan", "power"]);
}

/// Two hundred sliders in parallel whose limits are spread evenly (Iwan 1966): `chi = 0`, `beta = 0`, both at the end of their range, where
/// the force does not tell `beta` to first order.
#[test]
fn sliders_that_slip_evenly_are_an_iwan_joint() {
    let (stiffness, force, count) = (4e6, 9000.0, 200);
    let sliders = |loading: &Loading, samples: usize| {
        let (d, _) = component_force(&[], 0.0, loading, 256.0, samples).unwrap();
        let (spring, mut held) = (stiffness / f64::from(count), vec![0.0_f64; count as usize]);
        let mut last = 0.0;
        let total = |x: &f64| {
            for (k, f) in held.iter_mut().enumerate() {
                let limit = 2.0 * force * (k as f64 + 0.5) / f64::from(count).powi(2);
                *f = (*f + spring * (x - last)).clamp(-limit, limit);
            }
            last = *x;
            held.iter().sum()
        };
        let f = d.iter().map(total).collect();
        (d, f)
    };
    let diagnosis = diagnosed_with(0.0, &[], &tests_of(256.0, sliders));
    let set = &diagnosis.steps.last().unwrap().added;
    assert!(set.len() == 1 && set[0].source.effect == Effect::Iwan, "{set:?}");
    let [found_stiffness, found_force, chi, beta] = set[0].source.parameters[..] else { panic!("four parameters") };
    assert!((found_stiffness / stiffness - 1.0).abs() < 0.03 && (found_force / force - 1.0).abs() < 0.03, "{set:?}");
    assert!(chi > -0.1 && beta < 0.5, "{set:?}");
}

/// Loops within a clearance hold noise alone, and are no reason to call the others unexplained.
#[test]
fn loops_without_a_force_count_for_nothing() {
    let truth = [at(Effect::Gap, &[5e5, 8e-3])];
    let force = |loading: &Loading, samples: usize| {
        let (d, mut f) = component_force(&truth, 0.0, loading, 256.0, samples).unwrap();
        // A force cell has noise where nothing pulls at it.
        f.iter_mut().enumerate().for_each(|(n, f)| *f += 10.0 * (1.7 * (n * n) as f64).sin());
        (d, f)
    };
    let diagnosis = diagnosed_with(0.0, &[], &tests_of(256.0, force));
    let last = diagnosis.steps.last().unwrap();
    assert!(last.error > 0.5, "two loops of six are silent: {}", last.error);
    assert_eq!((diagnosis.verdict, diagnosis.suggestions[0].added.source.effect), (Verdict::Missing, Effect::Gap));
}

/// Where a record holds the velocity, the displacement is what it integrates to, whatever the zero of that sensor.
#[test]
fn a_velocity_stands_for_the_displacement() {
    let truth = [at(Effect::BoucWen, &[4e6, 9000.0, 2.0]), at(Effect::Viscous, &[12000.0])];
    let moved = sampled_tests(&truth, 2000.0);
    let differentiated = |run: &TransientRun| {
        let (d, time) = (run.samples(0), run.time().to_vec());
        let slope = |n: usize| (d[(n + 1).min(d.len() - 1)] - d[n.max(1) - 1]) * 1000.0 + 0.02;
        let channels = vec![
            Channel { quantity: Quantity::Velocity, dof: 0, label: "1".into() },
            Channel { quantity: Quantity::Force, dof: 0, label: "1".into() },
        ];
        let samples = vec![(0..d.len()).map(slope).collect(), run.samples(1).to_vec()];
        let label =
            TransientLabel { file: run.file.clone(), kind: Kind::Transient, enabled: true, ..Default::default() };
        TransientRun::new(label, Arc::new(record(&time, channels, samples, None).unwrap()), &[]).unwrap()
    };
    let runs: Vec<TransientRun> = moved.iter().map(differentiated).collect();
    let [a, b] = [&moved, &runs].map(|runs| Loops::new(&structure(), &[], runs).unwrap());
    for (a, b) in a.list.iter().zip(&b.list) {
        let range = |d: &[f64]| d.iter().fold(f64::MIN, |m, d| m.max(*d)) - d.iter().fold(f64::MAX, |m, d| m.min(*d));
        assert!((range(&b.d) / range(&a.d) - 1.0).abs() < 0.02, "{}: {} for {} m", a.file, range(&b.d), range(&a.d));
    }
    let diagnosis = diagnosed(&[], &runs);
    let last = diagnosis.steps.last().unwrap();
    let names: Vec<String> =
        last.added.iter().map(|a| format!("{} {:?}", a.source.effect, a.source.parameters)).collect();
    let dashpot = last.added.iter().find(|a| a.source.is_same(&truth[1])).unwrap_or_else(|| panic!("{names:?}"));
    assert!((dashpot.source.parameters[0] / truth[1].parameters[0] - 1.0).abs() < 0.1, "{names:?}");
    assert!(last.error < 0.05, "{} {names:?}", last.error);
}

#[test]
fn a_model_that_agrees_is_left_alone() {
    let truth = [at(Effect::Viscous, &[40_000.0])];
    let runs = tests(&truth);
    let loops = Loops::new(&structure(), &truth, &runs).unwrap();
    let comparison = compare_component(&loops, &[]).unwrap();
    assert!(comparison.error < 0.03, "{}", comparison.error);
    let without = compare_component(&Loops::new(&structure(), &[], &runs).unwrap(), &[]).unwrap();
    assert!(without.error > 0.5, "{}", without.error);
}

#[test]
fn the_energy_of_every_cycle_gives_the_coefficients() {
    let truth = [at(Effect::Coulomb, &[4000.0]), at(Effect::Viscous, &[20_000.0])];
    let candidates: Vec<Source> = truth.iter().map(|s| Source::candidate(s.effect, s.place.clone())).collect();
    let runs = tests(&truth);
    let measured = Measurements { runs: &[], transient_runs: &runs, ratios: &[] };
    let outcome =
        identify_measured(&structure(), &candidates, measured, &Settings::default(), &Control::unattended()).unwrap();
    let found = &outcome.accepted_step().sources;
    assert_eq!(found.len(), 2, "{found:?}");
    for estimate in found {
        let expected = truth[estimate.source].coefficient();
        assert!((estimate.coefficient / expected - 1.0).abs() < 0.03, "{estimate:?}");
    }
}

/// A stiff law makes a force of the noise of the displacement: what the truth leaves is what its noise floor says.
#[test]
fn the_noise_floor_holds_that_of_the_displacement() {
    let truth = [at(Effect::Maxwell, &[3e6, 30_000.0]), at(Effect::Stiffness, &[1e6])];
    let loops = Loops::new(&structure(), &[], &tests(&truth)).unwrap();
    let found = compare_component(&loops, &truth).unwrap();
    let of_force = loops.list.iter().map(|l| (l.noise / l.size()).powi(2)).sum::<f64>() / loops.list.len() as f64;
    assert!(found.noise_floor > 1.2 * of_force.sqrt(), "the displacement matters here: {}", found.noise_floor);
    assert!((found.error / found.noise_floor - 1.0).abs() < 0.15, "{} {}", found.error, found.noise_floor);
}
