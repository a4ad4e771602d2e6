//! Numbers on the screen: with the decimal sign of the language. What is typed may have either sign; files and tables that are copied
//! keep the point.

use super::chosen::{Language, now};
use crate::display::format;
use egui::emath::format_with_decimals_in_range;
use std::borrow::Cow;
use std::ops::RangeInclusive;

/// A text with the decimal sign of this thread's language.
pub(crate) fn local(text: &str) -> Cow<'_, str> {
    if now() == Language::English || !text.contains('.') { Cow::Borrowed(text) } else { Cow::Owned(with_commas(text)) }
}

/// The decimal points of all numbers as commas. What only looks like one stays: names of files (`run-0.5.csv`), versions (`0.1.0`).
pub(super) fn with_commas(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let mut out = String::with_capacity(text.len());
    for (k, &letter) in letters.iter().enumerate() {
        out.push(if letter == '.' && is_decimal(&letters, k) { ',' } else { letter });
    }
    out
}

/// Whether the point at `at` is the only one of a number that stands alone.
fn is_decimal(letters: &[char], at: usize) -> bool {
    let part = |c: &char| c.is_ascii_digit() || *c == '.';
    let start = at - letters[..at].iter().rev().take_while(|c| part(c)).count();
    let mut end = at + letters[at..].iter().take_while(|c| part(c)).count();
    // The point at the end of a sentence.
    if end > at + 1 && letters[end - 1] == '.' {
        end -= 1;
    }
    let digits = start < at && end > at + 1;
    let alone = letters[start..end].iter().filter(|c| **c == '.').count() == 1;
    let name = |c: char| c.is_alphanumeric() || "_@/\\".contains(c);
    let before = start.checked_sub(1).map(|k| letters[k]);
    let hyphen = before == Some('-') && start >= 2 && name(letters[start - 2]) && letters[start - 2] != 'e';
    let after = letters.get(end).copied();
    let power = after == Some('e') && letters.get(end + 1).is_some_and(|c| c.is_ascii_digit() || "-−+".contains(*c));
    digits && alone && !hyphen && !before.is_some_and(name) && (power || !after.is_some_and(name))
}

/// A number with so many decimals as egui asks for, in the language of this thread.
pub(crate) fn formatted(value: f64, decimals: RangeInclusive<usize>) -> String {
    local(&format_with_decimals_in_range(value, decimals)).into_owned()
}

/// A number as it was typed: with a comma or a point, a hyphen or a minus.
pub(crate) fn typed(text: &str) -> Option<f64> {
    text.trim().replace('−', "-").replace(',', ".").parse().ok()
}

/// A value as it is edited, in the language of this thread.
pub(crate) fn editable(value: f64) -> String {
    local(&format::editable(value)).into_owned()
}

#[cfg(test)]
mod tests {
    use super::{editable, local, typed, with_commas};
    use crate::window::language::{Language, choose};

    #[test]
    fn points_of_numbers_only() {
        for (english, german) in [
            ("0.1072 ± 0.0021 N·s/m", "0,1072 ± 0,0021 N·s/m"),
            ("(−6.00 ± 0.05)e−3 m", "(−6,00 ± 0,05)e−3 m"),
            ("2.1e−9", "2,1e−9"),
            ("+1.5 %, <0.01 %", "+1,5 %, <0,01 %"),
            ("error 43.2 %. It is 2.5.", "error 43,2 %. It is 2,5."),
            ("1.2–3.4", "1,2–3,4"),
            ("1.5e-3", "1,5e-3"),
            ("χ² 1.05 per row", "χ² 1,05 per row"),
        ] {
            assert_eq!(with_commas(english), german);
        }
        for name in ["run-0.5.csv", "0.1.0", "acc@7.5", "a1.5", "run-01.csv", "file 2.mat", "x_0.5", "1.5V", "end 7."] {
            assert_eq!(with_commas(name), name);
        }
    }

    #[test]
    fn what_is_typed_may_have_either_sign() {
        assert_eq!(typed(" −1,5e-3 "), Some(-1.5e-3));
        assert_eq!(typed("1.5"), Some(1.5));
        assert_eq!(typed("1,5,2"), None);
        choose(Language::German);
        assert_eq!(editable(-0.004), "−0,004");
        assert_eq!(typed(&editable(-13.066_184_254)), Some(-13.066_184_25));
        choose(Language::English);
        assert_eq!(local("0.5"), "0.5");
        assert_eq!(editable(-0.004), "−0.004");
    }
}
