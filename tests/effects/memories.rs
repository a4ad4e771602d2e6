//! Laws with memory stepped through time from rest reach the steady state of the sampled force.

use super::{cases, rich, sampled};
use dashpot::effects::Effect;

#[test]
fn stepping_through_time_reaches_the_steady_state() {
    let mut tried = Vec::new();
    for (effect, law, p) in cases() {
        // A relaxation faster than the step is seen half a step late; the slip laws do not see the step.
        let motion = rich(if effect == Effect::Maxwell { 50_000 } else { 1000 });
        let Some(mut memory) = law.memory(&p) else { continue };
        tried.push(effect);
        let mut marched = vec![0.0; motion.len()];
        // The slip laws of Masing's kind are periodic at once, those with one internal force by and by.
        let internal = matches!(effect, Effect::BoucWen | Effect::StiffeningBoucWen | Effect::Dahl);
        let periods = match effect {
            Effect::Maxwell => 6,
            _ if internal => 40,
            _ => 2,
        };
        for _ in 0..periods {
            for (n, &d) in motion.displacement.iter().enumerate() {
                let [trial, _] = memory.trial(d, motion.step());
                marched[n] = memory.advance(d, motion.step());
                assert!((trial - marched[n]).abs() <= 1e-12, "{effect} {p:?}: trial {trial}, then {}", marched[n]);
            }
        }
        let wanted = sampled(law, &p, &motion);
        let size = wanted.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
        let tolerance = match effect {
            Effect::Maxwell => 1e-3,
            _ if internal => 1e-8,
            _ => 1e-11,
        };
        for (n, (a, b)) in marched.iter().zip(&wanted).enumerate() {
            assert!((a - b).abs() < tolerance * size, "{effect} {p:?}, sample {n}: {a} instead of {b}");
        }
    }
    tried.dedup();
    let wanted = [
        Effect::ElasticSlider,
        Effect::Maxwell,
        Effect::Iwan,
        Effect::BoucWen,
        Effect::StiffeningBoucWen,
        Effect::Dahl,
        Effect::ElasticSliderBacklash,
    ];
    assert_eq!(tried, wanted);
}

/// The slope is the derivative of the force, forwards and after a reversal.
#[test]
fn the_trial_slope_is_the_derivative() {
    for (effect, law, p) in cases() {
        let Some(mut memory) = law.memory(&p) else { continue };
        for d in [1e-4, 3e-4, 2.2e-4, 2.7e-4, -1e-4] {
            memory.advance(d, 1e-3);
            for next in [d + 3.3e-5, d - 3.3e-5, d - 8.1e-5] {
                let [high, low] = [1e-9, -1e-9].map(|e| memory.trial(next + e, 1e-3)[0]);
                let (wanted, [_, found]) = ((high - low) / 2e-9, memory.trial(next, 1e-3));
                assert!((found - wanted).abs() < 1e-5 * p[0], "{effect} {p:?} at {next}: {found} instead of {wanted}");
            }
        }
    }
}

/// A trial of a search may leave all numbers: the answer is then no number, and no panic.
#[test]
fn internal_forces_of_parameters_that_are_no_numbers_do_not_panic() {
    let internal = |effect: &Effect| matches!(effect, Effect::BoucWen | Effect::StiffeningBoucWen | Effect::Dahl);
    for (_, law, p) in cases().into_iter().filter(|(effect, ..)| internal(effect)) {
        let (motion, lost) = (rich(16), vec![f64::NAN; p.len()]);
        assert_eq!(sampled(law, &lost, &motion).len(), 16);
    }
}
