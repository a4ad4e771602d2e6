//! Standard deviations are honest: over many seeds (found - true) / deviation has a standard deviation near 1.

use super::points::five_points;
use super::support::*;
use dashpot::control::Control;
use dashpot::effects::{Effect, Source};
use dashpot::identify::{Form, SelectionStatus, Settings, identify};
use dashpot::measurement::Run;
use dashpot::structure::Structure;

const SEEDS: u64 = 120;

/// z-scores of both dashpots over the seeds, and in how many seeds the accepted set was the true one.
fn scores(structure: &Structure, runs: &[Run], noise: f64, form: Form) -> (Vec<[f64; 2]>, usize) {
    let mut sources: Vec<Source> = (0..5).map(|i| candidate(Effect::Viscous, &[i])).collect();
    sources.extend((0..4).map(|i| candidate(Effect::Viscous, &[i, i + 1])));
    let settings = Settings { max_sources: 3, ..all_sets() };
    let mut right = 0;
    let scores = (0..SEEDS)
        .filter_map(|seed| {
            let runs = with_noise(runs, noise, seed);
            let outcome = identify(structure, &sources, &runs, &settings, &Control::unattended()).unwrap();
            assert_eq!(outcome.form, form);
            let places: Vec<usize> = outcome.accepted_step().sources.iter().map(|e| e.source).collect();
            right += usize::from(places == [6, 8] && outcome.status == SelectionStatus::WithinNoise);
            let step = outcome.steps.iter().find(|s| s.count == 2).unwrap();
            // Where noise has put another set first, there is no coefficient of the true one to score.
            if step.sources.iter().map(|e| e.source).collect::<Vec<_>>() != [6, 8] {
                return None;
            }
            let score = |k: usize, truth: f64| (step.sources[k].coefficient - truth) / step.sources[k].deviation;
            Some([score(0, 15.0), score(1, 4.0)])
        })
        .collect();
    (scores, right)
}

fn assert_honest(scores: &[[f64; 2]]) {
    for k in 0..2 {
        let rms = (scores.iter().map(|s| s[k] * s[k]).sum::<f64>() / scores.len() as f64).sqrt();
        // 120 seeds scatter the deviation by 6.5 %.
        assert!((0.8..1.2).contains(&rms), "coefficient {k}: {rms}");
    }
}

fn rig(sensors: &[usize]) -> Rig {
    let mut rig = Rig::near_modes(&five_masses(), 5, 1.005, 0, sensors);
    rig.frequencies_hz.extend(rig.frequencies_hz.clone().iter().map(|f| f * 0.99));
    rig
}

fn truth() -> [Source; 2] {
    [source(Effect::Viscous, &[1, 2], &[15.0]), source(Effect::Viscous, &[3, 4], &[4.0])]
}

#[test]
fn response_form_is_honest() {
    let structure = five_masses();
    let runs = rig(&[0, 2, 4]).runs(&structure, &truth());
    let (scores, right) = scores(&structure, &runs, 0.01, Form::Response);
    assert_honest(&scores);
    assert!(right as f64 > 0.9 * SEEDS as f64, "{right} of {SEEDS}");
}

#[test]
fn energy_form_without_matrices_is_honest() {
    let runs = rig(&[0, 1, 2, 3, 4]).runs(&five_masses(), &truth());
    let (scores, right) = scores(&five_points(), &runs, 1e-4, Form::Energy);
    assert_honest(&scores);
    assert!(right as f64 > 0.9 * SEEDS as f64, "{right} of {SEEDS}");
}
