//! Quality of a record: what an engineer should know before trusting it.

use serde::{Deserialize, Serialize};

/// What can be wrong with a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Flag {
    /// A transient has not died out: the energy balance does not hold.
    NotSettled,
    /// The noise is large beside the signal.
    Noisy,
    /// A channel has hit its range.
    Clipped,
    /// Samples are missing or repeated.
    MissingSamples,
    /// A channel shows nothing.
    DeadChannel,
    /// The frequency does not fit the record.
    WrongFrequency,
    /// A phase error of a degree would change the energy by several per cent.
    PhaseSensitive,
}

/// A flag with its reason in words and numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// What is wrong.
    pub flag: Flag,
    /// Why, in one sentence with numbers and units.
    pub reason: String,
}
