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

/// Two dashpots are missing, neither of which alone explains much: the one beside the other leaves no more than noise. What corrections
/// of the known ones explain, thirtyfold and a tenth of what is stated, is no answer.
#[test]
fn two_dashpots_that_need_each_other_are_both_named() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data/five-masses-points/project.toml");
    let control = Control::unattended();
    let project = load(&path, &control).unwrap();
    let known: Vec<Source> = project.sources.iter().filter(|s| s.state == State::Known).cloned().collect();
    let problem = Problem { structure: &project.structure, sources: &known, runs: &project.runs };
    let diagnosis = diagnose(&problem, &control).unwrap();
    assert_eq!(diagnosis.verdict, Verdict::Missing, "{:?}", diagnosis.corrections);
    let last = diagnosis.steps.last().unwrap();
    assert!(last.error < 0.01, "{}", last.error);
    let mut found: Vec<(Vec<usize>, f64)> = last
        .added
        .iter()
        .map(|a| {
            (
                a.source.place.legs().iter().flat_map(|l| [Some(l.first), l.second]).flatten().collect(),
                a.source.parameters[0],
            )
        })
        .collect();
    found.sort_by(|a, b| a.0.cmp(&b.0));
    let [(first, c1), (second, c2)] = &found[..] else { panic!("{found:?}") };
    assert_eq!((&first[..], &second[..]), (&[1, 2][..], &[3, 4][..]));
    assert!((c1 / 15.0 - 1.0).abs() < 0.02 && (c2 / 4.0 - 1.0).abs() < 0.02, "{c1} {c2}");
}
