//! Harmonics fitted to a record by linear least squares, with their covariance.

use super::Channel;
use faer::{Mat, c64};

/// The harmonics of one channel: `y(t) = offset + slope (t - t_mid) + Re sum_h Y_h exp(i h omega t)`, SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelFit {
    /// The channel.
    pub channel: Channel,
    /// Offset in the middle of the record.
    pub offset: f64,
    /// Slope, per second.
    pub slope: f64,
    /// Complex amplitudes `Y_h` of harmonics 1..H of the recorded quantity (not integrated).
    pub amplitudes: Vec<c64>,
    /// Covariance of `(Re Y_1, Im Y_1, Re Y_2, Im Y_2, ...)`, 2H x 2H.
    pub covariance: Mat<f64>,
    /// Standard deviation of the noise of one sample.
    pub noise: f64,
}

impl ChannelFit {
    /// Standard deviation of the complex amplitude of harmonic `h` (1-based): root of the mean of both variances.
    pub fn deviation(&self, h: usize) -> f64 {
        let i = 2 * (h - 1);
        (0.5 * (self.covariance[(i, i)] + self.covariance[(i + 1, i + 1)])).sqrt()
    }

    /// Whether the deviations are known: false for harmonics that came from a file without them.
    pub fn has_deviation(&self) -> bool {
        (0..self.covariance.nrows()).any(|i| self.covariance[(i, i)] > 0.0)
    }
}

/// The harmonics of all channels of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct HarmonicFit {
    /// Fundamental circular frequency, rad/s.
    pub omega: f64,
    /// Standard deviation of `omega` where it was estimated from the record, else 0.
    pub omega_deviation: f64,
    /// Channels; force channels included.
    pub channels: Vec<ChannelFit>,
}

impl HarmonicFit {
    /// Number of harmonics fitted, H.
    pub fn harmonics(&self) -> usize {
        self.channels.first().map_or(0, |c| c.amplitudes.len())
    }

    /// Period, s.
    pub fn period(&self) -> f64 {
        std::f64::consts::TAU / self.omega
    }
}
