//! Which separator and which decimal sign a text table uses: the pair under which most lines are rows of numbers.

use crate::table::number::number;
use crate::table::{Cell, FEWEST, texts_of};

/// Lines that are looked at, from the start and from the middle.
const SAMPLE: usize = 400;

/// How a line is cut into cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Separator {
    /// A letter.
    Letter(char),
    /// Any number of blanks and tabs.
    Blanks,
}

/// Separator and decimal sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Dialect {
    pub separator: Separator,
    pub comma: bool,
}

/// Dialects in the order in which they are preferred.
const CANDIDATES: [Dialect; 10] = [
    Dialect { separator: Separator::Letter('\t'), comma: false },
    Dialect { separator: Separator::Letter('\t'), comma: true },
    Dialect { separator: Separator::Letter(';'), comma: false },
    Dialect { separator: Separator::Letter(';'), comma: true },
    Dialect { separator: Separator::Letter(','), comma: false },
    Dialect { separator: Separator::Letter('|'), comma: false },
    Dialect { separator: Separator::Letter('|'), comma: true },
    Dialect { separator: Separator::Blanks, comma: false },
    Dialect { separator: Separator::Blanks, comma: true },
    // Numbers with a decimal comma in quotes.
    Dialect { separator: Separator::Letter(','), comma: true },
];

impl Dialect {
    /// Finds the dialect of a text; none where no line holds numbers.
    pub(crate) fn sniff(text: &str) -> Option<Self> {
        let sample = sample(text);
        // The first of the best: later candidates must be better, not as good.
        let mut best: Option<((usize, usize), Self)> = None;
        for candidate in CANDIDATES {
            let score = candidate.score(&sample);
            if score > best.map_or((0, 0), |(most, _)| most) {
                best = Some((score, candidate));
            }
        }
        let counted = best.map_or(0, |(_, dialect)| dialect.rows_with_texts(&sample, false));
        let texts = CANDIDATES.into_iter().map(|candidate| (candidate.rows_with_texts(&sample, true), candidate));
        // The first of the best, as above.
        let texts = texts.rev().max_by_key(|(rows, _)| *rows);
        match texts {
            Some((rows, dialect)) if rows > counted && rows >= FEWEST && 2 * rows >= sample.len() => Some(dialect),
            _ => best.map(|(_, dialect)| dialect),
        }
    }

    /// Lines of two numbers and more with texts in the same columns; without `texts` lines of numbers alone.
    fn rows_with_texts(self, sample: &[&str], texts: bool) -> usize {
        let mut alike = std::collections::HashMap::<(usize, Vec<usize>), usize>::new();
        let (mut cells, mut numbers) = (Vec::new(), 0);
        for line in sample {
            self.cells(line, &mut cells);
            if let Some(texts) = texts_of(&cells) {
                *alike.entry((cells.len(), texts)).or_default() += 1;
            }
            let words = cells.iter().any(|cell| matches!(cell, Cell::Word(_)));
            numbers += usize::from(!words && cells.iter().any(Cell::is_number));
        }
        if texts { alike.into_values().max().unwrap_or(0) } else { numbers }
    }

    /// Lines of numbers of the commonest width; a line of several cells counts a little more than one of a single. Among equals
    /// goes the one with most lines of nothing but numbers: `12:00:01;1,5` has no remark behind its clock, but a decimal comma.
    fn score(self, sample: &[&str]) -> (usize, usize) {
        let mut widths = std::collections::BTreeMap::<usize, usize>::new();
        let (mut cells, mut whole) = (Vec::new(), 0);
        for line in sample {
            self.cells(line, &mut cells);
            whole += usize::from(!cells.iter().any(|cell| matches!(cell, Cell::Word(_))));
            let width = cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1);
            let numbers = cells.iter().filter(|cell| cell.is_number()).count();
            // A word in the last cell is a remark.
            let words =
                cells[..width.saturating_sub(usize::from(width > 1))].iter().any(|cell| matches!(cell, Cell::Word(_)));
            if numbers > 0 && !words {
                *widths.entry(width).or_default() += 1;
            }
        }
        let total: usize = widths.values().sum();
        let (width, common) = widths.into_iter().max_by_key(|&(_, count)| count).unwrap_or((0, 0));
        let score = (2 * total + common) * 4 + usize::from(width > 1);
        if total > 0 { (score, whole) } else { (0, 0) }
    }

    /// Cuts a line into cells.
    pub(crate) fn cells(self, line: &str, cells: &mut Vec<Cell>) {
        cells.clear();
        match self.separator {
            Separator::Blanks => {
                let mut words = line.split_whitespace().peekable();
                // A comment sign that stands alone in front of names is no cell.
                if words.peek().is_some_and(|word| word.bytes().all(|byte| b"#%!*/;".contains(&byte))) {
                    words.next();
                }
                for word in words {
                    match Cell::parse(word, self.comma) {
                        Cell::Word(word) => match glued(&word, self.comma) {
                            Some(numbers) => cells.extend(numbers.into_iter().map(Cell::Real)),
                            None => cells.push(Cell::Word(word)),
                        },
                        cell => cells.push(cell),
                    }
                }
            }
            Separator::Letter(letter) if line.contains('"') => {
                cells.extend(quoted(line, letter).iter().map(|word| Cell::parse(word, self.comma)));
            }
            Separator::Letter(letter) => cells.extend(line.split(letter).map(|word| Cell::parse(word, self.comma))),
        }
    }
}

/// Numbers of fixed width that touch, such as `1.545085E+00-3.040882E-01`: each has a decimal sign.
fn glued(word: &str, comma: bool) -> Option<Vec<f64>> {
    let bytes = word.as_bytes();
    let mut cuts = vec![0];
    let begins = |i: &usize| {
        matches!(bytes[*i], b'+' | b'-') && (bytes[i - 1].is_ascii_digit() || matches!(bytes[i - 1], b'.' | b','))
    };
    cuts.extend((1..bytes.len()).filter(begins));
    cuts.push(bytes.len());
    let parts: Vec<&str> = cuts.windows(2).map(|cut| word.get(cut[0]..cut[1])).collect::<Option<_>>()?;
    let sign = if comma { ',' } else { '.' };
    let whole = parts.len() > 1 && parts.iter().all(|part| part.contains(sign));
    whole.then(|| parts.iter().map(|part| number(part, comma)).collect::<Option<Vec<_>>>())?
}

/// Cells of a line with quotes: a separator within quotes is none, a doubled quote is one.
fn quoted(line: &str, separator: char) -> Vec<String> {
    let (mut cells, mut cell, mut inside) = (Vec::new(), String::new(), false);
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if inside && letters.peek() == Some(&'"') => {
                letters.next();
                cell.push('"');
            }
            '"' => inside = !inside,
            _ if letter == separator && !inside => cells.push(std::mem::take(&mut cell)),
            _ => cell.push(letter),
        }
    }
    cells.push(cell);
    cells
}

/// Lines from the start, and from the middle for headers that are longer.
fn sample(text: &str) -> Vec<&str> {
    let filled = |line: &&str| !line.trim().is_empty();
    let mut sample: Vec<&str> = text.lines().filter(filled).take(SAMPLE).collect();
    if sample.len() == SAMPLE {
        let mut middle = text.len() / 2;
        while !text.is_char_boundary(middle) {
            middle += 1;
        }
        sample.extend(text[middle..].lines().skip(1).filter(filled).take(SAMPLE));
    }
    sample
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    fn of(text: &str) -> (Separator, bool) {
        let dialect = Dialect::sniff(text).unwrap();
        (dialect.separator, dialect.comma)
    }

    #[test]
    fn dialects_are_told_apart() {
        use Separator::{Blanks, Letter};
        assert_eq!(of("a,b\n1.0,2.0\n1.5,2.5\n"), (Letter(','), false));
        assert_eq!(of("\"a\",\"b\"\n\"1,0\",\"2,0\"\n\"1,5\",\"2,5\"\n"), (Letter(','), true));
        assert_eq!(of("a;b\n1,0;2,0\n1,5;2,5\n"), (Letter(';'), true));
        assert_eq!(of("a\tb\n1,0\t2,0\n"), (Letter('\t'), true));
        assert_eq!(of("  1.0   2.0\n  1.5   2.5\n"), (Blanks, false));
        assert_eq!(of("1,0 2,0\n1,5 2,5\n"), (Blanks, true));
        assert_eq!(of("1, 2, 3\n4, 5, 6\n"), (Letter(','), false));
        assert_eq!(of("time,a\n1.0D+00,2.0D-3\n"), (Letter(','), false));
        assert_eq!(of("Zeit;F\n12:00:01;1,5\n12:00:02;2,5\n"), (Letter(';'), true));
    }

    #[test]
    fn numbers_of_fixed_width_may_touch() {
        assert_eq!(glued("1.545085E+00-3.040882E-01", false), Some(vec![1.545_085, -0.304_088_2]));
        assert_eq!((glued("1.5-a", false), glued("12-13", false), glued("1.5E-3", false)), (None, None, None));
        let mut cells = Vec::new();
        Dialect { separator: Separator::Blanks, comma: false }.cells("% t(s) F(N)", &mut cells);
        assert_eq!(cells.len(), 2);
    }

    #[test]
    fn quotes_keep_their_separators() {
        assert_eq!(quoted("\"a,b\",\"c\"\"d\",e", ','), ["a,b", "c\"d", "e"]);
    }
}
