//! What can be wrong with a record, and why.

use super::channel::Channel;
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
    /// What is recorded is no periodic motion of this frequency: a free decay, noise, other sines.
    NotPeriodic,
    /// The record looks like a run of another kind.
    OtherKind,
    /// There is no quiet part before the force sets in.
    NoPreTrigger,
    /// The hammer has struck more than once.
    DoubleHit,
    /// The part ends long before the decay does.
    CutDecay,
    /// There is motion beyond what the sampling can show.
    OutOfBand,
    /// The part is too short to tell two close modes apart.
    TooShort,
    /// The mean of a channel wanders, so that its integral drifts.
    Drift,
    /// An exponential window was laid over the record.
    ExponentialWindow,
    /// The steps are uneven; the record was taken onto even ones.
    UnevenSteps,
    /// The record of a decay begins before its release; it is used from there on.
    BeforeRelease,
    /// A channel does not show zero where nothing acts.
    Offset,
}

impl Flag {
    /// All of them.
    pub const ALL: [Self; 19] = [
        Self::NotSettled,
        Self::Noisy,
        Self::Clipped,
        Self::MissingSamples,
        Self::DeadChannel,
        Self::WrongFrequency,
        Self::PhaseSensitive,
        Self::NotPeriodic,
        Self::OtherKind,
        Self::NoPreTrigger,
        Self::DoubleHit,
        Self::CutDecay,
        Self::OutOfBand,
        Self::TooShort,
        Self::Drift,
        Self::ExponentialWindow,
        Self::UnevenSteps,
        Self::BeforeRelease,
        Self::Offset,
    ];
}

/// A flag with its reason in words and numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What is wrong.
    pub flag: Flag,
    /// The channel that is at fault; `None` where it is the record or the motion.
    pub channel: Option<Channel>,
    /// Why, in one sentence with numbers and units.
    pub reason: String,
    /// How much of the signal it is, relative, where that is known.
    pub share: Option<f64>,
}

impl Finding {
    /// A finding about the record or the motion as a whole.
    pub fn of_record(flag: Flag, reason: String) -> Self {
        Self { flag, channel: None, reason, share: None }
    }

    /// The same with how much of the signal it is, relative.
    #[must_use]
    pub(super) fn of_share(self, share: f64) -> Self {
        Self { share: Some(share), ..self }
    }

    /// A finding about one channel.
    pub fn of_channel(flag: Flag, channel: &Channel, reason: String) -> Self {
        Self { flag, channel: Some(channel.clone()), reason, share: None }
    }
}
