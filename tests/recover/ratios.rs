//! Damping ratios beside the energies: exact ones do not bias, good ones help noisy energies, and bad ones are named.

use super::support::*;
use dashpot::balance::{Expansion, Weights};
use dashpot::control::Control;
use dashpot::effects::{Effect, Source, State};
use dashpot::identify::{Form, IdentifyError, Measurements, Outcome, Settings, identify_measured};
use dashpot::measurement::{MeasuredRatio, Run};
use dashpot::response::linear_matrices::LinearMatrices;
use dashpot::structure::Structure;
use dashpot::structure::damped_modes::damped_modes;

const VALUES: [(&[usize], f64); 3] = [(&[0], 2.0), (&[1, 2], 15.0), (&[3, 4], 4.0)];

fn truth() -> Vec<Source> {
    VALUES.iter().map(|&(dofs, c)| source(Effect::Viscous, dofs, &[c])).collect()
}

fn candidates() -> Vec<Source> {
    let ground = (0..5).map(|i| candidate(Effect::Viscous, &[i]));
    ground.chain((0..4).map(|i| candidate(Effect::Viscous, &[i, i + 1]))).collect()
}

/// The ratios of the true model's damped modes, by the eigenvalues of the whole.
fn exact_ratios(structure: &Structure, deviation: f64) -> Vec<MeasuredRatio> {
    let all = LinearMatrices::new(structure, &truth()).unwrap();
    let modes = damped_modes(all.mass.as_ref(), all.stiffness.as_ref(), all.viscous.as_ref()).unwrap();
    let ratio = |m: &dashpot::structure::damped_modes::DampedMode| MeasuredRatio {
        omega: m.lambda.norm(),
        ratio: m.damping_ratio,
        deviation: deviation * m.damping_ratio,
    };
    modes.iter().map(ratio).collect()
}

fn identified(sources: &[Source], runs: &[Run], ratios: &[MeasuredRatio], settings: &Settings) -> Outcome {
    with_ratios(sources, runs, ratios, settings).unwrap()
}

fn with_ratios(
    sources: &[Source],
    runs: &[Run],
    ratios: &[MeasuredRatio],
    settings: &Settings,
) -> Result<Outcome, IdentifyError> {
    let measured = Measurements { runs, transient_runs: &[], ratios };
    identify_measured(&five_masses(), sources, measured, settings, &Control::unattended())
}

#[test]
fn exact_ratios_do_not_bias() {
    let structure = five_masses();
    let mut rig = Rig::near_modes(&structure, 5, 1.01, 0, &[0, 1, 2, 3, 4]);
    rig.frequencies_hz.extend(rig.frequencies_hz.clone().iter().map(|f| f * 0.97));
    let runs = rig.runs(&structure, &truth());
    for (expansion, form) in [(Expansion::None, Form::Energy), (Expansion::Dynamic, Form::Response)] {
        let settings = Settings { expansion, stop_angle_deg: 1e-5, ..all_sets() };
        let outcome = identified(&candidates(), &runs, &exact_ratios(&structure, 0.01), &settings);
        assert_eq!(outcome.form, form);
        assert_found(&outcome, &[(0, 2.0), (6, 15.0), (8, 4.0)], 1e-7);
    }
}

/// Two runs cannot tell nine candidates apart; with the ratios of five modes they do.
#[test]
fn ratios_stand_in_for_runs() {
    let structure = five_masses();
    let mut rig = Rig::near_modes(&structure, 2, 1.01, 0, &[0, 1, 2, 3, 4]);
    rig.force = 3.0;
    let runs = rig.runs(&structure, &truth());
    let settings = Settings { expansion: Expansion::None, stop_angle_deg: 1e-5, ..all_sets() };
    let alone = identified(&candidates(), &runs, &[], &settings);
    assert!(alone.accepted_step().count < 3);
    let joined = identified(&candidates(), &runs, &exact_ratios(&structure, 0.0), &settings);
    assert_found(&joined, &[(0, 2.0), (6, 15.0), (8, 4.0)], 1e-6);
}

/// Noise of 2 % on all channels, ratios good to 0.5 %: the errors over many noises shrink, and so do the stated deviations,
/// in the same measure.
#[test]
fn good_ratios_lessen_the_deviation_of_noisy_energies() {
    let structure = five_masses();
    let rig = Rig::near_modes(&structure, 5, 1.01, 0, &[0, 1, 2, 3, 4]);
    let clean = rig.runs(&structure, &truth());
    let forced = |&(dofs, _): &(&[usize], f64)| Source { state: State::Forced, ..candidate(Effect::Viscous, dofs) };
    let sources: Vec<Source> = VALUES.iter().map(forced).collect();
    let settings = Settings { expansion: Expansion::None, weights: Weights::Noise, ..all_sets() };
    let ratios = exact_ratios(&structure, 0.005);
    let (mut errors, mut scores, mut stated) = ([0.0; 2], [0.0; 2], [0.0; 2]);
    let seeds = 24;
    for seed in 0..seeds {
        let runs = with_noise(&clean, 0.02, seed);
        for (k, given) in [&[][..], &shaken(&ratios, seed)].into_iter().enumerate() {
            let outcome = identified(&sources, &runs, given, &settings);
            for (estimate, (_, value)) in outcome.accepted_step().sources.iter().zip(VALUES) {
                errors[k] += (estimate.coefficient / value - 1.0).powi(2);
                stated[k] += (estimate.deviation / value).powi(2);
                scores[k] += ((estimate.coefficient - value) / estimate.deviation).powi(2);
            }
        }
    }
    let count = 3.0 * seeds as f64;
    assert!(errors[1] < 0.25 * errors[0] && stated[1] < 0.25 * stated[0], "{errors:?} {stated:?}");
    assert!(scores.iter().all(|s| (0.5..2.0).contains(&(s / count).sqrt())), "{scores:?} of {count}");
}

/// Ratios off by their own deviation.
fn shaken(ratios: &[MeasuredRatio], seed: u64) -> Vec<MeasuredRatio> {
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(1000 + seed);
    let mut sample = || -> f64 { StandardNormal.sample(&mut random) };
    ratios.iter().map(|r| MeasuredRatio { ratio: r.ratio + r.deviation * sample(), ..*r }).collect()
}

#[test]
fn ratios_that_cannot_join_are_named() {
    let structure = five_masses();
    let runs = Rig::near_modes(&structure, 5, 1.01, 0, &[0, 1, 2, 3, 4]).runs(&structure, &truth());
    let error = |sources: &[Source], ratio: MeasuredRatio| {
        with_ratios(sources, &runs, &[ratio], &all_sets()).unwrap_err().to_string()
    };
    let good = exact_ratios(&structure, 0.01)[0];
    let far = error(&candidates(), MeasuredRatio { omega: 10.0, ..good });
    assert!(far.starts_with("the damping ratio at 1.5915 Hz belongs to no mode"), "{far}");
    let odd = error(&candidates(), MeasuredRatio { ratio: 1.5, ..good });
    assert!(odd.contains("is 1.5; give one between 0 and 1"), "{odd}");
    let friction = error(&[candidate(Effect::Coulomb, &[2])], good);
    assert!(friction.starts_with("damping ratios cannot stand beside Coulomb friction at DOF 3"), "{friction}");
}
