//! What is not to be relied on and keeps any law from agreeing with the data: a channel, or a run.

use crate::diagnosis::channels::ChannelFault;

/// A part of the data that does not fit the rest.
#[derive(Debug, Clone)]
pub(crate) enum Unreliable {
    /// A channel whose readings scatter from run to run.
    Channel(ChannelFault),
    /// The run of this number of the project.
    Run(usize),
}
