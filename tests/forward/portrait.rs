//! What a law does to one mass, against closed forms.

use crate::common::models::oscillator;
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::response::portrait::{LEVELS, Portrait, Setup, portrait};
use std::f64::consts::{PI, TAU};

const MASS: f64 = 2.0;
const STIFFNESS: f64 = 1000.0;

/// One mass on a spring as in figures 2.3 to 2.9.
fn setup(effect: Effect, parameters: &[f64], background: f64) -> Setup {
    Setup {
        structure: oscillator(MASS, STIFFNESS),
        source: Source::known(effect, Place::Dofs(vec![0]), parameters),
        background,
        drive: 0,
        force: 2.0,
        frequency_hz: 3.0,
        displacement: 0.01,
    }
}

fn look(setup: &Setup) -> Portrait {
    portrait(setup, &Control::unattended()).unwrap()
}

fn area(points: &[[f64; 2]]) -> f64 {
    points.windows(2).map(|p| 0.5 * (p[0][1] + p[1][1]) * (p[1][0] - p[0][0])).sum()
}

#[test]
fn a_dashpot_decays_responds_and_dissipates_as_in_the_textbook() {
    let c = 9.0;
    let found = look(&setup(Effect::Viscous, &[c], 0.0));
    let (wn, zeta) = ((STIFFNESS / MASS).sqrt(), c / (2.0 * (STIFFNESS * MASS).sqrt()));
    let wd = wn * (1.0 - zeta * zeta).sqrt();
    for [t, x] in found.decay.unwrap() {
        let exact = 0.01 * (-zeta * wn * t).exp() * ((wd * t).cos() + zeta * wn / wd * (wd * t).sin());
        assert!((x - exact).abs() < 1e-8, "{t}: {x} for {exact}");
    }
    for curve in &found.curves {
        for p in curve.found.as_ref().unwrap() {
            let w = TAU * p.frequency_hz;
            let exact = 1.0 / faer::c64::new(STIFFNESS - MASS * w * w, c * w);
            assert!((p.receptance - exact).norm() < 1e-6 * exact.norm() && p.stable);
        }
    }
    let omega = TAU * 3.0;
    for [a, e] in found.energy {
        assert!((e - PI * c * omega * a * a).abs() < 1e-9 * e);
    }
}

#[test]
fn loops_enclose_the_energy_that_law_and_background_take_out() {
    let omega = TAU * 3.0;
    for (effect, parameters) in [
        (Effect::Coulomb, vec![0.5]),
        (Effect::Quadratic, vec![20.0]),
        (Effect::ElasticSlider, vec![400.0, 0.5]),
        (Effect::ElasticSliderBacklash, vec![400.0, 0.5, 1e-3]),
        (Effect::Stop, vec![1000.0, 0.003]),
        (Effect::Hysteretic, vec![60.0]),
        (Effect::CubicStiffness, vec![1e6]),
    ] {
        let found = look(&setup(effect, &parameters, 1.0));
        for ((exciter, own), share) in found.loops.iter().zip(&found.own).zip(LEVELS) {
            assert_eq!(exciter.force, 2.0 * share);
            let (exciter, own) = (exciter.found.as_ref().unwrap(), own.found.as_ref().unwrap());
            // The background's share by its own loop, from the velocity of the polygon.
            let step = TAU / omega / (exciter.len() - 1) as f64;
            let background: f64 = exciter.windows(2).map(|p| (p[1][0] - p[0][0]).powi(2) / step).sum();
            // Both loops run clockwise where energy is lost.
            let (put_in, taken_out) = (area(exciter), area(own) + background);
            let scale = put_in.abs().max(1e-9);
            assert!((put_in - taken_out).abs() < 0.02 * scale, "{effect} {share}: {put_in} against {taken_out}");
        }
    }
}

#[test]
fn dry_friction_decays_in_a_straight_line_and_hysteretic_damping_has_no_motion_in_time() {
    let force = 0.4;
    let found = look(&setup(Effect::Coulomb, &[force], 0.0));
    let decay = found.decay.unwrap();
    // Turning points lose 2 F / k each half period.
    let tops: Vec<f64> = decay
        .windows(3)
        .filter(|w| w[1][1].abs() >= w[0][1].abs() && w[1][1].abs() > w[2][1].abs())
        .map(|w| w[1][1].abs())
        .collect();
    for (k, top) in tops.iter().take(8).enumerate() {
        let exact = 0.01 - (k as f64 + 1.0) * 2.0 * force / STIFFNESS;
        assert!((top - exact).abs() < 2e-5, "turn {k}: {top} for {exact}");
    }
    for [a, e] in found.energy {
        assert!((e - 4.0 * force * a).abs() < 1e-9 * e);
    }
    let why = look(&setup(Effect::Hysteretic, &[60.0], 0.0)).decay.unwrap_err();
    assert!(why.contains("time"), "{why}");
}
