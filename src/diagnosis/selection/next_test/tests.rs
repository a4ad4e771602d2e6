//! The next test of a mass on a spring with a dashpot, whose response `X = F / (k - m w^2 + i w c)` and its derivative by the
//! logarithm of `c`, `-i w c X^2 / F`, are known in closed form.
#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::common::models::{oscillator, receptance, source, three_masses};
use crate::common::runs::{channel, displacements_run, run};
use crate::control::Control;
use crate::diagnosis::Problem;
use crate::diagnosis::residual::data::Data;
use crate::diagnosis::residual::prediction::{FINAL, Predictor};
use crate::measurement::{Quantity, Run};
use crate::response::harmonic_balance::ForwardModel;
use std::sync::Arc;

const MASS: f64 = 1.0;
const STIFFNESS: f64 = 2500.0;
const DASHPOT: f64 = 0.5;
/// Force (N) and relative deviation of every channel: that of a response over its force is larger by the root of two.
const FORCE: f64 = 2.0;
const NOISE: f64 = 1e-2;
/// Frequencies of the runs, none of them near resonance.
const OMEGAS: [f64; 2] = [40.0, 62.0];

fn dashpot(c: f64) -> Source {
    source(Effect::Viscous, &[0], &[c])
}

fn response(c: f64, omega: f64) -> c64 {
    receptance(MASS, STIFFNESS, c, omega)
}

/// What `check` finds on a model without a dashpot and runs with one.
fn with_reference(check: impl Fn(&ReferenceModel)) {
    let structure = oscillator(MASS, STIFFNESS);
    let runs: Vec<Run> =
        OMEGAS.iter().map(|&w| displacements_run(w, (0, FORCE), &[response(DASHPOT, w) * FORCE], NOISE)).collect();
    let problem = Problem { structure: &structure, sources: &[], runs: &runs };
    let data = Data::new(&problem).unwrap();
    let predictor = Arc::new(Predictor::new(&structure, Vec::new(), &data).unwrap());
    let control = Control::unattended();
    check(&ReferenceModel::new(predictor, &data, &control, &|_| {}).unwrap());
}

/// The frequencies that are looked at: nine in equal ratios from 0.9 times the lowest to 1.1 times the highest of the runs.
fn frequencies() -> Vec<f64> {
    let (low, high) = (0.9 * OMEGAS[0], 1.1 * OMEGAS[1]);
    (0..9).map(|k| (low.ln() + (high / low).ln() * f64::from(k) / 8.0).exp()).collect()
}

/// The number that follows a phrase.
fn number_after(text: &str, phrase: &str) -> f64 {
    let rest = text.split_once(phrase).unwrap_or_else(|| panic!("{phrase} in {text}")).1.trim_start();
    rest.split(|c: char| c != '.' && !c.is_ascii_digit()).next().unwrap().parse().unwrap()
}

#[test]
fn two_dashpots_are_told_apart_where_their_responses_differ_most() {
    let other = 1.1 * DASHPOT;
    let separation = |w: f64| {
        let (x, y) = (response(DASHPOT, w), response(other, w));
        (x - y).norm() / (2.0_f64.sqrt() * NOISE * x.norm().max(y.norm()))
    };
    let best = frequencies().into_iter().max_by(|a, b| separation(*a).total_cmp(&separation(*b))).unwrap();
    with_reference(|reference| {
        let test = next_test(reference, &[dashpot(DASHPOT)], &[dashpot(other)]).unwrap().unwrap();
        assert!((test.frequency_hz * TAU / best - 1.0).abs() < 1e-9, "{} for {best}", test.frequency_hz * TAU);
        assert_eq!((test.kind, test.force_dof), (TestKind::Steady, 0));
        let told = number_after(&test.why, "differ there by");
        assert!((told - separation(best)).abs() < 0.051, "{} for {}", test.why, separation(best));
        assert!(next_test(reference, &[dashpot(DASHPOT)], &[dashpot(DASHPOT)]).unwrap().is_none());
    });
}

/// A dashpot of which runs beside the resonance say little: the run nearest to it narrows its deviation down as it should.
#[test]
fn the_pinning_test_narrows_a_deviation_down_as_in_closed_form() {
    // |d X / d ln c| / |X|, over the relative deviation of a response.
    let information = |w: f64| (w * DASHPOT * response(DASHPOT, w).norm() / (2.0_f64.sqrt() * NOISE)).powi(2);
    let known: f64 = OMEGAS.iter().map(|w| information(*w)).sum();
    let most = frequencies().into_iter().max_by(|a, b| information(*a).total_cmp(&information(*b))).unwrap();
    let (before, after) = (known.sqrt().recip(), (known + information(most)).sqrt().recip());
    assert!(before > 1.3 * after, "the test's own numbers");
    with_reference(|reference| {
        let fit = reference.estimator().fit(&[dashpot(DASHPOT)], 30, &FINAL, &[]).unwrap();
        assert!((fit.effects[0].parameters[0] / DASHPOT - 1.0).abs() < 1e-6, "{:?}", fit.effects);
        let test = pinning_test(reference, &fit).unwrap().unwrap();
        assert!((test.frequency_hz * TAU / most - 1.0).abs() < 1e-9, "{} for {most}", test.frequency_hz * TAU);
        for (phrase, expected) in [("deviation from", before), ("% to", after)] {
            let told = number_after(&test.why, phrase) / 100.0;
            assert!((told / expected - 1.0).abs() < 0.02, "{}: {expected}", test.why);
        }
    });
}

/// Of masses on a base that moves the next test names the motion of the base and no force at one of them.
#[test]
fn a_base_that_drove_the_runs_drives_the_next_test() {
    let (structure, hidden) = (three_masses([1.0; 3]), [source(Effect::Viscous, &[1], &[0.8])]);
    let model = ForwardModel::new(&structure, &hidden).unwrap();
    let kind = |on_moving_base: bool| {
        let runs: Vec<Run> = [(46.0, 1.0), (48.0, 3.0)]
            .into_iter()
            .map(|(omega, times)| {
                let loads: Vec<(usize, c64)> = (0..3).map(|dof| (dof, c64::new(-1.0, 0.5))).collect();
                let excitation = of_base(omega, &loads, times);
                let control = Control::unattended();
                let response = model.at(omega).respond(&hidden, &excitation, &FINAL, None, &control).unwrap();
                let forces =
                    excitation.forces.iter().map(|f| channel(Quantity::Force, f.dof, f.harmonics.clone(), 1e-3));
                let motion = |dof: usize| channel(Quantity::Displacement, dof, vec![response.amplitude(dof, 1)], 1e-7);
                let run = run(format!("{omega}"), omega, forces.chain((0..3).map(motion)).collect());
                Run { on_moving_base, ..run }
            })
            .collect();
        let problem = Problem { structure: &structure, sources: &[], runs: &runs };
        let data = Data::new(&problem).unwrap();
        let predictor = Arc::new(Predictor::new(&structure, Vec::new(), &data).unwrap());
        let control = Control::unattended();
        let reference = ReferenceModel::new(predictor, &data, &control, &|_| {}).unwrap();
        next_test(&reference, &hidden, &[source(Effect::Viscous, &[2], &[0.8])]).unwrap().unwrap().kind
    };
    assert!(matches!(kind(true), TestKind::Base { times } if times == 0.5 || times == 2.0), "{:?}", kind(true));
    assert_eq!(kind(false), TestKind::Steady);
}
