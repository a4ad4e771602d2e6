//! From lines to cards and their fields.

/// A card with its continuations.
#[derive(Debug)]
pub(super) struct Card<'a> {
    /// Line of its name, from 1.
    pub line: usize,
    /// Name in capitals, without `*`.
    pub name: String,
    fields: Vec<&'a str>,
}

impl<'a> Card<'a> {
    /// Data field, from 0 behind the name; empty beyond the end.
    pub(super) fn field(&self, index: usize) -> &'a str {
        self.fields.get(index).copied().unwrap_or("")
    }

    /// Number of data fields, trailing empty ones included.
    pub(super) fn len(&self) -> usize {
        self.fields.len()
    }
}

/// Cards of the bulk data in a text.
pub(super) fn cards(text: &str) -> Vec<Card<'_>> {
    let begin = text.lines().position(is_begin);
    let mut cards: Vec<Card<'_>> = Vec::new();
    for (index, line) in text.lines().enumerate().skip(begin.map_or(0, |line| line + 1)) {
        let line = line.split('$').next().unwrap_or_default().trim_end();
        if line.trim().is_empty() {
            continue;
        }
        let (name, fields) = split(line);
        // A continuation begins with nothing, `+` or `*`.
        if name.is_empty() || name.starts_with(['+', '*']) {
            if let Some(card) = cards.last_mut() {
                card.fields.extend(fields);
            }
            continue;
        }
        let name = name.trim_end_matches('*').trim().to_uppercase();
        if name == "ENDDATA" {
            break;
        }
        cards.push(Card { line: index + 1, name, fields });
    }
    cards
}

/// Whether a line is `BEGIN BULK`.
pub(super) fn is_begin(line: &str) -> bool {
    let mut words = line.split_whitespace();
    let [first, second] = [words.next(), words.next()].map(Option::unwrap_or_default);
    first.eq_ignore_ascii_case("begin") && second.eq_ignore_ascii_case("bulk")
}

/// Name field and data fields: always eight, or four of a large line.
fn split(line: &str) -> (&str, Vec<&str>) {
    if line.contains(',') {
        let mut words = line.split(',').map(str::trim);
        let name = words.next().unwrap_or_default();
        let is_large = name.ends_with('*') || name.starts_with('*');
        let count = if is_large { 4 } else { 8 };
        let mut fields: Vec<&str> = words.take(count).collect();
        fields.resize(count, "");
        return (name, fields);
    }
    let cut = |from: usize, to: usize| {
        let (from, to) = (boundary(line, from), boundary(line, to));
        line[from..to].trim()
    };
    let name = cut(0, 8);
    let is_large = name.ends_with('*') || name.starts_with('*');
    let (width, count) = if is_large { (16, 4) } else { (8, 8) };
    let fields = (0..count).map(|k| cut(8 + k * width, 8 + (k + 1) * width)).collect();
    (name, fields)
}

/// The byte nearest below `at` at which the text may be cut.
fn boundary(line: &str, at: usize) -> usize {
    (0..=at.min(line.len())).rev().find(|&i| line.is_char_boundary(i)).unwrap_or(0)
}
