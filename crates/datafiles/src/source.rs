//! Where the values of a file come from: each format reads them in its own way.

use crate::error::{Fault, Read};
use uff::Values;

/// Most values of one channel that are read into memory: 4 GiB of real numbers.
pub(crate) const MOST_VALUES: u64 = 1 << 29;

/// Reads what [`crate::Contents`] lists; indices were checked.
pub(crate) trait Source: Send + Sync {
    /// Values of a channel.
    fn read(&self, set: usize, channel: usize) -> Read<Values>;

    /// Values of several channels of a set, in one pass over the file; none where channel by channel is as good.
    fn together(&self, _set: usize, _channels: &[usize]) -> Option<Read<Vec<Values>>> {
        None
    }

    /// Abscissa of a channel whose axis is [`crate::Axis::Stored`].
    fn axis(&self, _set: usize, _channel: usize) -> Read<Vec<f64>> {
        Err(Fault::new("the abscissa is not stored"))
    }
}
