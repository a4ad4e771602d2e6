//! Numbers in words: three to four significant digits, always with a unit.

use super::units;
use crate::math::numerals;

/// `value` with `digits` significant digits, in plain notation between 1e-3 and 1e5, else as `1.23e−7` with a real minus; a dash
/// for what is no number.
pub fn significant(value: f64, digits: usize) -> String {
    if value.is_finite() { numerals::significant(value, digits).replace('-', "−") } else { "–".to_owned() }
}

/// A value as it is edited: to ten digits, in powers of ten where it is very large or very small.
pub fn editable(value: f64) -> String {
    let value = numerals::rounded(value, 10);
    let plain = value == 0.0 || (1e-4..1e6).contains(&value.abs());
    let text = if plain { format!("{value}") } else { format!("{value:e}") };
    text.replace('-', "−")
}

/// A value to twelve significant digits.
pub fn rounded(value: f64) -> f64 {
    numerals::rounded(value, 12)
}

/// `value` with four significant digits and `unit`.
pub fn with_unit(value: f64, unit: &str) -> String {
    let (factor, unit) = units::shown(unit);
    let number = significant(factor * value, 4);
    if unit.is_empty() { number } else { format!("{number} {}", pretty_unit(&unit)) }
}

/// `value ± deviation unit`, both to the digit that the deviation supports and under one power of ten.
pub fn with_deviation(value: f64, deviation: f64, unit: &str) -> String {
    let (factor, unit) = units::shown(unit);
    let numbers = numerals::with_deviation(factor * value, factor * deviation).replace("+-", "±").replace('-', "−");
    format!("{numbers} {}", pretty_unit(&unit)).trim_end().to_owned()
}

/// Significant digits of a value in a column of its own that the deviation beside it supports: two to four.
pub fn supported(value: f64, deviation: f64) -> usize {
    if deviation <= 0.0 || value == 0.0 || !deviation.is_finite() {
        return 4;
    }
    (value.abs().log10().floor() - deviation.log10().floor() + 2.0).clamp(2.0, 4.0) as usize
}

/// A difference with its deviation and its sign: `+0.20 ± 0.04 %`; what is rounded to nothing has none.
pub fn signed(value: f64, deviation: f64, unit: &str) -> String {
    let text = with_deviation(value, deviation, unit);
    let unsigned = text.trim_start_matches('−');
    let zero = unsigned.split(' ').next().and_then(|v| v.parse::<f64>().ok()) == Some(0.0);
    match value {
        _ if zero => unsigned.to_owned(),
        v if v > 0.0 => format!("+{text}"),
        _ => text,
    }
}

/// An SI unit with dots and superscripts, from its spelling in ASCII: `N s^2/m^2` to `N·s²/m²`; `(m/s^2)/(N)` to `m/s²/N`.
pub fn pretty_unit(unit: &str) -> String {
    let unit = match unit.strip_suffix(')').and_then(|unit| unit.rsplit_once("/(")) {
        Some((above, below)) if !below.contains(['/', ' ', ')']) => &format!("{above}/{below}"),
        _ => unit,
    };
    let unit = match unit.strip_prefix('(').and_then(|unit| unit.split_once(")/")) {
        Some((above, below)) if !above.contains(['(', ')']) => &format!("{above}/{below}"),
        _ => unit,
    };
    unit.replace("^2", "²").replace("^3", "³").replace(' ', "·")
}

/// `value` (in the base unit) with a prefix from n to G: `1.23 mJ`.
pub fn prefixed(value: f64, unit: &str) -> String {
    const PREFIXES: [(f64, &str); 7] =
        [(1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n")];
    let (factor, shown) = units::shown(unit);
    if shown != unit {
        return format!("{} {}", significant(factor * value, 3), pretty_unit(&shown));
    }
    if value == 0.0 || !value.is_finite() {
        return format!("{} {unit}", significant(value, 3));
    }
    let (scale, prefix) = PREFIXES.into_iter().find(|(scale, _)| value.abs() >= 0.9995 * scale).unwrap_or((1e-9, "n"));
    format!("{} {prefix}{unit}", significant(value / scale, 3))
}

/// A share as per cent.
pub fn percent(share: f64) -> String {
    let p = 100.0 * share;
    if p != 0.0 && p.abs() < 0.01 { "<0.01 %".to_owned() } else { format!("{} %", significant(p, 3)) }
}

/// An error in words; beyond ten times the measurement its size says nothing more.
pub fn in_words(error: f64) -> String {
    if error > 10.0 { "> 1000 %".to_owned() } else { percent(error) }
}

/// A probability to the digits that mean something.
pub fn chance(probability: f64) -> String {
    match 100.0 * probability {
        p if p > 99.9 => "> 99.9 %".to_owned(),
        p if p < 0.1 => "< 0.1 %".to_owned(),
        p if p < 10.0 => format!("{p:.1} %"),
        p => format!("{p:.0} %"),
    }
}

/// A sentence of the engine in the typography of readers: real signs and superscripts.
pub fn polished(sentence: &str) -> String {
    let mut text = sentence.replace("+-", "±").replace("^2", "²").replace("^3", "³");
    for digit in '0'..='9' {
        text = text
            .replace(&format!(" -{digit}"), &format!(" −{digit}"))
            .replace(&format!("e-{digit}"), &format!("e−{digit}"));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{
        chance, editable, percent, polished, prefixed, pretty_unit, significant, supported, with_deviation, with_unit,
    };

    #[test]
    fn numbers_have_real_signs() {
        assert_eq!(significant(-6.505, 4), "−6.505");
        assert_eq!(significant(2.1e-9, 3), "2.10e−9");
        assert_eq!(significant(f64::NAN, 3), "–");
        assert_eq!(with_deviation(-6e-3, 5.8e-8, "m"), "(−6.000000 ± 0.000058)e−3 m");
    }

    #[test]
    fn what_is_edited_keeps_all_its_digits() {
        assert_eq!(editable(0.004), "0.004");
        assert_eq!(editable(69e9), "6.9e10");
        assert_eq!(editable(-2.1e-12), "−2.1e−12");
        assert_eq!(editable(7850.0), "7850");
        assert_eq!(editable(13.066_184_254), "13.06618425");
        assert_eq!(editable(16.999_892_204_851_99), "16.9998922");
    }

    #[test]
    fn conversions_leave_no_digits_behind() {
        assert_eq!(super::rounded(1000.0 * 0.56), 560.0);
        assert!(super::rounded(f64::NAN).is_nan());
    }

    #[test]
    fn units_follow_their_numbers() {
        assert_eq!(with_unit(0.2, "N s/m"), "0.2000 N·s/m");
        assert_eq!(pretty_unit("N s^2/m^2"), "N·s²/m²");
        assert_eq!(pretty_unit("(m/s^2)/(N)"), "m/s²/N");
        assert_eq!(pretty_unit("(m/s^2)/(N m)"), "m/s²/(N·m)");
        assert_eq!(with_deviation(0.1072, 0.0021, "N s/m"), "0.1072 ± 0.0021 N·s/m");
        assert_eq!(with_deviation(512.3, 13.0, "N"), "512 ± 13 N");
        assert_eq!(with_deviation(3.0, 0.0, "N"), "3.000 N");
        assert_eq!(prefixed(0.001_234, "J"), "1.23 mJ");
        assert_eq!(prefixed(2.11e11, "Pa"), "211 GPa");
        assert_eq!(percent(0.000_02), "<0.01 %");
        assert_eq!(percent(0.4567), "45.7 %");
    }

    #[test]
    fn a_value_beside_its_deviation_has_the_digits_that_it_supports() {
        assert_eq!(supported(4.927_91, 0.000_14), 4);
        assert_eq!(supported(4.927_91, 0.14), 3);
        assert_eq!(supported(4.927_91, 7.0), 2);
        assert_eq!(supported(0.02, 0.0), 4);
    }

    #[test]
    fn probabilities_are_not_more_certain_than_they_are() {
        assert_eq!(chance(1.0), "> 99.9 %");
        assert_eq!(chance(0.973), "97 %");
        assert_eq!(chance(0.02), "2.0 %");
        assert_eq!(chance(1e-9), "< 0.1 %");
    }

    #[test]
    fn sentences_have_real_signs() {
        assert_eq!(polished("to the power -0.99 +- 0.01; 2e-3 N s^2/m^2"), "to the power −0.99 ± 0.01; 2e−3 N s²/m²");
    }
}
