//! What a group of a tree hands to those below it, and notes on its sets.

use super::names::{self, Sampling};
use super::{Entry, Node};
use crate::contents::Set;
use crate::error::one_line;
use crate::note::Note;

/// Most notes that are kept of a group.
const MOST_NOTES: usize = 40;

/// What a group hands to those below it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Context {
    pub step: Option<f64>,
    pub start: f64,
}

impl Context {
    /// With what the scalars and attributes of a group say.
    pub(super) fn within(mut self, entries: &[Entry], attributes: &[(String, String)]) -> Self {
        let scalars = entries.iter().filter_map(|entry| match &entry.node {
            Node::Array(array) => Some((entry.name.as_str(), array.scalar()?)),
            _ => None,
        });
        let words = attributes.iter().filter_map(|(name, value)| Some((name.as_str(), value.parse().ok()?)));
        for (name, value) in words.chain(scalars) {
            self.take(names::sampling(name, value));
        }
        self
    }

    pub(super) fn take(&mut self, sampling: Option<Sampling>) {
        match sampling {
            Some(Sampling::Step(step)) => self.step = Some(step),
            Some(Sampling::Start(start)) => self.start = start,
            None => {}
        }
    }
}

/// A note on a set, of which only so many are kept.
pub(super) fn note(set: &mut Set, note: impl Into<Note>) {
    if set.notes.len() < MOST_NOTES {
        let note = note.into();
        set.notes.push(Note { text: one_line(&note.text, 160), ..note });
    }
}
