//! A time record in SI units that holds only finite numbers at increasing times.

use super::Channel;

/// A time record: `samples[channel][n]` at `time[n]`.
///
/// Its constructor refuses NaN, unequal lengths, times that do not increase, two channels of the same name.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    pub(crate) time: Vec<f64>,
    pub(crate) channels: Vec<Channel>,
    pub(crate) samples: Vec<Vec<f64>>,
}

impl Record {
    /// Times, s.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// Channels in the order of the file.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Samples of channel number `channel` in SI units.
    pub fn samples(&self, channel: usize) -> &[f64] {
        &self.samples[channel]
    }
}
