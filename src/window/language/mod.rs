//! The language of the window. The English text in the code is the key of a catalogue (`assets/locales`), as with gettext: a view
//! reads as it is shown, and what has no translation is shown in English.
//!
//! Three ways lead here: `t!("Measure")` for a literal, `tf!("Run {run}")` for what would be a `format!`, and `tr` for text that is
//! made below the window (names of laws, sentences of the diagnosis, axes of plots). All floors below say English; the window
//! finds the template of a finished sentence again and puts its parts into the other language. Files, tables that are copied and the
//! command line never come here.

mod catalogue;
mod chosen;
pub(crate) mod numbers;
mod sentence;
mod template;

pub use chosen::{Language, choose, now};
pub(crate) use sentence::{tr, word, word_as};

/// A literal of the window in its language.
macro_rules! t {
    ($english:literal) => {
        $crate::window::language::word($english)
    };
    // A word that is another one elsewhere, by what it is here: its key is `Force [button]`.
    ($english:literal, $here:literal) => {
        $crate::window::language::word_as($english, concat!($english, " [", $here, "]"))
    };
}

/// A formatted text of the window in its language.
macro_rules! tf {
    ($($english:tt)*) => {
        $crate::window::language::tr(&format!($($english)*))
    };
}

pub(crate) use {t, tf};
