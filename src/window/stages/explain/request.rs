//! What may be asked for in the stage Explain.

use crate::effects::Source;

/// What may be asked for in the stage.
#[derive(Debug, Clone, PartialEq)]
pub enum Request {
    /// Preview an effect.
    Try(Source),
    /// End the preview.
    Stop,
    /// Put an effect into the model.
    Add(Source),
    /// Rule an effect out at its place.
    Exclude(Source),
    /// Take that back.
    Restore(Source),
    /// Go to a step of the ledger.
    Return(usize),
    /// Put what was identified into the model.
    TakeOver,
    /// Put the corrections that the search found into the model.
    Correct,
    /// Put one of them, by its place in the list, into the model.
    CorrectOne(usize),
    /// State that a channel reads too large by a share, or is recorded late by a time in s.
    CorrectSensor {
        /// Name of the channel, such as `acc@7`.
        channel: String,
        /// Share by which it reads too large.
        gain: f64,
        /// Time by which it is late, s.
        delay: f64,
    },
    /// Mend a channel that was found to read wrongly, by its place in the list, in its mapping.
    Mend(usize),
    /// Leave out a run that does not fit the others, by its place in the list.
    LeaveOut(usize),
    /// Start it again.
    Retry,
    /// End the search with the best so far.
    Hurry,
    /// End searches with the best so far after a time in s, or let them come to their end.
    Limit(Option<f64>),
    /// Search to the end, without a limit.
    SearchOn,
    /// Search though the model is far from the data.
    Search,
}
