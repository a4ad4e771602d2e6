//! Structures of points: energies alone.

use dashpot::control::Control;
use dashpot::diagnosis::result::Verdict;
use dashpot::diagnosis::{Problem, diagnose};
use dashpot::effects::{Source, State};
use dashpot::exchange::project::load;
use dashpot::identify::identify;
use std::path::Path;

/// Five dashpots that are known, of which one is stated too small by 30 %, and sensors that are exact: what sensors are known to
/// must not pass for how well a damper is known, so that a second one would have to take its place.
#[test]
fn a_damper_that_is_stated_too_small_is_corrected() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data/five-masses-points/project.toml");
    let control = Control::unattended();
    let project = load(&path, &control).unwrap();
    let found = identify(&project.structure, &project.sources, &project.runs, &project.settings, &control).unwrap();
    let known = |k: usize| Source { state: State::Known, ..project.sources[k].clone() };
    let mut stated: Vec<Source> =
        (0..project.sources.len()).filter(|&k| project.sources[k].state == State::Known).map(known).collect();
    let estimates = &found.accepted_step().sources;
    stated.extend(estimates.iter().map(|estimate| known(estimate.source).with_coefficient(estimate.coefficient)));
    let last = stated.len() - 1;
    let right = stated[last].parameters[0];
    stated[last] = stated[last].with_coefficient(0.7 * right);
    let problem = Problem { structure: &project.structure, sources: &stated, runs: &project.runs };
    let diagnosis = diagnose(&problem, &control).unwrap();
    assert_eq!(diagnosis.verdict, Verdict::Detuned, "{:?}", diagnosis.suggestions);
    let largest = diagnosis.corrections.iter().map(|c| c.factor).fold(0.0, f64::max);
    assert!((largest * 0.7 - 1.0).abs() < 0.05, "{:?}", diagnosis.corrections);
}
