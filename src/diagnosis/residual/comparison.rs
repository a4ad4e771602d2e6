//! Runs, channels and harmonics of a comparison of the model with the measurement.

use crate::diagnosis::residual::branch::Branch;
use faer::c64;

/// One harmonic of a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HarmonicComparison {
    /// Order, from 1.
    pub harmonic: usize,
    /// Measured complex amplitude `a - i b` of `a cos + b sin`, SI units.
    pub measured: c64,
    /// That of the model.
    pub model: c64,
    /// Standard deviation of a real part of their difference, were the model exact.
    pub deviation: f64,
}

/// One channel of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelComparison {
    /// Name, such as `acc@7`.
    pub channel: String,
    /// Row of its DOF.
    pub dof: usize,
    /// Relative error.
    pub error: f64,
    /// What it would be were the model exact.
    pub noise_floor: f64,
    /// What errors are measured by, SI units.
    pub scale: f64,
    /// Harmonics.
    pub harmonics: Vec<HarmonicComparison>,
}

/// One run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunComparison {
    /// Index in the project's runs.
    pub index: usize,
    /// Whether it takes part in the error.
    pub used: bool,
    /// Root mean square over the channels; that of the energy where there is no response to predict.
    pub error: f64,
    /// What the error would be were the model exact.
    pub noise_floor: f64,
    /// Which of several periodic motions the model was taken to be on; none where there is only one.
    pub branch: Option<Branch>,
    /// `|input - taken out by known sources| / |input|` at the measured motion.
    pub energy_error: f64,
    /// Channels; none for `points`.
    pub channels: Vec<ChannelComparison>,
}
