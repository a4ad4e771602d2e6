//! The one vocabulary: every term of the window with its meaning. The tooltips of the window and `docs/glossary.md` are made
//! of it.

mod terms;

use crate::effects::Effect;
pub use terms::{TERMS, Term};

/// The meaning of what stands in the window, where it is a term.
pub fn meaning(words: &str) -> Option<&'static str> {
    let words = words.trim();
    TERMS.iter().find(|t| t.name == words || t.also.contains(&words)).map(|t| t.meaning)
}

/// The whole vocabulary as a page of the documentation.
pub fn page() -> String {
    let mut terms: Vec<&Term> = TERMS.iter().collect();
    terms.sort_by_key(|t| t.name.to_lowercase());
    let mut text =
        "# Glossary\n\nThe words of the window, as its tooltips explain them. This page is made of the table that the \
                    tooltips are\nmade of (`src/display/glossary`); a test holds them together.\n\n"
            .to_owned();
    for term in terms {
        let also = term.also.iter().filter(|a| a.to_lowercase() != term.name.to_lowercase());
        let also: Vec<&str> = also.copied().collect();
        let also = if also.is_empty() { String::new() } else { format!(" ({})", also.join(", ")) };
        text += &format!("**{}**{also}: {}\n\n", term.name, term.meaning);
    }
    text += "## Laws\n\n| law | force | what it is |\n|---|---|---|\n";
    for effect in Effect::ALL {
        let law = effect.description();
        text += &format!("| {} | `{}` | {} |\n", law.name, law.formula.replace('|', "\\|"), law.sentence);
    }
    text
}
