//! The languages that there are, and the one that was chosen.

use serde::{Deserialize, Serialize};
use std::cell::Cell;

/// A language of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub enum Language {
    /// That of the code.
    #[default]
    English,
    /// Translated by `assets/locales/de.toml`.
    German,
}

impl Language {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::English, Self::German];

    /// Its name in itself.
    pub fn name(self) -> &'static str {
        match self {
            Self::English => "English",
            Self::German => "Deutsch",
        }
    }

    /// The language of a locale such as `de_AT.UTF-8`; English where there is no catalogue for it.
    pub fn of_locale(locale: &str) -> Self {
        let primary = locale.split(['-', '_', '.', '@']).next().unwrap_or_default();
        if primary.eq_ignore_ascii_case("de") { Self::German } else { Self::English }
    }

    /// The language that the desktop asks for.
    pub fn of_system() -> Self {
        sys_locale::get_locale().map_or(Self::English, |locale| Self::of_locale(&locale))
    }
}

thread_local! {
    static NOW: Cell<Language> = const { Cell::new(Language::English) };
}

/// The language of this thread: that of the window in the thread that draws it, English in all others.
pub fn now() -> Language {
    NOW.get()
}

/// Chooses the language of this thread.
pub fn choose(language: Language) {
    NOW.set(language);
}

#[cfg(test)]
mod tests {
    use super::Language;

    #[test]
    fn locales_by_their_primary_language() {
        for locale in ["de", "de_AT.UTF-8", "de-CH", "DE@euro"] {
            assert_eq!(Language::of_locale(locale), Language::German, "{locale}");
        }
        for locale in ["en_GB.UTF-8", "C", "", "del"] {
            assert_eq!(Language::of_locale(locale), Language::English, "{locale}");
        }
    }
}
