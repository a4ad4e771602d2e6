//! What kind of test a record shows, and which part of it is used.

use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Kind of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Steady state under a periodic force of one fundamental frequency.
    #[default]
    Steady,
    /// Free decay: no force acts in the part that is used; what happened before the release does not matter.
    Decay,
    /// Any other motion under a measured force: hammer, sweep, random, multisine.
    Transient,
}

impl Kind {
    /// Words in files, in the order of [`Kind::ALL`].
    pub const NAMES: [&str; 3] = ["steady", "decay", "transient"];
    /// Every kind.
    pub const ALL: [Self; 3] = [Self::Steady, Self::Decay, Self::Transient];

    /// Word in files.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }

    /// Whether it is the kind that a run has unless it says otherwise.
    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
    pub fn is_steady(&self) -> bool {
        *self == Self::Steady
    }
}

/// The part of a record that is used, in its own time; open at both ends unless they are given.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TimeSpan {
    /// First instant, s.
    pub start_s: Option<f64>,
    /// Last instant, s.
    pub end_s: Option<f64>,
}

impl TimeSpan {
    /// Numbers of the samples at `time` (s, rising) that lie in it; a hundredth of a step beside an end still does.
    pub fn samples(&self, time: &[f64]) -> Range<usize> {
        let step = if time.len() > 1 { (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64 } else { 0.0 };
        let slack = 0.01 * step;
        let first = self.start_s.map_or(0, |start| time.partition_point(|&t| t < start - slack));
        let last = self.end_s.map_or(time.len(), |end| time.partition_point(|&t| t <= end + slack));
        first..last.max(first)
    }

    /// Whether the whole record is used.
    pub fn is_whole(&self) -> bool {
        *self == Self::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_holds_the_samples_at_its_ends() {
        let time: Vec<f64> = (0..11).map(|n| 0.1 * f64::from(n)).collect();
        let part = |start_s, end_s| TimeSpan { start_s, end_s }.samples(&time);
        assert_eq!(part(None, None), 0..11);
        assert_eq!(part(Some(0.3), Some(0.7)), 3..8);
        assert_eq!(part(Some(0.31), None), 4..11);
        assert_eq!(part(Some(2.0), Some(1.0)), 11..11);
    }

    #[test]
    fn kinds_are_read_by_the_words_they_are_written_with() {
        assert!(Kind::ALL.into_iter().all(|kind| serde_json::json!(kind) == kind.name()));
    }
}
