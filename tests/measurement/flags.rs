//! Every flag fires where it must and stays silent where it must.

use crate::signals::{Signal, beam, changed, even, record, z};
use dashpot::measurement::quality::phase_sensitivity;
use dashpot::measurement::{Finding, Flag, Quantity, Record, Run, fit};
use std::f64::consts::TAU;
use std::sync::Arc;

fn findings(record: &Record, frequency_hz: f64) -> Vec<Finding> {
    let record = Arc::new(record.clone());
    Run::from_record("run.csv".to_owned(), None, true, record, Some(frequency_hz), 7, &[]).unwrap().findings
}

fn flags(record: &Record, frequency_hz: f64) -> Vec<Flag> {
    findings(record, frequency_hz).into_iter().map(|finding| finding.flag).collect()
}

#[test]
fn a_clean_record_is_not_flagged() {
    // 5 % of noise, 1000 samples, some broken periods, 600 seeds: fewer than 1 % false alarms.
    let mut alarms = 0;
    for seed in 0..600 {
        let frequency_hz = 9.0 + 0.017 * seed as f64;
        alarms +=
            usize::from(!flags(&record(&beam(0.05), frequency_hz, even(1000, 1000.0), seed), frequency_hz).is_empty());
    }
    assert!(alarms < 6, "{alarms} of 600");
}

#[test]
fn a_clean_record_without_noise_is_not_flagged() {
    for frequency_hz in [10.0, 10.37, 3.7, 61.3] {
        let found = flags(&record(&beam(0.0), frequency_hz, even(2000, 1000.0), 1), frequency_hz);
        assert_eq!(found, [], "{frequency_hz} Hz");
    }
}

#[test]
fn friction_harmonics_are_no_transient() {
    let harmonics: Vec<_> = (1..=31).map(|h| z(if h % 2 == 1 { 1.0 / f64::from(h) } else { 0.0 }, 0.0)).collect();
    for frequency_hz in [10.0, 7.77, 9.43] {
        let mut signals = beam(1e-4);
        signals[1].amplitudes.clone_from(&harmonics);
        let found = flags(&record(&signals, frequency_hz, even(1500, 1000.0), 1), frequency_hz);
        assert!(!found.contains(&Flag::NotSettled), "{frequency_hz} Hz: {found:?}");
    }
}

/// A record with a transient of relative amplitude `share` at `natural_hz` that decays at `rate` 1/s.
fn ringing(share: f64, natural_hz: f64, rate: f64, noise: f64, seed: u64) -> Record {
    changed(&beam(noise), 10.0, even(2000, 1000.0), seed, |c, t, y| {
        y + if c == 0 { 0.0 } else { share * 30.0 * (-rate * t).exp() * (TAU * natural_hz * t).cos() }
    })
}

#[test]
fn a_transient_of_a_few_per_cent_is_found() {
    // Near resonance (beats slowly), away from it, at a higher mode; quick and slow decay.
    for natural_hz in [10.05, 10.3, 11.0, 13.0, 47.3] {
        for rate in [0.5, 1.0, 3.0] {
            let found = flags(&ringing(0.02, natural_hz, rate, 1e-4, 1), 10.0);
            assert_eq!(found, [Flag::NotSettled], "{natural_hz} Hz, {rate} 1/s");
            let found = flags(&ringing(0.02, natural_hz, rate, 0.0, 1), 10.0);
            assert_eq!(found, [Flag::NotSettled], "{natural_hz} Hz, {rate} 1/s, no noise");
        }
    }
    // In 1 % of noise.
    for seed in 0..20 {
        assert!(flags(&ringing(0.02, 10.1, 1.0, 0.01, seed), 10.0).contains(&Flag::NotSettled), "seed {seed}");
    }
}

#[test]
fn a_frequency_slightly_off_is_no_transient() {
    for noise in [0.0, 0.01, 0.05] {
        let record = record(&beam(noise), 10.01, even(2000, 1000.0), 5);
        let found = flags(&record, 10.0);
        assert!(!found.contains(&Flag::NotSettled), "{noise}: {found:?}");
    }
}

#[test]
fn a_wrong_frequency_is_found() {
    for given_hz in [10.0, 9.7, 9.0, 11.5, 20.3, 5.15, 33.0] {
        for noise in [0.0, 0.05] {
            let record = record(&beam(noise), 10.3, even(2000, 1000.0), 5);
            let found = flags(&record, given_hz);
            assert!(found.contains(&Flag::WrongFrequency), "{given_hz} Hz, noise {noise}: {found:?}");
        }
    }
}

#[test]
fn noise_is_found() {
    assert_eq!(flags(&record(&beam(0.3), 10.0, even(2000, 1000.0), 1), 10.0), [Flag::Noisy]);
}

#[test]
fn clipping_is_found_and_coarse_numbers_are_none() {
    let clip = |limit: f64| {
        changed(
            &beam(0.01),
            10.0,
            even(2000, 1000.0),
            1,
            move |c, _, y| if c == 1 { y.clamp(-limit, limit) } else { y },
        )
    };
    assert!(flags(&clip(36.0), 10.0).contains(&Flag::Clipped));
    assert!(!flags(&clip(80.0), 10.0).contains(&Flag::Clipped));
    // Eight bits, slow sampling of the peak: plateaus of many equal samples, and no clipping.
    for noise in [0.0, 0.001, 0.01] {
        let coarse = changed(&beam(noise), 2.0, even(4000, 1000.0), 1, |c, _, y| {
            let step = if c == 0 { 0.01 } else { 0.4 };
            (y / step).round() * step
        });
        assert!(!flags(&coarse, 2.0).contains(&Flag::Clipped), "{noise}");
    }
}

#[test]
fn missing_and_repeated_samples_are_found() {
    let gap: Vec<f64> = even(2000, 1000.0).into_iter().filter(|t| !(0.5..0.52).contains(t)).collect();
    assert_eq!(flags(&record(&beam(0.01), 10.0, gap, 1), 10.0), [Flag::MissingSamples]);
    let mut twice = even(2000, 1000.0);
    twice[700] = twice[699];
    assert_eq!(flags(&record(&beam(0.01), 10.0, twice, 1), 10.0), [Flag::MissingSamples]);
    let held = changed(&beam(0.0), 10.0, even(2000, 1000.0), 1, |_, _, y| y);
    let rows: Vec<Vec<f64>> = (0..3)
        .map(|c| {
            let mut samples = held.samples(c).to_vec();
            samples.copy_within(800..801, 801);
            samples
        })
        .collect();
    let held = Record::new(held.time().to_vec(), held.channels().to_vec(), rows).unwrap();
    assert!(flags(&held, 10.0).contains(&Flag::MissingSamples));
    let uneven = (0..1500).map(|n| f64::from(n) * 1e-3 + 3e-4 * f64::from(n * n).sin()).collect();
    assert_eq!(flags(&record(&beam(0.01), 10.0, uneven, 1), 10.0), []);
}

#[test]
fn a_dead_channel_is_found() {
    for noise in [0.0, 0.01] {
        let mut signals = beam(0.01);
        signals.push(Signal::new(Quantity::Acceleration, 3, &[z(0.0, 0.0)], noise));
        let found = flags(&record(&signals, 10.0, even(2000, 1000.0), 1), 10.0);
        assert_eq!(found, [Flag::DeadChannel], "{noise}");
    }
}

#[test]
fn phase_sensitivity_is_that_of_the_loss_angle() {
    // One degree of freedom at 1 % of damping and 0.9 of its resonance: x = f / (k (1 - r^2 + 2 i zeta r)).
    let sensitive = |r: f64| {
        let response = z(1.0, 0.0) / z(1.0 - r * r, 0.02 * r);
        let signals = [
            Signal::new(Quantity::Force, 0, &[z(1.0, 0.0)], 0.0),
            Signal::new(Quantity::Displacement, 0, &[response], 0.0),
        ];
        let record = record(&signals, 10.0, even(2000, 1000.0), 1);
        let fit = fit(&record, TAU * 10.0, 1).unwrap();
        (phase_sensitivity(&fit).unwrap(), flags(&record, 10.0))
    };
    let (sensitivity, flags) = sensitive(0.9);
    assert!((sensitivity - (0.19_f64 / 0.018).to_radians()).abs() < 1e-9, "{sensitivity}");
    assert_eq!(flags, [Flag::PhaseSensitive]);
    let (sensitivity, flags) = sensitive(1.0);
    assert!(sensitivity < 1e-9);
    assert_eq!(flags, []);
}

fn reasons(record: &Record, frequency_hz: f64) -> Vec<(Flag, String)> {
    findings(record, frequency_hz).into_iter().map(|finding| (finding.flag, finding.reason)).collect()
}

/// Shakers warm up: the level creeps by half a per cent, the response follows, and the ratio of both stays what it was.
#[test]
fn a_level_that_creeps_is_no_transient() {
    for share in [0.002, 0.005, -0.01] {
        let creeping = changed(&beam(1e-4), 10.0, even(4000, 1000.0), 3, |_, t, y| y * (1.0 + share * t / 4.0));
        assert_eq!(flags(&creeping, 10.0), [], "{share}");
        let before = fit(&record(&beam(0.0), 10.0, even(4000, 1000.0), 3), TAU * 10.0, 1).unwrap();
        let after = fit(&creeping, TAU * 10.0, 1).unwrap();
        let ratio =
            |fit: &dashpot::measurement::HarmonicFit| fit.channels[1].amplitudes[0] / fit.channels[0].amplitudes[0];
        assert!((ratio(&after) / ratio(&before) - 1.0).norm() < 1e-4, "{share}");
    }
    // A response that creeps on its own under a steady force is one.
    let alone = changed(
        &beam(1e-4),
        10.0,
        even(4000, 1000.0),
        3,
        |c, t, y| if c == 0 { y } else { y * (1.0 + 0.01 * t / 4.0) },
    );
    assert_eq!(flags(&alone, 10.0), [Flag::NotSettled]);
}

#[test]
fn a_test_that_is_run_up_and_down_is_told_where_it_is_steady() {
    let ramp =
        |up: f64, down: f64| move |_: usize, t: f64, y: f64| y * (t / up).min(1.0).min((10.0 - t) / down).max(0.0);
    let found = reasons(&changed(&beam(1e-3), 10.0, even(10_000, 1000.0), 1, ramp(2.0, 1.5)), 10.0);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].1.contains("is run up until") && found[0].1.contains("and down from"), "{}", found[0].1);
    let up = reasons(&changed(&beam(1e-3), 10.0, even(10_000, 1000.0), 1, ramp(2.0, 1e-9)), 10.0);
    assert!(up[0].1.contains("is run up until") && !up[0].1.contains("down"), "{}", up[0].1);
}

/// A friction damper whose amplitude is run up in two cycles, held for three and run down in two: the force slips at its
/// limit from the second cycle on, so that the motion shows the ramps better than the force does.
#[test]
fn ramps_of_a_friction_damper_are_seen_in_its_motion() {
    let signals = [
        Signal::new(Quantity::Force, 0, &[z(0.0, 9000.0)], 40.0),
        Signal::new(Quantity::Displacement, 0, &[z(0.01, 0.0)], 1e-6),
    ];
    let size = |t: f64| (t / 2.0).min(1.0).min((7.0 - t) / 2.0).max(0.0);
    let moved =
        changed(
            &signals,
            1.0,
            even(7000, 1000.0),
            1,
            |c, t, y| if c == 1 { y * size(t) } else { y * (4.0 * size(t)).min(1.0) },
        );
    let found = reasons(&moved, 1.0);
    assert!(found[0].1.contains("is run up until 2.0") && found[0].1.contains("down from 5.0"), "{found:?}");
}

#[test]
fn what_is_no_steady_sine_is_told_so() {
    let free = || vec![Signal::new(Quantity::Acceleration, 0, &[z(1.0, 0.0)], 1e-4)];
    let decay = changed(&free(), 10.0, even(4000, 1000.0), 1, |_, t, y| y * (-t).exp());
    let found = reasons(&decay, 10.0);
    assert_eq!(found[0].0, Flag::NotPeriodic, "{found:?}");
    assert!(found[0].1.contains("is a free decay"), "{}", found[0].1);
    let noise = record(&beam(3.0), 10.0, even(4000, 1000.0), 1);
    assert!(
        reasons(&noise, 10.0).iter().any(|(flag, why)| *flag == Flag::NotPeriodic && why.contains("is no sine of 10"))
    );
    // A sum of sines of which the fit holds one.
    let several = changed(&beam(1e-3), 10.0, even(4000, 1000.0), 1, |c, t, y| {
        let size = [1.0, 40.0, 24.0][c];
        y + size * ((TAU * 13.3 * t).cos() + (TAU * 17.9 * t).cos() + (TAU * 7.1 * t).cos())
    });
    assert!(flags(&several, 10.0).iter().any(|f| matches!(f, Flag::NotPeriodic | Flag::WrongFrequency)));
    assert!(!flags(&record(&beam(0.3), 10.0, even(2000, 1000.0), 1), 10.0).contains(&Flag::NotPeriodic));
}
