//! Forces of tests that are not steady, and how a structure is released.
//!
//! ```text
//! impulse     u = peak sin(pi t / width),  0 < t < width:  its spectrum ends at about 1.5 / width
//! sweep       u = force sin(phase),  phase' = 2 pi f(t),  f linear, or growing by the same ratio in the same time
//! random      lines of equal amplitude and random phase and size between two frequencies (Gaussian), no two periods alike
//! cycles      d = amplitude r(t) sin(2 pi f t): a displacement imposed on a component, r rising and falling over a ramp
//! base        the acceleration of a base as a file has it ([`super::base::BaseMotion`])
//! multisine   lines of equal amplitude and random phase; odd: every second one only, so that even distortion shows between
//! ```
//!
//! Sources: Ewins, *Modal Testing* (2000), chapter 3; Pintelon and Schoukens, *System Identification* (2012), chapter 5.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// What drives the structure at one DOF.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Loading {
    /// A hammer: half a sine, perhaps twice.
    Impulse {
        /// Greatest force, N.
        peak_n: f64,
        /// Duration of the contact, s.
        width_s: f64,
        /// Start of the contact, s.
        at_s: f64,
        /// Start of a second contact of half the force, s.
        #[serde(skip_serializing_if = "Option::is_none")]
        again_s: Option<f64>,
    },
    /// A swept sine over the whole record.
    Sweep {
        /// Amplitude, N.
        force_n: f64,
        /// First frequency, Hz.
        from_hz: f64,
        /// Last frequency, Hz.
        to_hz: f64,
        /// Whether equal ratios take equal times.
        logarithmic: bool,
    },
    /// Gaussian noise in a band.
    Random {
        /// Root mean square, N.
        rms_n: f64,
        /// Lower end of the band, Hz.
        from_hz: f64,
        /// Upper end of the band, Hz.
        to_hz: f64,
        /// Seed.
        seed: u64,
    },
    /// A periodic signal of many lines, its period the record's.
    Multisine {
        /// Root mean square, N.
        rms_n: f64,
        /// Lower end of the band, Hz.
        from_hz: f64,
        /// Upper end of the band, Hz.
        to_hz: f64,
        /// Whether even lines are left out.
        odd: bool,
        /// Seed.
        seed: u64,
    },
    /// Let go at time zero from rest: from the shape under a static force at the DOF, or from a mode.
    Release {
        /// Displacement of the DOF, m.
        displacement_m: f64,
        /// Number of the mode, from 1; the static shape without it.
        #[serde(skip_serializing_if = "Option::is_none")]
        mode: Option<usize>,
    },
    /// The displacement of a component in a testing machine.
    Cycles {
        /// Amplitude, m.
        amplitude_m: f64,
        /// Frequency, Hz.
        frequency_hz: f64,
        /// Time over which the amplitude is run up, and down again at the end, s.
        ramp_s: f64,
    },
    /// A motion of the base that comes from a file.
    Base,
}

impl Loading {
    /// Words in files.
    pub const KINDS: [&str; 7] = ["impulse", "sweep", "random", "multisine", "release", "cycles", "base"];

    /// Force (N) at `samples` instants `step` s apart; none for a release, a displacement that is imposed and a moving base.
    pub fn force(&self, samples: usize, step: f64) -> Option<Vec<f64>> {
        let duration = samples as f64 * step;
        let time = (0..samples).map(|n| n as f64 * step);
        Some(match *self {
            Self::Impulse { peak_n, width_s, at_s, again_s } => {
                let hit = |t: f64, start: f64| {
                    let x = (t - start) / width_s;
                    if x > 0.0 && x < 1.0 { peak_n * (PI * x).sin() } else { 0.0 }
                };
                time.map(|t| hit(t, at_s) + again_s.map_or(0.0, |again| 0.5 * hit(t, again))).collect()
            }
            Self::Sweep { force_n, from_hz, to_hz, logarithmic } => {
                time.map(|t| force_n * phase(t, duration, from_hz, to_hz, logarithmic).sin()).collect()
            }
            Self::Random { rms_n, from_hz, to_hz, seed } => {
                lines(&Lines { rms_n, band: [from_hz, to_hz], gaussian: true, odd: false, seed }, samples, step)
            }
            Self::Multisine { rms_n, from_hz, to_hz, odd, seed } => {
                lines(&Lines { rms_n, band: [from_hz, to_hz], gaussian: false, odd, seed }, samples, step)
            }
            Self::Release { .. } | Self::Cycles { .. } | Self::Base => return None,
        })
    }

    /// Displacement (m), velocity and acceleration that are imposed at `time` s of a record of `duration` s; none unless the
    /// loading is [`Loading::Cycles`]. The ramps are half cosines, so that no velocity jumps.
    pub fn imposed(&self, time: f64, duration: f64) -> Option<[f64; 3]> {
        let Self::Cycles { amplitude_m, frequency_hz, ramp_s } = *self else { return None };
        let omega = TAU * frequency_hz;
        let edge = time.min(duration - time);
        let side = if time <= duration - time { 1.0 } else { -1.0 };
        let [r, dr, ddr] = if ramp_s > 0.0 && edge < ramp_s {
            let (x, rate) = (PI * edge / ramp_s, PI / ramp_s);
            [0.5 - 0.5 * x.cos(), side * 0.5 * rate * x.sin(), 0.5 * rate * rate * x.cos()]
        } else {
            [1.0, 0.0, 0.0]
        };
        let (sin, cos) = (omega * time).sin_cos();
        let velocity = dr * sin + r * omega * cos;
        let acceleration = ddr * sin + 2.0 * dr * omega * cos - r * omega * omega * sin;
        Some([r * sin, velocity, acceleration].map(|x| amplitude_m * x))
    }
}

/// Phase of a sweep, rad.
fn phase(t: f64, duration: f64, from: f64, to: f64, logarithmic: bool) -> f64 {
    if logarithmic && from != to {
        let rate = (to / from).ln() / duration;
        return TAU * from * (rate * t).exp_m1() / rate;
    }
    TAU * (from * t + 0.5 * (to - from) * t * t / duration)
}

struct Lines {
    rms_n: f64,
    band: [f64; 2],
    gaussian: bool,
    odd: bool,
    seed: u64,
}

/// A sum of lines at multiples of the record's inverse duration.
fn lines(of: &Lines, samples: usize, step: f64) -> Vec<f64> {
    let mut generator = ChaCha8Rng::seed_from_u64(of.seed);
    let resolution = 1.0 / (samples as f64 * step);
    let first = ((of.band[0] / resolution).ceil() as usize).max(1);
    let last = ((of.band[1] / resolution).floor() as usize).min(samples.saturating_sub(1) / 2);
    let mut spectrum = vec![faer::c64::new(0.0, 0.0); samples / 2 + 1];
    for (k, line) in spectrum.iter_mut().enumerate().take(last + 1).skip(first) {
        if of.odd && k % 2 == 0 {
            continue;
        }
        *line = if of.gaussian {
            let [re, im]: [f64; 2] = [StandardNormal.sample(&mut generator), StandardNormal.sample(&mut generator)];
            faer::c64::new(re, im)
        } else {
            let angle: f64 = generator.random_range(0.0..TAU);
            faer::c64::new(angle.cos(), angle.sin())
        };
    }
    let mut signal = vec![0.0; samples];
    dashpot_numerics::RealTransform::new(samples).backward(&mut spectrum, &mut signal);
    let rms = (signal.iter().map(|u| u * u).sum::<f64>() / samples as f64).sqrt();
    if rms > 0.0 {
        signal.iter_mut().for_each(|u| *u *= of.rms_n / rms);
    }
    signal
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::math::spectrum::Spectrum;

    #[test]
    fn an_impulse_carries_the_momentum_of_half_a_sine() {
        let [peak_n, width_s] = [200.0, 0.004];
        let hammer = Loading::Impulse { peak_n, width_s, at_s: 0.01, again_s: Some(0.03) };
        let force = hammer.force(100_000, 1e-6).unwrap();
        let momentum = 1e-6 * force.iter().sum::<f64>();
        assert!((momentum - 1.5 * 2.0 / PI * peak_n * width_s).abs() < 1e-6 * momentum);
    }

    #[test]
    fn a_sweep_passes_its_frequencies_at_their_times() {
        for (logarithmic, at, hz) in [(false, 0.5, 30.0), (true, 0.5, 500f64.sqrt())] {
            let rate = |t: f64| {
                (phase(t + 1e-6, 1.0, 10.0, 50.0, logarithmic) - phase(t, 1.0, 10.0, 50.0, logarithmic)) / 1e-6
            };
            assert!((rate(at) / TAU - hz).abs() < 1e-3 * hz, "{logarithmic}");
        }
    }

    #[test]
    fn noise_and_multisines_stay_in_their_band_and_size() {
        let random = Loading::Random { rms_n: 3.0, from_hz: 20.0, to_hz: 60.0, seed: 4 }.force(4096, 1e-3).unwrap();
        let odd = Loading::Multisine { rms_n: 3.0, from_hz: 20.0, to_hz: 60.0, odd: true, seed: 4 };
        for signal in [random, odd.force(4096, 1e-3).unwrap()] {
            let rms = (signal.iter().map(|u| u * u).sum::<f64>() / 4096.0).sqrt();
            assert!((rms - 3.0).abs() < 1e-9);
            let spectrum = Spectrum::new(&signal, 1e-3).unwrap();
            let outside = |k: &usize| !(19.0..=61.0).contains(&spectrum.frequency_hz(*k));
            let most = (0..spectrum.amplitude.len()).filter(outside).map(|k| spectrum.amplitude[k]).fold(0.0, f64::max);
            assert!(most < 1e-9, "{most}");
        }
    }
}
