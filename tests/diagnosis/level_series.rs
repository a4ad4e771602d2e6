//! One mode measured as laboratories do it: a stepped sine at several levels of force, a joint that is re-seated between the
//! levels and settles within them, a model that is off by percents. Truth: harmonic balance, each run with its own stiffness.

use super::random::Random;
use crate::common::models::oscillator;
use dashpot::control::Control;
use dashpot::diagnosis::diagnose::diagnose;
use dashpot::diagnosis::result::Verdict;
use dashpot::diagnosis::{Diagnosis, Problem};
use dashpot::effects::{Effect, Place, Source};
use dashpot::measurement::{Channel, ChannelFit, HarmonicFit, Quantity, Run};
use dashpot::response::harmonic_balance::{Excitation, ForwardModel, Settings};
use faer::{Mat, c64};

/// Force of each level, N, and lines of each.
const FORCES: [f64; 4] = [0.25, 0.5, 1.0, 2.0];
const LINES: usize = 25;
/// Mass, kg, and frequency, Hz.
const MASS: f64 = 2.0;
const FREQUENCY: f64 = 80.0;
/// Relative standard deviations: stiffness from level to level and from run to run, readings.
const RESEATED: f64 = 4e-3;
const SETTLES: f64 = 1e-3;
const NOISE: f64 = 5e-3;

fn viscous(c: f64) -> Source {
    Source::known(Effect::Viscous, Place::Dofs(vec![0]), &[c])
}

fn channel(quantity: Quantity, y: c64, noise: f64) -> ChannelFit {
    let variance = (noise * y.norm()).powi(2);
    ChannelFit {
        channel: Channel { quantity, dof: 0, label: "1".into() },
        offset: 0.0,
        slope: 0.0,
        covariance: Mat::from_fn(2, 2, |i, j| if i == j { variance } else { 0.0 }),
        amplitudes: vec![y],
        noise: noise * y.norm(),
    }
}

/// What is said of the series of an oscillator with the dashpot `c` and the `hidden` effect, whose model states a stiffness
/// 1 % and a dashpot a sixth too small.
fn diagnosed(hidden: &[Source], c: f64, random: &mut Random) -> Diagnosis {
    let k = MASS * (std::f64::consts::TAU * FREQUENCY).powi(2);
    let sources: Vec<Source> = std::iter::once(viscous(c)).chain(hidden.iter().cloned()).collect();
    let mut runs = Vec::new();
    for (level, force) in FORCES.into_iter().enumerate() {
        let seat = RESEATED * random.normal();
        for line in 0..LINES {
            let omega = std::f64::consts::TAU * FREQUENCY * (0.985 + 0.03 * line as f64 / (LINES - 1) as f64);
            let own = k * (1.0 + seat + SETTLES * random.normal());
            let model = ForwardModel::new(&oscillator(MASS, own), &sources).unwrap();
            let excitation = Excitation::sine(omega, 0, c64::new(force, 0.0));
            let response = model.respond(&excitation, &Settings::default(), None, &Control::unattended()).unwrap();
            let read = c64::new(1.0 + NOISE * random.normal(), NOISE * random.normal());
            let channels = vec![
                channel(Quantity::Force, c64::new(force, 0.0), 1e-3),
                channel(Quantity::Displacement, response.amplitude(0, 1) * read, NOISE),
            ];
            let fit = HarmonicFit { omega, omega_deviation: 0.0, channels };
            let run = Run::from_harmonics(format!("{level} {line}"), None, true, fit, &[]);
            runs.push(Run { level: Some(level as i64), ..run });
        }
    }
    let (stated, known) = (oscillator(MASS, 0.99 * k), [viscous(c / 1.2)]);
    let problem = Problem { structure: &stated, sources: &known, runs: &runs };
    let diagnosis = diagnose(&problem, &Control::unattended()).unwrap();
    let searched = diagnosis.runs.len();
    assert!((36..=40).contains(&searched), "{searched}");
    diagnosis
}

#[test]
fn a_joint_that_reseats_is_no_missing_effect() {
    let diagnosis = diagnosed(&[], 8.0, &mut Random::new(3));
    assert_eq!(diagnosis.verdict, Verdict::Detuned, "{:?}", diagnosis.suggestions);
    assert!(diagnosis.error_before > 0.1, "{}", diagnosis.error_before);
}

#[test]
fn drag_is_found_though_every_level_has_a_stiffness_of_its_own() {
    let drag = Source::known(Effect::Quadratic, Place::Dofs(vec![0]), &[60.0]);
    let diagnosis = diagnosed(std::slice::from_ref(&drag), 8.0, &mut Random::new(4));
    assert_eq!(diagnosis.verdict, Verdict::Missing);
    let first = &diagnosis.suggestions[0];
    assert_eq!(first.added.source.effect, Effect::Quadratic);
    let (value, deviation) = (first.added.source.parameters[0], first.added.deviations[0]);
    assert!((value - 60.0).abs() < 3.0 * deviation, "{value} +- {deviation}");
    assert!(deviation < 6.0, "{deviation}");
}
