//! Data that no model explains: an answer with finite numbers, never a panic.

use super::random::Random;
use super::suite::{Kindness, hidden};
use dashpot::control::Control;
use dashpot::explain::diagnose::diagnose;
use faer::c64;

#[test]
fn nonsense_gets_a_finite_answer() {
    for seed in 0..8 {
        let mut random = Random::new(900 + seed);
        let kindness = Kindness {
            beam: seed % 3 == 0,
            points: seed % 4 == 1,
            sensors: 2,
            runs: 2 + seed as usize % 3,
            levels: 2,
            noise: 0.02,
            size: 0.2,
            detuned: 0.0,
            unsettled: false,
        };
        let mut project = hidden(&[], kindness, &mut random).unwrap();
        for channel in project.runs.iter_mut().flat_map(|run| &mut run.fit.channels) {
            let turn = c64::new(random.normal(), random.normal());
            channel.amplitudes.iter_mut().for_each(|y| *y *= turn);
        }
        let Ok(diagnosis) = diagnose(&project.problem(), &Control::unattended()) else { continue };
        assert!(diagnosis.error_before.is_finite() && diagnosis.noise_floor.is_finite(), "{seed}");
        for suggestion in &diagnosis.suggestions {
            assert!(suggestion.error_after.is_finite() && suggestion.probability.is_finite(), "{seed}");
            assert!(suggestion.added.source.parameters.iter().all(|p| p.is_finite()), "{seed}");
        }
    }
}
