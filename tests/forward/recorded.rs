//! Records made by time integration against those of harmonic balance and against closed forms.

use super::support::{balanced, five_masses, source, whole};
use crate::common::models::oscillator;
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::measurement::{Channel, Quantity};
use dashpot::response::harmonic_balance::{Excitation, Settings};
use dashpot::response::simulation::{SimulationError, SteadyState, recorded};
use dashpot::response::simulation_in_time::{InTime, Recorder, record_in_time};
use dashpot::response::synthesis::{sampling_times, synthesise};
use dashpot::structure::Structure;
use faer::c64;
use std::f64::consts::TAU;

fn channel(quantity: Quantity, dof: usize) -> Channel {
    Channel { quantity, dof, label: (dof + 1).to_string() }
}

fn sensor(effect: Effect, channel: &Channel, value: f64) -> Source {
    Source::known(effect, Place::Channel(channel.to_string()), &[value])
}

fn integrated(
    structure: &Structure,
    sources: &[Source],
    excitation: &Excitation,
    recorder: &Recorder,
    transient: f64,
) -> Result<Vec<Vec<f64>>, SimulationError> {
    let in_time = InTime { transient, ..InTime::default() };
    record_in_time(structure, sources, excitation, recorder, &in_time, &Control::unattended())
}

fn size(samples: &[f64]) -> f64 {
    samples.iter().fold(0.0, |m, y| m.max(y.abs()))
}

/// Delay, gain, every quantity, a force with a harmonic of its own, samples beside the steps.
#[test]
fn both_ways_record_the_same() {
    let structure = five_masses();
    let sources = [
        whole(Effect::MassProportional, 2.0),
        source(Effect::Quadratic, &[2], &[500.0]),
        source(Effect::ElasticSlider, &[3, 4], &[2e4, 3.0]),
    ];
    let mut excitation = Excitation::sine(TAU * 21.0, 4, c64::new(20.0, 0.0));
    excitation.forces[0].harmonics.push(c64::new(1.0, -2.0));
    let channels = [
        channel(Quantity::Force, 4),
        channel(Quantity::Acceleration, 4),
        channel(Quantity::Velocity, 2),
        channel(Quantity::Displacement, 0),
    ];
    let sensors = [
        sensor(Effect::Delay, &channels[0], 1e-3),
        sensor(Effect::Gain, &channels[1], 1.1),
        sensor(Effect::Delay, &channels[1], -5e-4),
        sensor(Effect::Delay, &channels[3], 2e-3),
    ];
    let time = sampling_times(excitation.omega, 3.0, 100);
    let response = balanced(&structure, &sources, &excitation, &Settings::default());
    let state = SteadyState { mean: response.mean, harmonics: response.harmonics };
    let motions = recorded(&state, &excitation, &channels, &sensors);
    let expected = synthesise(excitation.omega, &time, &motions, None).unwrap();
    let recorder = Recorder { channels: &channels, sensors: &sensors, time: &time };
    let found = integrated(&structure, &sources, &excitation, &recorder, 0.0).unwrap();
    for (c, (found, channel)) in found.iter().zip(&channels).enumerate() {
        let expected = expected.samples(c);
        let error = found.iter().zip(expected).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / size(expected);
        let bound = if channel.quantity == Quantity::Acceleration { 1e-2 } else { 2e-4 };
        assert!(error < bound, "{channel}: {error:.1e}");
    }
}

/// From rest under `f cos(w t)`: `x = X cos(w t - p) + exp(-z t) (A cos(wd t) + B sin(wd t))`.
#[test]
fn a_transient_from_rest_is_that_of_the_oscillator() {
    let structure = oscillator(2.0, 800.0);
    let (c, force, omega) = (2.0, 10.0, 17.0);
    let sources = [source(Effect::Viscous, &[0], &[c])];
    let excitation = Excitation::sine(omega, 0, c64::new(force, 0.0));
    let (z, wd) = (c / 4.0, (400.0_f64 - (c / 4.0_f64).powi(2)).sqrt());
    let x = c64::new(force, 0.0) / c64::new(800.0 - 2.0 * omega * omega, omega * c);
    let exact = |t: f64, fraction: f64| {
        // What is missing of the periodic state at the start decays.
        let (a, b) = (-fraction * x.re, (fraction * omega * x.im - fraction * z * x.re) / wd);
        let steady = x.re * (omega * t).cos() - x.im * (omega * t).sin();
        steady + (-z * t).exp() * (a * (wd * t).cos() + b * (wd * t).sin())
    };
    let channels = [channel(Quantity::Displacement, 0), channel(Quantity::Velocity, 0)];
    let time = sampling_times(omega, 12.0, 300);
    let recorder = Recorder { channels: &channels, sensors: &[], time: &time };
    for fraction in [1.0, 0.25] {
        let found = integrated(&structure, &sources, &excitation, &recorder, fraction).unwrap();
        for (t, y) in time.iter().zip(&found[0]) {
            assert!((y - exact(*t, fraction)).abs() < 1e-5 * x.norm(), "{fraction} at {t} s: {y}");
        }
    }
    let late = [sensor(Effect::Delay, &channels[0], 0.05)];
    let found = integrated(&structure, &sources, &excitation, &Recorder { sensors: &late, ..recorder }, 1.0).unwrap();
    for (t, y) in time.iter().zip(&found[0]) {
        assert!((y - exact((t - 0.05).max(0.0), 1.0)).abs() < 1e-5 * x.norm(), "late at {t} s: {y}");
    }
}

#[test]
fn laws_without_a_force_in_time_are_refused() {
    let channels = [channel(Quantity::Acceleration, 0)];
    let recorder = Recorder { channels: &channels, sensors: &[], time: &[0.0, 0.1] };
    let excitation = Excitation::sine(100.0, 4, c64::new(1.0, 0.0));
    let sources = [source(Effect::Hysteretic, &[0], &[100.0])];
    let refused = integrated(&five_masses(), &sources, &excitation, &recorder, 0.0).unwrap_err();
    assert!(refused.to_string().contains("simulate it by harmonic balance"), "{refused}");
}
