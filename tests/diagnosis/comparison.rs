//! The comparison: at the noise floor for an exact model, well above it for a wrong one.

use super::random::Random;
use super::suite::{Kindness, hidden};
use dashpot::control::Control;
use dashpot::diagnosis::residual::comparison::ChannelComparison;
use dashpot::diagnosis::{Problem, compare};
use dashpot::effects::Effect;
use dashpot::exchange::project::load;
use std::path::Path;

fn kindness(beam: bool) -> Kindness {
    Kindness {
        beam,
        points: false,
        sensors: 4,
        runs: 9,
        levels: 3,
        noise: 0.02,
        size: 0.3,
        detuned: 0.0,
        unsettled: false,
    }
}

#[test]
fn an_exact_model_is_wrong_by_the_noise_floor() {
    for beam in [true, false] {
        let project = hidden(&[], kindness(beam), &mut Random::new(3)).unwrap();
        let comparison = compare(&project.problem(), &[], &Control::unattended()).unwrap();
        let ratio = comparison.error / comparison.noise_floor;
        assert!((0.75..1.25).contains(&ratio), "error {} floor {}", comparison.error, comparison.noise_floor);
        assert!(comparison.energy_error < 0.05, "{}", comparison.energy_error);
    }
}

#[test]
fn a_model_that_lacks_an_effect_is_wrong_by_its_size_and_right_with_it() {
    let project = hidden(&[Effect::Viscous], kindness(true), &mut Random::new(5)).unwrap();
    let control = Control::unattended();
    let before = compare(&project.problem(), &[], &control).unwrap();
    assert!((0.15..0.6).contains(&before.error), "{}", before.error);
    assert!(before.error > 10.0 * before.noise_floor && before.energy_error > 0.05);
    let after = compare(&project.problem(), &project.truth, &control).unwrap();
    assert!(after.error < 1.25 * after.noise_floor, "{} {}", after.error, after.noise_floor);
    // Error of all: root mean square over runs and channels of the errors shown for each.
    let squares: Vec<f64> = before.runs.iter().flat_map(|r| r.channels.iter().map(|c| c.error.powi(2))).collect();
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    assert!((mean.sqrt() / before.error - 1.0).abs() < 1e-12);
}

#[test]
fn a_sensor_at_a_node_does_not_rule() {
    let project = hidden(&[Effect::Viscous], kindness(true), &mut Random::new(5)).unwrap();
    let comparison = compare(&project.problem(), &[], &Control::unattended()).unwrap();
    for run in &comparison.runs {
        let size = |c: &ChannelComparison| c.harmonics.iter().map(|h| h.measured.norm_sqr()).sum::<f64>().sqrt();
        let largest = run.channels.iter().map(size).fold(0.0, f64::max);
        for channel in &run.channels {
            let difference: f64 = channel.harmonics.iter().map(|h| (h.measured - h.model).norm_sqr()).sum();
            let expected = difference.sqrt() / size(channel).max(largest / 20.0);
            assert!((channel.error - expected).abs() < 1e-12 * expected.max(1e-9));
        }
    }
}

#[test]
fn runs_that_have_not_settled_keep_their_place_and_count_for_nothing() {
    use dashpot::measurement::{Finding, Flag};
    let mut project = hidden(&[Effect::Viscous], kindness(false), &mut Random::new(7)).unwrap();
    let control = Control::unattended();
    let all = compare(&project.problem(), &[], &control).unwrap();
    project.runs[4].findings.push(Finding::of_record(Flag::NotSettled, "a transient".to_string()));
    let some = compare(&project.problem(), &[], &control).unwrap();
    assert_eq!(some.runs.len(), all.runs.len());
    assert!(!some.runs[4].used && some.runs[4].error == all.runs[4].error);
    assert!(some.error != all.error);
}

#[test]
fn friction_that_nearly_sticks_does_not_raise_the_noise_floor() {
    // The truth against its own records, whose noise of 1 % leaves 0.2 % of a channel; some runs nearly stick.
    for name in ["cantilever-friction", "five-masses-friction"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data").join(name).join("truth.toml");
        let control = Control::unattended();
        let project = load(&path, &control).unwrap();
        let problem = Problem { structure: &project.structure, sources: &project.sources, runs: &project.runs };
        let comparison = compare(&problem, &[], &control).unwrap();
        assert!(comparison.noise_floor < 0.0035, "{name}: {}", comparison.noise_floor);
        assert!(comparison.error < 1.2 * comparison.noise_floor, "{name}: {}", comparison.error);
        for run in &comparison.runs {
            assert!(run.noise_floor < 0.008, "{name}, run {}: {}", run.index + 1, run.noise_floor);
        }
    }
}

/// A gap through which the motion at 21 Hz is not periodic; the other two runs have an answer.
#[test]
fn a_run_without_an_answer_is_named_beside_the_others() {
    let folder = tempfile::tempdir().unwrap();
    let project = "[project]\nformat = 1\n[structure]\nkind = \"beam\"\nlength = 0.45\nbreadth = 0.025\ndepth = 0.005\n\
        youngs_modulus = 2.08075e11\ndensity = 7787.2\nelements = 10\nsupports = \"clamped-free\"\n\
        [[source]]\nlaw = \"mass_proportional\"\nstate = \"known\"\nalpha = 1.2\n\
        [[source]]\nlaw = \"stiffness_proportional\"\nstate = \"known\"\nbeta = 6e-6\n\
        [[source]]\nlaw = \"gap\"\ndofs = [19]\nstate = \"known\"\nstiffness = 2e4\ngap = 6e-4\n\
        [[harmonics]]\nfile = \"steps.csv\"\n";
    let steps = "frequency_hz,force@7 [N],acc@19 [g],phase_deg acc@19\n\
        20.0,0.2977,0.9,171\n21.0,0.2977,1.09475,170.188\n126.0,0.3,0.3,10\n";
    let path = folder.path().join("p.toml");
    std::fs::write(&path, project).unwrap();
    std::fs::write(folder.path().join("steps.csv"), steps).unwrap();
    let path = path.display().to_string();
    let said = |words: &[&str]| dashpot::cli::answer(["dashpot"].iter().chain(words).map(Into::into));
    let text = said(&["compare", &path]).unwrap();
    assert!(text.contains("row 1  20.00") && text.contains("row 3  126.0") && !text.contains("row 2  21"), "{text}");
    assert!(text.contains("row 2: not predicted, left out: no periodic response was found at 21.0"), "{text}");
    let found: serde_json::Value = serde_json::from_str(&said(&["compare", "--json", &path]).unwrap()).unwrap();
    assert_eq!(found["runs"].as_array().unwrap().len(), 2);
    assert_eq!(found["unpredicted"][0]["file"], "row 2");
    assert!(found["unpredicted"][0]["reason"].as_str().unwrap().starts_with("no periodic response was found"));
    // Where no run has an answer, there is nothing to compare.
    let only: String =
        steps.lines().enumerate().filter(|(i, _)| [0, 2].contains(i)).map(|(_, l)| format!("{l}\n")).collect();
    std::fs::write(folder.path().join("steps.csv"), only).unwrap();
    let refused = said(&["compare", &path]).unwrap_err();
    assert!(refused.contains("run row 1 could not be predicted"), "{refused}");
}
