//! The order of the suggestions, without what the user has ruled out.

use super::look::Look;
use crate::diagnosis::candidates::special_cases::is_allowed;
use crate::diagnosis::result::Suggestion;
use crate::window::document::Document;
use crate::window::explained::{Explained, Standing};

/// Suggestions that are not ruled out, with probabilities that add up to what they did before, and how far they may be
/// trusted.
pub(super) fn ranked<'a>(document: &Document, explained: &'a Explained) -> (Vec<(&'a Suggestion, f64)>, Standing) {
    let (all, standing) = explained.suggestions(document);
    let ruled_out = document.session().document().ruled_out();
    let allowed = |s: &&Suggestion| is_allowed(ruled_out, &s.added.source, &s.added.deviations);
    let left: Vec<&Suggestion> = all.iter().filter(allowed).collect();
    let total: f64 = all.iter().map(|s| s.probability).sum();
    let kept: f64 = left.iter().map(|s| s.probability).sum();
    let factor = if kept > 0.0 && left.len() < all.len() { total / kept } else { 1.0 };
    (left.into_iter().map(|s| (s, (s.probability * factor).min(1.0))).collect(), standing)
}

/// The suggestion whose card is open, and how far it may be trusted.
pub(super) fn open<'a>(
    document: &Document,
    explained: &'a Explained,
    look: &Look,
) -> Option<(&'a Suggestion, Standing)> {
    let (list, standing) = ranked(document, explained);
    let wanted = look.open.as_ref().and_then(|source| list.iter().find(|(s, _)| s.added.source.is_same(source)));
    wanted.or(list.first()).map(|(s, _)| (*s, standing))
}
