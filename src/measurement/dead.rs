//! Channels that show nothing at all: a cable that is off, a range that was never switched on.

use super::fit::ChannelFit;
use super::record::Record;

/// Whether a channel has one value all through its record.
pub(super) fn stands_still(channel: &ChannelFit, record: Option<&Record>) -> bool {
    let samples = record.and_then(|record| {
        let row = record.channels().iter().position(|own| *own == channel.channel)?;
        Some(record.samples(row))
    });
    samples.is_some_and(|samples| samples.windows(2).all(|pair| pair[0] == pair[1]))
}

/// Whether a channel stands still, or has harmonics of exactly zero.
pub(super) fn is_silent(channel: &ChannelFit, record: Option<&Record>) -> bool {
    channel.amplitudes.iter().all(|y| y.re == 0.0 && y.im == 0.0) || stands_still(channel, record)
}
