//! How large the periodic part of each channel is, and what the channel is judged by.

use super::channel::Quantity;
use super::fit::{ChannelFit, HarmonicFit};

/// Smallest amplitude that a channel is judged by, as a share of the largest of its quantity in the run: a sensor at a
/// node must not rule.
pub(super) const NODE_SHARE: f64 = 1.0 / 20.0;

/// Root mean square of the periodic part of a channel.
pub(super) fn signal(channel: &ChannelFit) -> f64 {
    (0.5 * channel.amplitudes.iter().map(|y| y.re * y.re + y.im * y.im).sum::<f64>()).sqrt()
}

/// What each channel is judged by: its own signal, at least [`NODE_SHARE`] of the largest of its quantity.
pub(super) fn references(fit: &HarmonicFit) -> Vec<f64> {
    let largest = |quantity: Quantity| {
        let same = fit.channels.iter().filter(|c| c.channel.quantity == quantity);
        same.map(signal).fold(0.0, f64::max)
    };
    fit.channels.iter().map(|c| signal(c).max(NODE_SHARE * largest(c.channel.quantity))).collect()
}
