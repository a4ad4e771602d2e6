//! The catalogue of a language: English on the left, its translation on the right, embedded in the program.

use super::chosen::Language;
use super::template::Template;
use std::collections::{BTreeMap, HashMap};
use std::sync::OnceLock;

const GERMAN: &str = include_str!("../../../assets/locales/de.toml");

/// All translations of one language.
#[derive(Debug)]
pub(super) struct Catalogue {
    /// Texts without placeholders.
    words: HashMap<String, String>,
    /// Texts with placeholders, those first that say most themselves.
    templates: Vec<Template>,
}

impl Catalogue {
    fn new(text: &str) -> Self {
        // One table a part of the program, so that translators find their way; the parts mean nothing to the lookup.
        let parts: BTreeMap<String, BTreeMap<String, String>> = toml::from_str(text).unwrap_or_default();
        let all = parts.into_values().flatten();
        let (templates, words): (Vec<_>, Vec<_>) = all.partition(|(english, _)| english.contains('{'));
        let mut templates: Vec<Template> =
            templates.iter().filter_map(|(english, other)| Template::new(english, other)).collect();
        templates.sort_by_key(|t| std::cmp::Reverse(t.own_letters()));
        Self { words: words.into_iter().collect(), templates }
    }

    /// The translation of a text without placeholders.
    pub(super) fn word(&self, english: &str) -> Option<&str> {
        self.words.get(english).map(String::as_str)
    }

    /// The translation of a text that a template made; `inner` translates what stands at its placeholders.
    pub(super) fn filled(&self, english: &str, inner: &dyn Fn(&str) -> String) -> Option<String> {
        self.templates.iter().find_map(|template| template.translated(english, inner))
    }
}

/// The catalogue of a language; none for English, the language of the code.
pub(super) fn of(language: Language) -> Option<&'static Catalogue> {
    static CATALOGUE: OnceLock<Catalogue> = OnceLock::new();
    match language {
        Language::English => None,
        Language::German => Some(CATALOGUE.get_or_init(|| Catalogue::new(GERMAN))),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::{Catalogue, GERMAN};
    use crate::window::language::template::Template;
    use std::collections::{BTreeMap, HashSet};

    fn pairs() -> Vec<(String, String)> {
        let parts: BTreeMap<String, BTreeMap<String, String>> = toml::from_str(GERMAN).unwrap();
        parts.into_values().flatten().collect()
    }

    #[test]
    fn the_catalogue_is_read_and_its_placeholders_agree() {
        let pairs = pairs();
        let catalogue = Catalogue::new(GERMAN);
        assert_eq!(catalogue.words.len() + catalogue.templates.len(), pairs.len());
        let mut seen = HashSet::new();
        for (english, german) in &pairs {
            assert!(seen.insert(english), "{english} stands twice");
            assert!(!german.trim().is_empty(), "{english} has no translation");
            let faults = Template::faults(english, german);
            assert!(faults.is_none(), "{english} = {german}: {faults:?}");
        }
    }
}
