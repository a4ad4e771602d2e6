//! Whether stored abscissae are even, and which names mean time or frequency.

use crate::contents::Kind;

/// Largest deviation of a value from its place on an even abscissa, in steps: clocks jitter, and printed times are rounded.
const JITTER: f64 = 0.01;

/// Mean step where the values are even.
pub(crate) fn even_step(values: &[f64]) -> Option<f64> {
    let (first, last) = (*values.first()?, *values.last()?);
    let steps = values.len().checked_sub(1).filter(|&steps| steps > 0)? as f64;
    let step = (last - first) / steps;
    let even = |(i, value): (usize, &f64)| (value - (first + i as f64 * step)).abs() <= JITTER * step.abs();
    (step != 0.0 && step.is_finite() && values.iter().enumerate().all(even)).then(|| short(step))
}

/// The decimal number of twelve digits nearest to a step, where the step is it but for rounding.
fn short(step: f64) -> f64 {
    match format!("{step:.11e}").parse::<f64>() {
        Ok(decimal) if (decimal - step).abs() <= 1e-12 * step.abs() => decimal,
        _ => step,
    }
}

/// Whether values never go back.
pub(crate) fn ascending(values: &[f64]) -> bool {
    values.windows(2).all(|pair| pair[1] >= pair[0]) && values.iter().all(|value| value.is_finite())
}

/// The unit of times that count from 1970 (2001 to 2099) by their size, where they are not in seconds.
pub(crate) fn unit_since_1970(first: f64) -> Option<&'static str> {
    let seconds = 978_307_200.0..4_102_444_800.0;
    [("ms", 1e3), ("us", 1e6), ("ns", 1e9)]
        .into_iter()
        .find(|(_, scale)| seconds.contains(&(first / scale)))
        .map(|(unit, _)| unit)
}

/// Time or frequency by the name or the unit of a column.
pub(crate) fn kind_of(name: &str, unit: &str) -> Option<Kind> {
    let name = name.trim().to_lowercase();
    let unit = unit.trim().to_lowercase();
    let word = name.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
    if matches!(unit.as_str(), "hz" | "khz" | "rad/s")
        && (name.is_empty() || word == "x" || word.starts_with('f') || word.starts_with("om"))
    {
        return Some(Kind::Spectrum);
    }
    if word.starts_with("freq")
        || matches!(name.as_str(), "f" | "hz" | "frekvens" | "omega" | "ω" | "freqs")
        || matches!(word, "frequenz" | "fréquence" | "frecuencia" | "frequenza" | "fhz")
    {
        return Some(Kind::Spectrum);
    }
    let is_time = |word: &str| TIMES.iter().any(|start| word.starts_with(start));
    if is_time(word) || name == "t" || name == "x_value" || name == "t_s" {
        return Some(Kind::Time);
    }
    if unit_of_time(&name).is_some() {
        return Some(Kind::Time);
    }
    // `Total Time [s]`, `Ch 1 Time [Sec]`: the unit says that the word further behind is meant.
    let timed = || name.split(|c: char| !c.is_alphabetic()).any(is_time);
    (is_second(&unit) && (name.is_empty() || word == "x" || word == "t" || timed())).then_some(Kind::Time)
}

/// Beginnings of words for times.
const TIMES: [&str; 8] = ["time", "zeit", "temps", "tiempo", "tempo", "timestamp", "elapsed", "uhrzeit"];

fn is_second(unit: &str) -> bool {
    matches!(unit, "s" | "sec" | "secs" | "second" | "seconds" | "ms" | "us" | "µs" | "ns" | "min")
}

/// The unit of times that a name is: `millis` of a microcontroller, `seconds_elapsed`.
pub(crate) fn unit_of_time(name: &str) -> Option<&'static str> {
    let name = name.trim().to_lowercase();
    let parts: Vec<&str> = name.split(|c: char| !c.is_alphanumeric()).filter(|part| !part.is_empty()).collect();
    let [first, rest @ ..] = &parts[..] else { return None };
    if !rest.iter().all(|part| matches!(*part, "elapsed" | "since" | "start")) {
        return None;
    }
    match *first {
        "seconds" | "secs" | "sec" => Some("s"),
        "millis" | "milliseconds" | "millisec" | "msec" | "msecs" => Some("ms"),
        "micros" | "microseconds" | "microsec" | "usec" | "usecs" => Some("us"),
        "nanos" | "nanoseconds" | "nsec" => Some("ns"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn steps_are_even_within_the_digits_that_were_written() {
        assert_eq!(even_step(&[0.0, 0.1, 0.2, 0.30000000000000004]), Some(0.1));
        assert_eq!(
            even_step(&[0.0, 0.0009765625, 0.001953125, 0.002929688]).map(|step| (step * 1e7).round()),
            Some(9766.0)
        );
        assert_eq!(even_step(&[0.0, 0.1, 0.3]), None);
        assert_eq!(even_step(&[1.0]), None);
    }

    #[test]
    fn times_since_1970_show_their_unit() {
        let unit_of = |first: f64| unit_since_1970(first).unwrap_or("s");
        assert_eq!([1.7e9, 1.7e12, 1.7e15, 1.7e18, 0.0, 5e4].map(unit_of), ["s", "ms", "us", "ns", "s", "s"]);
    }

    #[test]
    fn names_of_abscissae() {
        assert_eq!(kind_of("Zeit", "s"), Some(Kind::Time));
        assert_eq!(kind_of("Frequency", "Hz"), Some(Kind::Spectrum));
        assert_eq!(kind_of("force", "N"), None);
        assert_eq!(kind_of("X-axis", "Hz"), Some(Kind::Spectrum));
        assert_eq!(kind_of("period", "s"), None);
        assert_eq!(kind_of("Total Time", "s"), Some(Kind::Time));
        assert_eq!(kind_of("Ch 1 Time", "Sec"), Some(Kind::Time));
        assert_eq!((kind_of("Ch 1 Time", "N"), kind_of("Overtime", "s")), (None, None));
        assert_eq!((kind_of("seconds_elapsed", ""), unit_of_time("millis")), (Some(Kind::Time), Some("ms")));
        assert_eq!((kind_of("second acc", "g"), kind_of("sec. acc", "g")), (None, None));
    }
}
