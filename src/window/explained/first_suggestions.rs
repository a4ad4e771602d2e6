//! What a search tells before it has ended.

use super::model::Search;
use crate::diagnosis::result::Suggestion;
use crate::window::app::repaint::RepaintHandle;
use egui::Context;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Where a search on its own thread leaves what it has found so far.
#[derive(Debug, Clone)]
pub(crate) struct Mailbox {
    latest: Arc<Mutex<Option<Vec<Suggestion>>>>,
    repaint: RepaintHandle,
}

impl Mailbox {
    fn latest(&self) -> MutexGuard<'_, Option<Vec<Suggestion>>> {
        self.latest.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Leaves suggestions, in place of those that nobody has fetched yet, and asks for a frame.
    pub(crate) fn put(&self, found: &[Suggestion]) {
        *self.latest() = Some(found.to_vec());
        self.repaint.request();
    }
}

/// The provisional suggestions of the last search that was started.
#[derive(Debug, Default)]
pub(crate) struct FirstSuggestions {
    search: Option<(Search, Mailbox)>,
    found: Vec<Suggestion>,
}

impl FirstSuggestions {
    /// A mailbox for a new search; what an earlier one told is forgotten.
    pub(crate) fn expect(&mut self, ctx: &Context, search: &Search) -> Mailbox {
        let mailbox = Mailbox { latest: Arc::default(), repaint: RepaintHandle::of(ctx) };
        self.search = Some((search.clone(), mailbox.clone()));
        self.found.clear();
        mailbox
    }

    /// Fetches what was told since the last look.
    pub(crate) fn collect(&mut self) {
        let told = self.search.as_ref().and_then(|(_, mailbox)| mailbox.latest().take());
        self.found = told.unwrap_or_else(|| std::mem::take(&mut self.found));
    }

    /// What `search` has told; nothing for another one.
    pub(crate) fn of(&self, search: &Search) -> &[Suggestion] {
        if self.search.as_ref().is_some_and(|(of, _)| of == search) { &self.found } else { &[] }
    }
}
