//! Numbers in words: as many digits as are known, counted things.

/// Decimal places that are written out for a number that is not small.
const MOST_PLACES: usize = 8;

/// `value +- deviation`, both to the digit that the deviation supports and under one power of ten; four significant digits
/// where the deviation is not known.
pub(crate) fn with_deviation(value: f64, deviation: f64) -> String {
    if deviation <= 0.0 || !deviation.is_finite() || !value.is_finite() {
        return significant(value, 4);
    }
    let power = value.abs().max(deviation).log10().floor() as i32;
    let places = decimals(deviation);
    let most = if power >= -3 { MOST_PLACES } else { 6 };
    if places <= most && power < 6 {
        return format!("{value:.places$} +- {deviation:.places$}");
    }
    let scale = 10f64.powi(-power);
    let places = decimals(deviation * scale);
    format!("({:.places$} +- {:.places$})e{power}", value * scale, deviation * scale)
}

/// `value` with `digits` significant digits, in plain notation between 1e-3 and 1e5, or as many digits, else as
/// `1.23e-7`; `-` for what is no number.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return "-".to_owned();
    }
    let rounded = format!("{value:.*e}", digits.saturating_sub(1));
    let exponent: i32 = rounded.rsplit('e').next().and_then(|e| e.parse().ok()).unwrap_or(0);
    // Plain as far as no digit that is not known would have to be written.
    if !(-3..(digits as i32).max(5)).contains(&exponent) {
        return rounded;
    }
    let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
    format!("{value:.decimals$}")
}

/// The same without zeros at the end of its decimals: `2560` for `2560.00`.
pub(crate) fn compact(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    let (number, power) = text.split_at(text.find('e').unwrap_or(text.len()));
    let short = if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number };
    format!("{short}{power}")
}

/// `value` rounded to `digits` significant digits.
pub(crate) fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// A number of things in words: `1 source`, `3 sources`.
pub(crate) fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// Decimal places at which a deviation has two digits.
fn decimals(deviation: f64) -> usize {
    (1.0 - deviation.log10().floor()).clamp(0.0, 12.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deviation_rules_the_digits() {
        assert_eq!(with_deviation(0.1072, 0.0021), "0.1072 +- 0.0021");
        assert_eq!(with_deviation(512.3, 13.0), "512 +- 13");
        assert_eq!(with_deviation(0.006_018, 5.8e-8), "(6.018000 +- 0.000058)e-3");
        assert_eq!(with_deviation(0.135_292_8, 2.8e-6), "0.1352928 +- 0.0000028");
        assert_eq!(with_deviation(0.006_018, 5.8e-7), "0.00601800 +- 0.00000058");
        assert_eq!(with_deviation(0.000_601_8, 5.8e-7), "(6.0180 +- 0.0058)e-4");
        assert_eq!(with_deviation(-1.2347e8, 2.1e6), "(-1.235 +- 0.021)e8");
        assert_eq!(with_deviation(3.0, 0.0), "3.000");
        assert_eq!(with_deviation(3.0, f64::INFINITY), "3.000");
    }

    #[test]
    fn numbers_keep_their_significant_digits() {
        assert_eq!(significant(0.107_23, 4), "0.1072");
        assert_eq!(significant(-6.505, 4), "-6.505");
        assert_eq!(significant(12_345.6, 4), "12346");
        assert_eq!(significant(9.9996, 4), "10.00");
        assert_eq!(significant(2.1e-9, 3), "2.10e-9");
        assert_eq!(significant(0.0, 3), "0");
        assert_eq!(significant(f64::NAN, 3), "-");
        assert_eq!(significant(102_400.3, 6), "102400");
        assert_eq!(significant(102_400.3, 4), "1.024e5");
    }

    #[test]
    fn zeros_at_the_end_are_left_out_and_what_is_rounded_has_no_more_digits() {
        let written = [2560.0, 0.0125, -3.0e-7, 1_234.567_89, 200.0, 0.0].map(|value| compact(value, 6));
        assert_eq!(written, ["2560", "0.0125", "-3e-7", "1234.57", "200", "0"]);
        assert_eq!(rounded(1000.0 * 0.56, 12), 560.0);
        assert!(rounded(f64::NAN, 12).is_nan());
    }
}
