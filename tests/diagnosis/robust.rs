//! Data that no model explains: an answer with finite numbers, never a panic.

use super::random::Random;
use super::suite::{Kindness, hidden};
use dashpot::control::Control;
use dashpot::diagnosis::diagnose::diagnose;
use faer::c64;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// A small project of noise turned at random, of a kind that the seed chooses; its diagnosis must be finite.
fn is_finite(seed: u64) {
    let mut random = Random::new(900 + seed);
    let kindness = Kindness {
        beam: seed.is_multiple_of(5),
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
        // Some nonsense is near the model, some far from it.
        let size = [0.02, 0.3, 1.0][seed as usize % 3];
        let turn = c64::new(1.0 - size, 0.0) + c64::new(random.normal(), random.normal()) * size;
        channel.amplitudes.iter_mut().for_each(|y| *y *= turn);
    }
    let Ok(diagnosis) = diagnose(&project.problem(), &Control::unattended()) else { return };
    assert!(diagnosis.error_before.is_finite() && diagnosis.noise_floor.is_finite(), "{seed}");
    let data: usize = project.runs.iter().map(|r| 2 * r.fit.harmonics() * r.fit.channels.len()).sum();
    for suggestion in &diagnosis.suggestions {
        assert!(suggestion.error_after.is_finite() && suggestion.held_out_error_after.is_finite(), "{seed}");
        assert!((0.0..=1.0).contains(&suggestion.probability), "{seed}: {}", suggestion.probability);
        assert!(suggestion.added.source.parameters.iter().all(|p| p.is_finite()), "{seed}");
        assert!(suggestion.added.deviations.iter().all(|d| !d.is_nan()), "{seed}");
        let parameters = suggestion.added.source.parameters.len();
        assert!(parameters < data && parameters <= project.runs.len(), "{seed}: {}", suggestion.added.source.effect);
    }
}

#[test]
fn nonsense_gets_a_finite_answer() {
    // Those that take seconds; points and more beams by the test below.
    [0, 2].into_iter().for_each(is_finite);
}

#[test]
#[ignore = "minutes in the development profile: cargo test --release --test diagnosis -- --ignored"]
fn much_nonsense_gets_finite_answers() {
    let next = AtomicU64::new(0);
    let take = || {
        while let Some(seed) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|&seed| seed < 500) {
            let begun = Instant::now();
            is_finite(seed);
            let taken = begun.elapsed();
            if taken.as_secs() >= 10 {
                println!("seed {seed}: {taken:.1?}");
            }
        }
    };
    std::thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(take))));
}
