//! A cell of a table: a number, complex number, clock time, word, or nothing.

use super::moment::{clock, span};

/// A cell.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Cell {
    /// Nothing.
    Empty,
    /// A number, NaN included where the file says so.
    Real(f64),
    /// A complex number.
    Complex([f64; 2]),
    /// A time of day or date, s.
    Clock(f64),
    /// A span of time with its unit, s, and its text.
    Span(f64, Box<str>),
    /// Anything else.
    Word(String),
}

impl Cell {
    pub(crate) fn is_empty(&self) -> bool {
        *self == Self::Empty
    }

    pub(crate) fn is_number(&self) -> bool {
        matches!(self, Self::Real(_) | Self::Complex(_) | Self::Clock(_) | Self::Span(..))
    }

    /// Reads a cell of text with a decimal sign.
    pub(crate) fn parse(text: &str, comma: bool) -> Self {
        let text = text.trim();
        if text.is_empty() {
            return Self::Empty;
        }
        // The minus sign of typesetters.
        let typeset = text.contains('−').then(|| text.replace('−', "-"));
        let text = typeset.as_deref().unwrap_or(text);
        if let Some(value) = number(text, comma) {
            return Self::Real(value);
        }
        if let Some(value) = complex(text, comma) {
            return Self::Complex(value);
        }
        if let Some(seconds) = span(text) {
            return Self::Span(seconds, text.into());
        }
        clock(text).map_or_else(|| Self::Word(text.to_owned()), Self::Clock)
    }
}

/// A real number: `1.5`, `1,5` with a decimal comma, `1.5D-3`, `NaN`, `-1.#IND`.
pub(crate) fn number(text: &str, comma: bool) -> Option<f64> {
    let first = text.bytes().next()?;
    if !matches!(first, b'0'..=b'9' | b'+' | b'-' | b'.' | b',') {
        return missing(text);
    }
    if !comma && let Ok(value) = text.parse::<f64>() {
        return plain(text).then_some(value).or_else(|| missing(text));
    }
    if let Some(value) = grouped(text, comma) {
        return Some(value);
    }
    if comma && (text.contains('.') && text.contains(',') || text.matches(',').count() > 1) {
        return None;
    }
    // A comma at the end of a word separates words, it is no decimal comma.
    if comma && !text.as_bytes().windows(2).all(|pair| pair[0] != b',' || pair[1].is_ascii_digit())
        || text.ends_with(',')
    {
        return None;
    }
    let mended: String = text
        .chars()
        .map(|c| match c {
            ',' if comma => '.',
            'd' | 'D' => 'e',
            other => other,
        })
        .collect();
    match mended.parse() {
        Ok(value) if plain(&mended) => Some(value),
        _ => missing(text),
    }
}

/// A number with signs between its thousands and a decimal sign: `1.234,5`, `1,234.5`, `1'234.5`.
fn grouped(text: &str, comma: bool) -> Option<f64> {
    let (groups, decimal) = if comma { (['.', '\''], ',') } else { ([',', '\''], '.') };
    let (whole, fraction) = text.split_once(decimal)?;
    let letter = groups.into_iter().find(|letter| whole.contains(*letter))?;
    let mut parts = whole.trim_start_matches(['+', '-']).split(letter);
    let first = parts.next()?;
    let digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    let right = (1..4).contains(&first.len()) && digits(first) && parts.all(|part| part.len() == 3 && digits(part));
    (right && digits(fraction)).then(|| format!("{}.{fraction}", whole.replace(letter, "")).parse().ok())?
}

/// Whether a text that parses is digits, not `inf` or `nan` in letters.
fn plain(text: &str) -> bool {
    text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E'))
}

/// Numbers that are none, in the words of the programs that write them.
fn missing(text: &str) -> Option<f64> {
    let plain = text.trim_start_matches(['+', '-']).to_ascii_lowercase();
    match plain.as_str() {
        "nan" | "n/a" | "#n/a" | "na" | "1.#ind" | "1.#qnan" | "nan(ind)" | "#nv" => Some(f64::NAN),
        "inf" | "infinity" | "1.#inf" => Some(if text.starts_with('-') { f64::NEG_INFINITY } else { f64::INFINITY }),
        _ => None,
    }
}

/// `(1.0+2.0j)`, `1.0-2.0i`, `2j`.
fn complex(text: &str, comma: bool) -> Option<[f64; 2]> {
    let inner = text.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).unwrap_or(text).trim();
    let inner = inner.strip_suffix(['j', 'i', 'J'])?.trim_end_matches('*').trim_end();
    let bytes = inner.as_bytes();
    // The sign between both parts: the last that follows no exponent.
    let at = (1..bytes.len())
        .rev()
        .find(|&i| matches!(bytes[i], b'+' | b'-') && !matches!(bytes[i - 1], b'e' | b'E' | b'd' | b'D'));
    match at {
        None => Some([0.0, number(inner, comma)?]),
        Some(at) => {
            let imaginary: String = inner[at..].chars().filter(|c| !c.is_whitespace()).collect();
            Some([number(inner[..at].trim(), comma)?, number(&imaginary, comma)?])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_every_dialect() {
        assert_eq!(Cell::parse("1.5D-3", false), Cell::Real(1.5e-3));
        assert_eq!(Cell::parse("1,5", true), Cell::Real(1.5));
        assert_eq!(Cell::parse("1,5", false), Cell::Word("1,5".into()));
        assert_eq!(Cell::parse("−1,5e−3", true), Cell::Real(-1.5e-3));
        assert_eq!(Cell::parse("1,", true), Cell::Word("1,".into()));
        assert_eq!(Cell::parse("-.5e+3", false), Cell::Real(-500.0));
        assert!(matches!(Cell::parse("-1.#IND", false), Cell::Real(value) if value.is_nan()));
        assert_eq!(Cell::parse("1.234,5", true), Cell::Real(1234.5));
        assert_eq!(Cell::parse("-1,234,567.5", false), Cell::Real(-1_234_567.5));
        assert_eq!(Cell::parse("1'234.5", false), Cell::Real(1234.5));
        assert_eq!(Cell::parse("1.23,5", true), Cell::Word("1.23,5".into()));
        assert_eq!(Cell::parse("infinite", false), Cell::Word("infinite".into()));
    }

    #[test]
    fn complex_numbers() {
        assert_eq!(Cell::parse("(-0.5+2.6838e-08j)", false), Cell::Complex([-0.5, 2.6838e-8]));
        assert_eq!(Cell::parse("1.5 - 2i", false), Cell::Complex([1.5, -2.0]));
        assert_eq!(Cell::parse("1.2.3", false), Cell::Word("1.2.3".into()));
    }
}
