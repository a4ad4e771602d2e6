//! The comparison of a model with records: at natural frequencies, on folds, by groups, and whether what is left is white.
#![allow(clippy::disallowed_methods, reason = "tests")]

use super::support::{cantilever, source, whole};
use crate::common::models::oscillator;
use dashpot::control::Control;
use dashpot::diagnosis::residual::whiteness::Dependence;
use dashpot::diagnosis::{Comparison, Problem, compare};
use dashpot::effects::{Effect, Source, source::State};
use dashpot::exchange::project::load;
use dashpot::measurement::Run;
use dashpot::measurement::fit::fit;
use dashpot::response::harmonic_balance::{Excitation, ForwardModel, Settings};
use dashpot::response::simulation::{SteadyState, recorded, usual_channels};
use dashpot::response::synthesis::{Noise, sampling_times, synthesise};
use dashpot::structure::Structure;
use faer::c64;
use std::f64::consts::TAU;
use std::path::Path;

fn measured(structure: &Structure, excitation: &Excitation, state: &SteadyState, noise: f64, stream: u64) -> Run {
    let motions = recorded(state, excitation, &usual_channels(structure, excitation), &[]);
    let time = sampling_times(excitation.omega, 10.0, 800);
    let noise = Noise { ratio: noise, seed: 11, stream };
    let record = synthesise(excitation.omega, &time, &motions, Some(noise)).unwrap();
    let fit = fit(&record, excitation.omega, 5).unwrap();
    let file = format!("run-{stream}.csv");
    let (noise_ratio, findings) = (noise.ratio, Vec::new());
    Run { noise_ratio, findings, ..Run::from_harmonics(file, None, true, fit, &[]) }
}

fn compared(structure: &Structure, sources: &[Source], runs: &[Run]) -> Comparison {
    compare(&Problem { structure, sources, runs }, &[], &Control::unattended()).unwrap()
}

/// The thesis' runs lie at the natural frequencies of the undamped beam to the last digit.
#[test]
fn samples_at_exact_natural_frequencies_agree_with_the_truth() {
    for sample in ["cantilever-case-1", "cantilever-case-2"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data").join(sample).join("project.toml");
        let mut project = load(&path, &Control::unattended()).unwrap();
        for source in project.sources.iter_mut().filter(|s| s.state == State::Reference) {
            source.state = State::Known;
        }
        let comparison = compared(&project.structure, &project.sources, &project.runs);
        assert!(comparison.error < 1.25 * comparison.noise_floor, "{sample}: {}", comparison.error);
        assert!(comparison.energy_error < 0.01, "{sample}: {}", comparison.energy_error);
        let colour = comparison.whiteness.iter().find(|w| w.probability < 1e-4);
        assert!(colour.is_none(), "{sample}: {colour:?}");
    }
}

/// Duffing's oscillator, measured on both of its stable motions at one frequency and one force.
#[test]
fn the_branch_that_was_measured_is_named() {
    let structure = oscillator(1.0, 1.0);
    let sources = [source(Effect::Viscous, &[0], &[0.1]), source(Effect::CubicStiffness, &[0], &[0.5])];
    let excitation = Excitation::sine(1.5, 0, c64::new(0.4, 0.0));
    let run = ForwardModel::new(&structure, &sources).unwrap().at(1.5);
    let mut motions = run.branches(&sources, &excitation, &Settings::default(), &Control::unattended()).unwrap();
    assert_eq!(motions.iter().map(|(_, stable)| *stable).collect::<Vec<_>>(), [true, false, true]);
    motions.retain(|(_, stable)| *stable);
    let runs: Vec<Run> = motions
        .into_iter()
        .zip(0..)
        .map(|((motion, _), k)| {
            let state = SteadyState { mean: motion.mean, harmonics: motion.harmonics };
            measured(&structure, &excitation, &state, 1e-3, k)
        })
        .collect();
    let comparison = compared(&structure, &sources, &runs);
    for (run, name) in comparison.runs.iter().zip(["lower", "upper"]) {
        let branch = run.branch.unwrap();
        assert_eq!((branch.name().as_str(), branch.stable, branch.all), (name, 2, 3));
        assert!(run.error < 1e-3, "{name}: {}", run.error);
    }
}

/// Nine runs on the beam at three frequencies and three forces, with a dashpot of which the model may not know.
fn nine_runs(noise: f64) -> (Structure, Vec<Source>, Vec<Run>) {
    let structure = cantilever(5);
    let truth = vec![
        whole(Effect::StiffnessProportional, 2e-5),
        source(Effect::Quadratic, &[8], &[1.0]),
        source(Effect::Viscous, &[4], &[0.1]),
    ];
    let model = ForwardModel::new(&structure, &truth).unwrap();
    let mut runs = Vec::new();
    for hz in [9.5, 10.6, 66.0] {
        for force in [0.5, 1.0, 2.0] {
            let excitation = Excitation::sine(TAU * hz, 8, c64::new(force, 0.0));
            let response = model.respond(&excitation, &Settings::default(), None, &Control::unattended()).unwrap();
            let state = SteadyState { mean: response.mean, harmonics: response.harmonics };
            runs.push(measured(&structure, &excitation, &state, noise, runs.len() as u64));
        }
    }
    (structure, truth, runs)
}

#[test]
fn what_an_exact_model_leaves_is_white_and_what_a_poor_one_leaves_is_not() {
    let (structure, truth, runs) = nine_runs(0.01);
    let exact = compared(&structure, &truth, &runs);
    assert_eq!(exact.whiteness.len(), 4);
    for test in &exact.whiteness {
        assert!(test.probability > 1e-3, "{test:?}");
    }
    let poor = compared(&structure, &truth[..2], &runs);
    for of in [Dependence::Frequency, Dependence::Level, Dependence::Place] {
        let test = poor.whiteness.iter().find(|w| w.of == of).unwrap();
        assert!(test.probability < 1e-6, "{test:?}");
    }
}

#[test]
fn groups_are_the_same_errors_seen_otherwise() {
    let (structure, truth, mut runs) = nine_runs(0.01);
    let all = compared(&structure, &truth[..2], &runs);
    let names = |groups: &[dashpot::diagnosis::residual::breakdown::Group]| {
        groups.iter().map(|g| g.name.clone()).collect::<Vec<_>>()
    };
    assert_eq!(all.levels.iter().map(|g| g.runs).collect::<Vec<_>>(), [3, 3, 3]);
    assert!(names(&all.levels)[0].starts_with("0.") && names(&all.levels)[2].ends_with(" N"));
    assert_eq!(names(&all.channels), ["acc@1", "acc@3", "acc@5", "acc@7", "acc@9"]);
    assert_eq!(names(&all.harmonics), ["1", "2", "3", "4", "5"]);
    let mean = |groups: &[dashpot::diagnosis::residual::breakdown::Group]| {
        (groups.iter().map(|g| g.error * g.error).sum::<f64>() / groups.len() as f64).sqrt()
    };
    assert!((mean(&all.levels) / all.error - 1.0).abs() < 1e-12);
    assert!((mean(&all.channels) / all.error - 1.0).abs() < 1e-12);
    // The squares of the harmonics add up to those of the channels.
    let sum: f64 = all.harmonics.iter().map(|g| g.error * g.error).sum();
    assert!((sum.sqrt() / all.error - 1.0).abs() < 1e-12);
    // Labels are names where every run has one.
    runs.iter_mut().enumerate().for_each(|(r, run)| run.level = Some(1 + (r % 3) as i64));
    assert_eq!(names(&compared(&structure, &truth, &runs).levels), ["1", "2", "3"]);
}
