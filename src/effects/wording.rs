//! What the effects are called in tables, titles and sentences: the law's one name, its formula and its sentence.

use super::effect::Effect;
use std::sync::LazyLock;

/// The names with a capital letter, in the order of [`Effect::ALL`].
static TITLES: LazyLock<Vec<String>> = LazyLock::new(|| {
    let capital = |effect: Effect| {
        let mut letters = effect.noun().chars();
        letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
    };
    Effect::ALL.map(capital).to_vec()
});

impl Effect {
    /// Its one name as in the middle of a sentence, such as `viscous dashpot`.
    pub fn noun(self) -> &'static str {
        self.description().name
    }

    /// The same at the start of a sentence and in titles, such as `Viscous dashpot`.
    pub fn title(self) -> &'static str {
        &TITLES[self as usize]
    }

    /// What it is physically, in one sentence.
    pub fn sentence(self) -> &'static str {
        self.description().sentence
    }
}
