//! A finished English text in the language of the window: as a whole, by its template, or piece by piece.

use super::catalogue::{self, Catalogue};
use super::chosen::{Language, now};
use super::numbers::with_commas;
use std::cell::RefCell;
use std::collections::HashMap;

/// Texts that are kept: what a screen shows is asked for again every frame.
const KEPT: usize = 4096;
/// How deep texts are taken apart.
const DEEP: usize = 6;
/// Between captions of one line.
const CAPTIONS: &str = "   ·   ";
/// What stands between pieces that are said on their own, the strongest first.
const BETWEEN: [&str; 9] = ["\n", CAPTIONS, "  ·  ", "   ", "; ", ": ", " · ", ",  ", ", "];

thread_local! {
    /// Texts in the language that they were asked for last.
    static SAID: RefCell<(Language, HashMap<String, String>)> = RefCell::new((Language::English, HashMap::new()));
}

/// A literal in the language of this thread; itself where it has no translation.
pub(crate) fn word(english: &'static str) -> &'static str {
    catalogue::of(now()).and_then(|c| c.word(english)).unwrap_or(english)
}

/// The same of a word that has a key of its own where it means another thing.
pub(crate) fn word_as(english: &'static str, key: &str) -> &'static str {
    catalogue::of(now()).and_then(|c| c.word(key)).unwrap_or(english)
}

/// A text in the language of this thread: words by the catalogue, numbers with the decimal sign. What is not in the catalogue stays
/// as it is: names of files, channels and projects.
pub(crate) fn tr(english: impl AsRef<str>) -> String {
    let english = english.as_ref();
    let language = now();
    let Some(catalogue) = catalogue::of(language) else { return english.to_owned() };
    if let Some(kept) = SAID.with_borrow(|(of, said)| said.get(english).filter(|_| *of == language).cloned()) {
        return kept;
    }
    let text = translated(catalogue, english, 0).unwrap_or_else(|| with_commas(english));
    SAID.with_borrow_mut(|(of, said)| {
        if *of != language || said.len() >= KEPT {
            said.clear();
            *of = language;
        }
        said.insert(english.to_owned(), text.clone());
    });
    text
}

/// The same of a piece, where anything of it is in the catalogue.
fn translated(catalogue: &Catalogue, english: &str, depth: usize) -> Option<String> {
    let trimmed = english.trim();
    if depth > DEEP || !trimmed.contains(char::is_alphabetic) {
        return None;
    }
    // No template reaches over what stands between captions.
    let captions = trimmed.contains(CAPTIONS);
    let whole = if captions { None } else { whole(catalogue, trimmed, depth) };
    let said = whole.or_else(|| pieces(catalogue, trimmed, depth))?;
    let (before, after) = (english.len() - english.trim_start().len(), english.trim_end().len());
    Some(format!("{}{said}{}", &english[..before], &english[after..]))
}

/// By the catalogue as a whole, with a small letter at its start, or without the point at its end.
fn whole(catalogue: &Catalogue, english: &str, depth: usize) -> Option<String> {
    let inner = |value: &str| translated(catalogue, value, depth + 1).unwrap_or_else(|| with_commas(value));
    let found = |text: &str| catalogue.word(text).map(str::to_owned).or_else(|| catalogue.filled(text, &inner));
    let capital = || {
        let small = with_first(english, |c| c.to_lowercase().collect());
        (small != english)
            .then(|| found(&small))
            .flatten()
            .map(|text| with_first(&text, |c| c.to_uppercase().collect()))
    };
    let sentence = || {
        let start = english.strip_suffix('.')?;
        let text = found(start)?;
        Some(format!("{text}."))
    };
    // The start of a sentence, which is shown without its point.
    let start = || found(&format!("{english}.")).map(|text| text.trim_end_matches('.').to_owned());
    found(english).or_else(capital).or_else(sentence).or_else(start)
}

fn with_first(text: &str, change: impl Fn(char) -> String) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| change(first) + letters.as_str())
}

/// Piece by piece, where at least one is in the catalogue.
fn pieces(catalogue: &Catalogue, english: &str, depth: usize) -> Option<String> {
    let each = |list: Vec<&str>, between: &str| {
        let said: Vec<Option<String>> = list.iter().map(|p| translated(catalogue, p, depth + 1)).collect();
        let known = said.iter().any(Option::is_some);
        let texts = said.into_iter().zip(list).map(|(s, p)| s.unwrap_or_else(|| with_commas(p)));
        known.then(|| texts.collect::<Vec<_>>().join(between))
    };
    // Sentences keep their points.
    let sentences: Vec<&str> = english.split_inclusive(". ").map(|s| s.strip_suffix(' ').unwrap_or(s)).collect();
    let lines = english.contains('\n');
    if !lines
        && sentences.len() > 1
        && let Some(text) = each(sentences, " ")
    {
        return Some(text);
    }
    BETWEEN.iter().filter(|b| english.contains(**b)).find_map(|b| each(english.split(b).collect(), b))
}

#[cfg(test)]
mod tests {
    use super::tr;
    use crate::window::language::{Language, choose};

    #[test]
    fn english_is_never_changed() {
        assert_eq!(tr("Run 3, 12.5 Hz"), "Run 3, 12.5 Hz");
    }

    #[test]
    fn words_templates_and_pieces() {
        choose(Language::German);
        assert_eq!(tr("Frequency"), "Frequenz");
        assert_eq!(tr("Run 3"), "Lauf 3");
        // A sentence of the engine: the law and its place are in it, and begin with a capital letter.
        assert_eq!(tr("Viscous dashpot at DOF 7"), "Viskoser Dämpfer an FHG 7");
        assert_eq!(tr("shaker-0.5.csv"), "shaker-0.5.csv");
        assert_eq!(tr("12.5 Hz"), "12,5 Hz");
        assert_eq!(tr("   Run 3"), "   Lauf 3");
        let caption = "Run 1   13.07 Hz   largest 27.9 mm (peak)   ·   driven at its base";
        assert_eq!(tr(caption), "Lauf 1   13,07 Hz   größter Ausschlag 27,9 mm (Spitze)   ·   am Fußpunkt erregt");
        choose(Language::English);
        assert_eq!(tr("Frequency"), "Frequency");
    }
}
