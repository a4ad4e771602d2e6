//! A cell of a table: a number, complex number, clock time, word, or nothing.

use super::moment::{clock, span};
use super::number::number;

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

/// What is wrong with a word where a number must stand, and how to mend it. Recorders write their own words where the range was
/// exceeded.
pub(crate) fn no_number(word: &str) -> &'static str {
    let plain: String = word.to_lowercase().chars().filter(|c| c.is_alphabetic()).collect();
    let exceeded = matches!(word.chars().next(), Some('>' | '<')) && word.len() > 1;
    if exceeded
        || matches!(
            plain.as_str(),
            "ovld" | "ovl" | "ol" | "ovr" | "ovf" | "over" | "overload" | "overflow" | "overrange"
        )
    {
        "says an overload, and no number was recorded; measure again in a larger range, or remove the row"
    } else {
        "is not a number; write one such as 1.25e-3, or remove the row"
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
        assert_eq!(Cell::parse("-1 234 567,5", true), Cell::Real(-1_234_567.5));
        assert_eq!(Cell::parse("1\u{202f}234,5", true), Cell::Real(1234.5));
        assert_eq!(Cell::parse("12\u{a0}345.5", false), Cell::Real(12_345.5));
        assert_eq!(Cell::parse("1 23,5", true), Cell::Word("1 23,5".into()));
        assert_eq!(Cell::parse("1.23,5", true), Cell::Word("1.23,5".into()));
        assert_eq!(Cell::parse("infinite", false), Cell::Word("infinite".into()));
    }

    #[test]
    fn words_of_an_overload() {
        for word in ["OVLD", "Overload", "OL", ">5.0", "+OVER", "#OVR"] {
            assert!(no_number(word).starts_with("says an overload"), "{word}");
        }
        for word in ["x", "-", "?", ">", "****"] {
            assert!(no_number(word).starts_with("is not a number"), "{word}");
        }
    }

    #[test]
    fn complex_numbers() {
        assert_eq!(Cell::parse("(-0.5+2.6838e-08j)", false), Cell::Complex([-0.5, 2.6838e-8]));
        assert_eq!(Cell::parse("1.5 - 2i", false), Cell::Complex([1.5, -2.0]));
        assert_eq!(Cell::parse("1.2.3", false), Cell::Word("1.2.3".into()));
    }
}
