//! Records with known harmonics.

use dashpot::measurement::{Channel, Quantity, Record};
use faer::c64;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;

/// A channel of known harmonics, noise and anything else.
pub(crate) struct Signal {
    pub quantity: Quantity,
    pub dof: usize,
    pub amplitudes: Vec<c64>,
    pub noise: f64,
}

impl Signal {
    pub(crate) fn new(quantity: Quantity, dof: usize, amplitudes: &[c64], noise: f64) -> Self {
        Self { quantity, dof, amplitudes: amplitudes.to_vec(), noise }
    }

    pub(crate) fn value(&self, omega: f64, t: f64) -> f64 {
        let harmonics = self.amplitudes.iter().enumerate();
        harmonics.map(|(h, y)| (y * c64::new(0.0, (h + 1) as f64 * omega * t).exp()).re).sum()
    }
}

pub(crate) fn z(re: f64, im: f64) -> c64 {
    c64::new(re, im)
}

pub(crate) fn rng(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

pub(crate) fn normal(rng: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(rng)
}

pub(crate) fn even(samples: usize, rate_hz: f64) -> Vec<f64> {
    (0..samples).map(|n| n as f64 / rate_hz).collect()
}

/// A record of the signals with white noise.
pub(crate) fn record(signals: &[Signal], frequency_hz: f64, time: Vec<f64>, seed: u64) -> Record {
    changed(signals, frequency_hz, time, seed, |_, _, y| y)
}

/// A record whose samples are changed by `(channel, time, value)` before it is made.
pub(crate) fn changed(
    signals: &[Signal],
    frequency_hz: f64,
    time: Vec<f64>,
    seed: u64,
    change: impl Fn(usize, f64, f64) -> f64,
) -> Record {
    let mut rng = rng(seed);
    let samples = signals
        .iter()
        .enumerate()
        .map(|(c, signal)| {
            let value = |t: &f64| signal.value(TAU * frequency_hz, *t) + signal.noise * normal(&mut rng);
            time.iter().map(value).zip(&time).map(|(y, t)| change(c, *t, y)).collect()
        })
        .collect();
    let channels = signals
        .iter()
        .map(|signal| Channel { quantity: signal.quantity, dof: signal.dof, label: (signal.dof + 1).to_string() })
        .collect();
    Record::new(time, channels, samples).unwrap()
}

/// A force and two accelerations near the resonance of a lightly damped beam, each with 5 % of noise.
pub(crate) fn beam(noise: f64) -> Vec<Signal> {
    let response = z(40.0, -3.0);
    vec![
        Signal::new(Quantity::Force, 0, &[z(1.0, 0.1), z(0.0, 0.01)], noise * 0.71),
        Signal::new(Quantity::Acceleration, 0, &[z(0.0, 1.0) * response, z(0.1, 0.2)], noise * 28.4),
        Signal::new(Quantity::Acceleration, 2, &[z(0.0, -0.6) * response, z(0.2, 0.1)], noise * 17.0),
    ]
}
