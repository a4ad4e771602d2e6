//! A sentence with placeholders, found again in the finished English sentence and said in another language.
//!
//! `{}` stands for any text that is not empty, `{#}` for a number or a range of numbers. The translation takes what stands there in
//! order (`{}`), or by its place counted from 1 (`{2}`) where its order differs.

/// What a placeholder may stand for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Slot {
    Text,
    Number,
}

/// A piece of a translation.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Piece {
    Own(String),
    /// What stands at this placeholder of the English.
    Value(usize),
}

/// An English sentence with placeholders and its translation.
#[derive(Debug)]
pub(super) struct Template {
    /// What stands before, between and behind the placeholders: one more than these.
    parts: Vec<String>,
    slots: Vec<Slot>,
    other: Vec<Piece>,
}

/// Own text and the names of the placeholders between.
fn taken_apart(text: &str) -> Option<(Vec<String>, Vec<String>)> {
    let (mut parts, mut names) = (vec![String::new()], Vec::new());
    let mut rest = text;
    while let Some(open) = rest.find('{') {
        let close = open + rest[open..].find('}')?;
        parts.last_mut()?.push_str(&rest[..open]);
        names.push(rest[open + 1..close].to_owned());
        parts.push(String::new());
        rest = &rest[close + 1..];
    }
    parts.last_mut()?.push_str(rest);
    Some((parts, names))
}

impl Template {
    /// `None` where braces or places do not fit.
    pub(super) fn new(english: &str, other: &str) -> Option<Self> {
        let (parts, names) = taken_apart(english)?;
        let slots: Vec<Slot> = names.iter().map(|n| if n == "#" { Slot::Number } else { Slot::Text }).collect();
        let (own, places) = taken_apart(other)?;
        let mut pieces = vec![Piece::Own(own[0].clone())];
        for (k, name) in places.iter().enumerate() {
            let place = if name.is_empty() { k } else { name.parse::<usize>().ok()?.checked_sub(1)? };
            pieces.push(Piece::Value(place));
            pieces.push(Piece::Own(own[k + 1].clone()));
        }
        let fits = pieces.iter().all(|p| !matches!(p, Piece::Value(k) if *k >= slots.len()));
        fits.then_some(Self { parts, slots, other: pieces })
    }

    /// Letters that are its own: the more, the surer a sentence is of this template.
    pub(super) fn own_letters(&self) -> usize {
        self.parts.iter().map(|p| p.chars().count()).sum()
    }

    /// The sentence in the other language, where it is of this template; `inner` translates what stands at the placeholders.
    pub(super) fn translated(&self, english: &str, inner: &dyn Fn(&str) -> String) -> Option<String> {
        let rest = english.strip_prefix(self.parts[0].as_str())?;
        let mut values = Vec::with_capacity(self.slots.len());
        if !self.matched(0, rest, &mut values) {
            return None;
        }
        let said = |piece: &Piece| match piece {
            Piece::Own(text) => text.clone(),
            Piece::Value(k) => inner(values[*k]),
        };
        Some(self.other.iter().map(said).collect())
    }

    /// Whether `rest` is made of the placeholders from `slot` on with the text behind each; their values, each as short as it can be.
    fn matched<'a>(&self, slot: usize, rest: &'a str, values: &mut Vec<&'a str>) -> bool {
        let Some(kind) = self.slots.get(slot) else { return rest.is_empty() };
        let behind = self.parts[slot + 1].as_str();
        let allowed = |value: &str| !value.is_empty() && (*kind == Slot::Text || is_number(value));
        if slot + 1 == self.slots.len() {
            // The last one takes all up to the end.
            let Some(value) = rest.strip_suffix(behind).filter(|value| allowed(value)) else { return false };
            values.push(value);
            return true;
        }
        let mut from = 0;
        while let Some(at) = rest.get(from..).and_then(|text| text.find(behind)).map(|at| from + at) {
            if allowed(&rest[..at]) {
                values.push(&rest[..at]);
                if self.matched(slot + 1, &rest[at + behind.len()..], values) {
                    return true;
                }
                values.pop();
            }
            from = at + rest[at..].chars().next().map_or(1, char::len_utf8);
        }
        false
    }

    /// Why a translation does not fit its English: every value must be said exactly once.
    #[cfg(test)]
    pub(super) fn faults(english: &str, other: &str) -> Option<String> {
        let (_, names) = taken_apart(english)?;
        let (parts, _) = taken_apart(english)?;
        if names.len() > 1 && parts[1..names.len()].iter().any(String::is_empty) {
            return Some("two placeholders touch".to_owned());
        }
        let Some(template) = Self::new(english, other) else { return Some("braces or places do not fit".to_owned()) };
        let mut said: Vec<usize> =
            template.other.iter().filter_map(|p| if let Piece::Value(k) = p { Some(*k) } else { None }).collect();
        said.sort_unstable();
        (said != (0..names.len()).collect::<Vec<_>>()).then(|| format!("{} values, said: {said:?}", names.len()))
    }
}

/// A number with its sign, power of ten and deviation, a count, or a range of them.
fn is_number(text: &str) -> bool {
    let sign = |c: char| "+-−–±.,()<>~e ".contains(c);
    text.chars().any(|c| c.is_ascii_digit()) && text.chars().all(|c| c.is_ascii_digit() || sign(c))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::Template;

    fn said(english: &str, other: &str, sentence: &str) -> Option<String> {
        Template::new(english, other).unwrap().translated(sentence, &|v| format!("<{v}>"))
    }

    #[test]
    fn values_are_found_again() {
        assert_eq!(said("Run {}", "Lauf {}", "Run 7"), Some("Lauf <7>".to_owned()));
        assert_eq!(said("Run {}", "Lauf {}", "Runs 7"), None);
        assert_eq!(
            said("{} of {} runs", "{2} Läufe, davon {1}", "3 of 12 runs").as_deref(),
            Some("<12> Läufe, davon <3>")
        );
        // What stands between two values may stand in the first one as well.
        assert_eq!(said("{} at {}: {#}", "{} bei {}: {}", "a at b at c: 3").as_deref(), Some("<a> bei <b at c>: <3>"));
        assert_eq!(said("{#} runs", "{} Läufe", "all runs"), None);
        assert_eq!(said("{}, {#}", "{} {}", "a, b, 3").as_deref(), Some("<a, b> <3>"));
    }

    #[test]
    fn faults_are_told() {
        assert!(Template::faults("Run {}", "Lauf {}").is_none());
        assert!(Template::faults("{} of {}", "{2} von {1}").is_none());
        assert!(Template::faults("{} of {}", "{1} von {1}").is_some());
        assert!(Template::faults("Run {}", "Lauf").is_some());
        assert!(Template::faults("Run", "Lauf {}").is_some());
        assert!(Template::faults("{}{}", "{}{}").is_some());
    }
}
