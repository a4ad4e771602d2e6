//! A cell of a table: a number, complex number, clock time, word, or nothing.

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
    /// Anything else.
    Word(String),
}

impl Cell {
    pub(crate) fn is_empty(&self) -> bool {
        *self == Self::Empty
    }

    pub(crate) fn is_number(&self) -> bool {
        matches!(self, Self::Real(_) | Self::Complex(_) | Self::Clock(_))
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

/// Seconds of `12:34:56.789`, `34:56.789` with or without a date in front; the date counts in days from 1970.
pub(crate) fn clock(text: &str) -> Option<f64> {
    if text.len() <= 10
        && let Some(days) = days(text)
    {
        return Some(days as f64 * 86400.0);
    }
    let (text, half) = half_of_day(text);
    let (date, time) = match text.split_once([' ', 'T']) {
        Some((date, time)) => (Some(date.trim_end_matches(',')), time.trim()),
        None => (None, text),
    };
    let (time, ahead) = zone(time);
    let mut parts = time.trim_end_matches('Z').split(':');
    let hours: u32 = digits(parts.next()?)?;
    let hours = half.map_or(hours, |half| hours % 12 + half);
    let minutes: u32 = digits(parts.next()?).filter(|&minutes| minutes < 60)?;
    let seconds = match parts.next() {
        Some(seconds) => number(&seconds.replace(',', "."), false).filter(|s| (0.0..61.0).contains(s))?,
        None => 0.0,
    };
    let days = date.map_or(Some(0), days)?;
    (parts.next().is_none() && hours < 100)
        .then(|| days as f64 * 86400.0 + f64::from(hours) * 3600.0 + f64::from(minutes) * 60.0 + seconds - ahead)
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

/// Days from 1970-01-01 of `2024-03-01`, `2024/03/01`, `01.03.2024`; of `03/01/2024` too, where the month stands in front.
fn days(text: &str) -> Option<i64> {
    let parts: Vec<u32> = text.split(['-', '/', '.']).map(digits).collect::<Option<_>>()?;
    let [a, month, c] = parts[..] else { return None };
    let (year, month, day) = match (a > 31, text.contains('/') && a < 13) {
        (true, _) => (a, month, c),
        (_, true) => (c, a, month),
        _ => (c, month, a),
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
    fn complex_numbers_and_clocks() {
        assert_eq!(Cell::parse("(-0.5+2.6838e-08j)", false), Cell::Complex([-0.5, 2.6838e-8]));
        assert_eq!(Cell::parse("1.5 - 2i", false), Cell::Complex([1.5, -2.0]));
        assert_eq!(Cell::parse("1:02:03.5", false), Cell::Clock(3723.5));
        assert_eq!(Cell::parse("1970-01-02 00:00:01", false), Cell::Clock(86401.0));
        assert_eq!(Cell::parse("01/02/1970 12:00:01.5 AM", false), Cell::Clock(86401.5));
        assert_eq!(Cell::parse("1:00:00 pm", false), Cell::Clock(46800.0));
        assert_eq!(Cell::parse("1970-01-02T01:00:00.5+01:00", false), Cell::Clock(86400.5));
        assert_eq!(Cell::parse("1970-01-01 23:30:00-0030", false), Cell::Clock(86400.0));
        assert_eq!(Cell::parse("02.01.1970", false), Cell::Clock(86400.0));
        assert_eq!(Cell::parse("1.2.3", false), Cell::Word("1.2.3".into()));
        assert_eq!(Cell::parse("2000-03-01T00:00:00", false), Cell::Clock(11017.0 * 86400.0));
    }

    /// Every date that can be read is written as it was, by the reader's own count of days.
    #[test]
    fn dates_are_written_as_they_are_read() {
        for text in ["2024-03-01", "2000-02-29", "1970-01-02", "1999-12-31", "2024-12-31 23:59:58", "12:34:56"] {
            assert_eq!(date_and_time(clock(text).unwrap_or_default()), text);
        }
    }
}
