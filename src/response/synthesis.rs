//! From harmonics to a time record, as a data recorder would have written it:
//! `y(t) = mean + Re sum_h Y_h exp(i h omega t) + noise`.

use crate::measurement::{Channel, Record, record::RecordError};
use faer::c64;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use std::f64::consts::TAU;

/// What one channel shows in steady state, in SI units of its quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelMotion {
    /// The channel.
    pub channel: Channel,
    /// Static offset.
    pub mean: f64,
    /// Complex amplitudes of harmonics 1, 2, ... of the recorded quantity.
    pub amplitudes: Vec<c64>,
}

/// White noise, its standard deviation relative to the root mean square of the channel's own signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Standard deviation over root mean square, such as 0.05.
    pub ratio: f64,
    /// Seed; the same seed and stream give the same noise on every machine.
    pub seed: u64,
    /// Stream, one for each run.
    pub stream: u64,
}

/// `samples` equal steps over `periods` fundamental periods of `omega` (rad/s), from 0 and without the last point.
pub fn sampling_times(omega: f64, periods: f64, samples: usize) -> Vec<f64> {
    let step = periods * TAU / omega / samples as f64;
    (0..samples).map(|n| n as f64 * step).collect()
}

/// Samples the channels at `time` (s) and adds the noise.
///
/// # Errors
/// Whatever [`Record::new`] refuses: no channel, times that do not increase, numbers that are not finite.
pub fn synthesise(
    omega: f64,
    time: &[f64],
    motions: &[ChannelMotion],
    noise: Option<Noise>,
) -> Result<Record, RecordError> {
    let samples = signals(omega, time, motions);
    let channels = motions.iter().map(|motion| motion.channel.clone()).collect();
    record(time, channels, samples, noise)
}

/// A record of given samples (SI units, one list a channel) at `time` (s), with the noise added.
///
/// # Errors
/// As [`synthesise`].
pub fn record(
    time: &[f64],
    channels: Vec<Channel>,
    mut samples: Vec<Vec<f64>>,
    noise: Option<Noise>,
) -> Result<Record, RecordError> {
    if let Some(noise) = noise {
        contaminate(&mut samples, noise);
    }
    Record::new(time.to_vec(), channels, samples)
}

/// The channels at `time` (s) without noise, one list a channel.
pub fn signals(omega: f64, time: &[f64], motions: &[ChannelMotion]) -> Vec<Vec<f64>> {
    motions.iter().map(|motion| signal(omega, time, motion)).collect()
}

fn signal(omega: f64, time: &[f64], motion: &ChannelMotion) -> Vec<f64> {
    let value_at = |t: f64| {
        motion.amplitudes.iter().enumerate().fold(motion.mean, |sum, (index, y)| {
            let (sin, cos) = ((index + 1) as f64 * omega * t).sin_cos();
            sum + y.re * cos - y.im * sin
        })
    };
    time.iter().map(|&t| value_at(t)).collect()
}

fn contaminate(samples: &mut [Vec<f64>], noise: Noise) {
    let mut generator = ChaCha8Rng::seed_from_u64(noise.seed);
    generator.set_stream(noise.stream);
    for signal in samples {
        let mean_square = signal.iter().map(|y| y * y).sum::<f64>() / signal.len() as f64;
        // A deviation of zero or NaN cannot reach here from finite signals; a zero one draws zeros.
        let Ok(normal) = Normal::new(0.0, noise.ratio * mean_square.sqrt()) else { continue };
        for y in signal.iter_mut() {
            *y += normal.sample(&mut generator);
        }
    }
}
