//! Times of day, dates and spans of time as tables have them.

use super::number::number;

/// Seconds of `12:34:56.789`, `34:56.789` with or without a date in front; the date counts in days from 1970.
pub(crate) fn clock(text: &str) -> Option<f64> {
    if text.len() <= 12
        && let Some(days) = days(text)
    {
        return Some(days as f64 * 86400.0);
    }
    let (text, half) = half_of_day(text);
    let (days, time) = date_in_front(text)?;
    let time = dashed(time, days.is_some());
    let (time, ahead) = zone(&time);
    let mut parts = time.trim_end_matches('Z').split(':');
    let hours: u32 = digits(parts.next()?)?;
    let hours = half.map_or(hours, |half| hours % 12 + half);
    let minutes: u32 = digits(parts.next()?).filter(|&minutes| minutes < 60)?;
    let seconds = match parts.next() {
        Some(seconds) => number(&seconds.replace(',', "."), false).filter(|s| (0.0..61.0).contains(s))?,
        None => 0.0,
    };
    // Some write the milliseconds behind one more colon.
    let seconds = match parts.next() {
        Some(ms) if ms.len() == 3 && seconds.fract() == 0.0 => seconds + f64::from(digits(ms)?) * 1e-3,
        Some(_) => return None,
        None => seconds,
    };
    let days = days.unwrap_or(0);
    (parts.next().is_none() && hours < 100)
        .then(|| days as f64 * 86400.0 + f64::from(hours) * 3600.0 + f64::from(minutes) * 60.0 + seconds - ahead)
}

/// The days of a date in front of a time, and the time; none of a date that is none.
fn date_in_front(text: &str) -> Option<(Option<i64>, std::borrow::Cow<'_, str>)> {
    let splits = [text.split_once(' '), text.split_once('T'), text.rsplit_once(' ')];
    for (date, time) in splits.into_iter().flatten() {
        if let Some(days) = days(date.trim_end_matches(',')) {
            return Some((Some(days), time.trim().into()));
        }
    }
    // `20240301T120000.5` of ISO 8601.
    if let Some((date, time)) = text.split_once('T').filter(|(date, time)| date.len() == 8 && time.len() >= 6) {
        let cut = |text: &str, at: [usize; 2], sign: &str| {
            Some([text.get(..at[0])?, text.get(at[0]..at[1])?, text.get(at[1]..)?].join(sign))
        };
        return Some((Some(days(&cut(date, [4, 6], "-")?)?), cut(time, [2, 4], ":")?.into()));
    }
    (!text.contains(' ')).then(|| (None, text.into()))
}

/// Seconds of a span of time as MATLAB writes it, `0.25 sec`.
pub(super) fn span(text: &str) -> Option<f64> {
    let (value, unit) = text.split_once(' ')?;
    let seconds = match unit.trim().to_ascii_lowercase().as_str() {
        "s" | "sec" | "secs" | "second" | "seconds" => 1.0,
        "ms" | "msec" => 1e-3,
        "min" | "mins" => 60.0,
        "hr" | "hrs" | "h" => 3600.0,
        _ => return None,
    };
    number(value, false).filter(|value| value.is_finite()).map(|value| value * seconds)
}

/// A time behind a date that is written with strokes, `12-00-01_250` or `12-00-01.250`, with colons.
fn dashed(time: std::borrow::Cow<'_, str>, dated: bool) -> std::borrow::Cow<'_, str> {
    let plain = time.bytes().all(|byte| byte.is_ascii_digit() || matches!(byte, b'-' | b'_' | b'.'));
    if dated && plain && time.matches('-').count() == 2 {
        return time.replace('-', ":").replace('_', ".").into();
    }
    time
}

/// Seconds since 1970 as people write them, `2024-03-01 12:00:00`; of less than a day the time alone, of midnight the date.
pub(super) fn date_and_time(seconds: f64) -> String {
    let (days, rest) = ((seconds / 86400.0).floor(), seconds.rem_euclid(86400.0).floor() as u32);
    let time = format!("{:02}:{:02}:{:02}", rest / 3600, rest / 60 % 60, rest % 60);
    if days == 0.0 || days.abs() > 1e8 || days.is_nan() {
        return if days == 0.0 { time } else { seconds.to_string() };
    }
    // Richards' algorithm (Explanatory Supplement to the Astronomical Almanac, 15.11.3) from the Julian day number.
    let f = days as i64 + 2_440_588 + 1401;
    let f = f + (4 * (days as i64 + 2_440_588) + 274_277) / 146_097 * 3 / 4 - 38;
    let e = 4 * f + 3;
    let h = 5 * (e % 1461 / 4) + 2;
    let (day, month) = (h % 153 / 5 + 1, (h / 153 + 2) % 12 + 1);
    let year = e / 1461 - 4716 + (14 - month) / 12;
    let date = format!("{year}-{month:02}-{day:02}");
    if rest == 0 { date } else { format!("{date} {time}") }
}

/// A time without its zone (`+01:00`, `-0530`, `+02`), and how many seconds that is ahead of UTC.
fn zone(time: &str) -> (&str, f64) {
    let Some(at) = time.rfind(['+', '-']).filter(|&at| at >= 5) else { return (time, 0.0) };
    let plain: String = time[at + 1..].chars().filter(|c| *c != ':').collect();
    let read = |range: std::ops::Range<usize>| plain.get(range).and_then(digits);
    let (Some(hours), true) = (read(0..2), matches!(plain.len(), 2 | 4)) else { return (time, 0.0) };
    let seconds = f64::from(hours) * 3600.0 + f64::from(read(2..4).unwrap_or(0)) * 60.0;
    (time[..at].trim_end(), if time.as_bytes()[at] == b'-' { -seconds } else { seconds })
}

/// A time without `AM` or `PM` behind it, and the hours that these add.
fn half_of_day(text: &str) -> (&str, Option<u32>) {
    for (word, hours) in [("AM", 0), ("PM", 12)] {
        if let Some(at) = text.len().checked_sub(2)
            && text.is_char_boundary(at)
            && text[at..].eq_ignore_ascii_case(word)
        {
            return (text[..at].trim_end(), Some(hours));
        }
    }
    (text, None)
}

fn digits(text: &str) -> Option<u32> {
    (!text.is_empty() && text.len() <= 4 && text.bytes().all(|byte| byte.is_ascii_digit()))
        .then(|| text.parse().ok())?
}

/// Beginnings of the names of the months in English, German, French, Spanish and Italian, where they differ.
const MONTHS: [&[&str]; 12] = [
    &["jan", "ene", "gen"],
    &["feb", "fév", "fev"],
    &["mar", "mär", "mrz"],
    &["apr", "avr", "abr"],
    &["may", "mai", "mag"],
    &["jun", "juin", "giu"],
    &["jul", "juil", "lug"],
    &["aug", "aoû", "aou", "ago"],
    &["sep", "set"],
    &["oct", "okt", "ott"],
    &["nov"],
    &["dec", "dez", "déc", "dic"],
];

/// Year, month and day of `01-Mar-2024`, `1 March 2024`, `Mar 1, 2024`.
fn named_month(text: &str) -> Option<[u32; 3]> {
    let parts: Vec<&str> = text.split(['-', '/', '.', ' ', ',']).filter(|part| !part.is_empty()).collect();
    let month = |word: &str| {
        let word = word.to_lowercase();
        let is = |names: &[&str]| word.len() < 12 && names.iter().any(|name| word.starts_with(name));
        MONTHS.iter().position(|names| is(names)).map(|at| at as u32 + 1)
    };
    let [a, b, c] = parts[..] else { return None };
    let (day, month) = match digits(a) {
        Some(day) => (day, month(b)?),
        None => (digits(b)?, month(a)?),
    };
    Some([digits(c)?, month, day])
}

/// Days from 1970-01-01 of `2024-03-01`, `2024/03/01`, `01.03.2024`, `01-Mar-2024`; of `03/01/2024` too, where the month stands in
/// front.
fn days(text: &str) -> Option<i64> {
    if text.len() > 24 || !text.bytes().any(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let parts: Option<Vec<u32>> = text.split(['-', '/', '.']).map(digits).collect();
    let (year, month, day) = match (parts.as_deref(), named_month(text)) {
        (Some(&[a, month, c]), _) => ordered(a, month, c, text),
        (None, Some([year, month, day])) => (year, month, day),
        _ => return None,
    };
    if year < 100 || !(1..=12).contains(&month) || !(1..=31).contains(&day) {
        return None;
    }
    // Days of the civil calendar (Hinnant): years begin in March.
    let (year, month, day) = (i64::from(year) - i64::from(month <= 2), i64::from(month), i64::from(day));
    let era = year.div_euclid(400);
    let of_era = year.rem_euclid(400);
    let of_year = (153 * (month + if month > 2 { -3 } else { 9 }) + 2) / 5 + day - 1;
    Some(era * 146_097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719_468)
}

/// Year, month and day out of three numbers in the order of the date `text`.
fn ordered(a: u32, month: u32, c: u32, text: &str) -> (u32, u32, u32) {
    match (a > 31, text.contains('/') && a < 13) {
        (true, _) => (a, month, c),
        (_, true) => (c, a, month),
        _ => (c, month, a),
    }
}

#[cfg(test)]
mod tests {
    use super::super::cell::Cell;
    use super::*;

    #[test]
    fn clocks_and_dates() {
        assert_eq!(Cell::parse("1:02:03.5", false), Cell::Clock(3723.5));
        assert_eq!(Cell::parse("1970-01-02 00:00:01", false), Cell::Clock(86401.0));
        assert_eq!(Cell::parse("01/02/1970 12:00:01.5 AM", false), Cell::Clock(86401.5));
        assert_eq!(Cell::parse("1:00:00 pm", false), Cell::Clock(46800.0));
        assert_eq!(Cell::parse("0:00:01:250", false), Cell::Clock(1.25));
        assert_eq!(Cell::parse("1970-01-02 00-00-01_250", false), Cell::Clock(86401.25));
        assert_eq!(Cell::parse("1:02:03:4", false), Cell::Word("1:02:03:4".into()));
        assert_eq!(Cell::parse("1970-01-02T01:00:00.5+01:00", false), Cell::Clock(86400.5));
        assert_eq!(Cell::parse("1970-01-01 23:30:00-0030", false), Cell::Clock(86400.0));
        assert_eq!(Cell::parse("02.01.1970", false), Cell::Clock(86400.0));
        assert_eq!(Cell::parse("2000-03-01T00:00:00", false), Cell::Clock(11017.0 * 86400.0));
        assert_eq!(Cell::parse("02-Jan-1970 00:00:01.5", false), Cell::Clock(86401.5));
        assert_eq!(Cell::parse("Jan 2, 1970 12:00:01.5 AM", false), Cell::Clock(86401.5));
        assert_eq!(Cell::parse("2 Januar 1970 00:00:01", false), Cell::Clock(86401.0));
        assert_eq!(Cell::parse("19700102T000001.5", false), Cell::Clock(86401.5));
        assert_eq!((Cell::parse("0.25 sec", false), span("1 min")), (Cell::Span(0.25, "0.25 sec".into()), Some(60.0)));
        assert!(
            matches!(Cell::parse("5.2 N", false), Cell::Word(_))
                && matches!(Cell::parse("Run 2, 1970", false), Cell::Word(_))
        );
    }

    /// Every date that can be read is written as it was, by the reader's own count of days.
    #[test]
    fn dates_are_written_as_they_are_read() {
        for text in ["2024-03-01", "2000-02-29", "1970-01-02", "1999-12-31", "2024-12-31 23:59:58", "12:34:56"] {
            assert_eq!(date_and_time(clock(text).unwrap_or_default()), text);
        }
    }
}
