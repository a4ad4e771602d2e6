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
    project.runs[4].findings.push(Finding { flag: Flag::NotSettled, reason: "a transient".to_string() });
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
