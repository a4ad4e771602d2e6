//! Numbers as finite-element programs write them.

use crate::error::{Problem, quote};

/// A finite number: `1.5`, `1.5E3`, `1.5D3` and NASTRAN's `1.5+3`.
pub(crate) fn real(text: &str) -> Result<f64, Problem> {
    let word = text.trim();
    let wrong = || Problem::Number { text: quote(text) };
    let plain: String = word.chars().map(|c| if matches!(c, 'd' | 'D') { 'E' } else { c }).collect();
    let value = plain.parse::<f64>().ok().or_else(|| {
        // A sign after the first character that follows no E begins an exponent.
        let sign =
            plain.char_indices().skip(1).find(|&(i, c)| matches!(c, '+' | '-') && !plain[..i].ends_with(['e', 'E']))?;
        format!("{}E{}", &plain[..sign.0], &plain[sign.0..]).parse().ok()
    });
    // Rust would read "nan" and "inf"; files must not hold them.
    value.filter(|v| v.is_finite()).ok_or_else(wrong)
}

/// A whole number.
pub(crate) fn whole(text: &str, what: &'static str) -> Result<i64, Problem> {
    text.trim().parse().map_err(|_| Problem::Whole { what, text: quote(text) })
}

/// Six directions 1 to 6; 0 at a scalar point.
pub(crate) fn component(text: &str) -> Result<u8, Problem> {
    match text.trim() {
        "" => Ok(0),
        word => word.parse().ok().filter(|&c| c <= 6).ok_or_else(|| Problem::Component { text: quote(word) }),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn every_way_to_write_a_number() {
        for (text, value) in [
            ("1.5", 1.5),
            (" -2.D3 ", -2e3),
            ("1.5+3", 1.5e3),
            ("-7.-2", -0.07),
            ("1.E-3", 1e-3),
            ("4", 4.0),
            (".5d+1", 5.0),
        ] {
            assert_eq!(real(text).unwrap(), value, "{text}");
        }
        for text in ["", "nan", "inf", "1.5+", "1,5", "E5", "1e999"] {
            assert!(real(text).is_err(), "{text}");
        }
    }
}
