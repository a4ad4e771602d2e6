//! Which words are units, for telling a row of units from a row of names and `name [unit]` from a name.

/// Units that measuring systems write, in lower case without blanks. A bracket at the end of a name counts as its unit
/// whatever is in it; this list is for what stands without brackets.
const UNITS: &[&str] = &[
    "s",
    "sec",
    "secs",
    "second",
    "seconds",
    "ms",
    "us",
    "µs",
    "ns",
    "min",
    "h",
    "hz",
    "khz",
    "rad/s",
    "1/s",
    "rpm",
    "n",
    "kn",
    "mn",
    "lbf",
    "lb",
    "kgf",
    "nm",
    "n.m",
    "n*m",
    "n-m",
    "knm",
    "nmm",
    "ncm",
    "m/s^2",
    "m/s2",
    "m/s**2",
    "m/(s^2)",
    "m/s/s",
    "m/sec^2",
    "m/sec2",
    "ms-2",
    "ms^-2",
    "m*s-2",
    "m*s^-2",
    "mm/s^2",
    "mm/s2",
    "in/s^2",
    "ft/s^2",
    "g",
    "gn",
    "g_n",
    "g's",
    "gs",
    "mg",
    "m/s",
    "mm/s",
    "cm/s",
    "um/s",
    "µm/s",
    "μm/s",
    "km/h",
    "in/s",
    "ips",
    "m",
    "mm",
    "cm",
    "um",
    "µm",
    "μm",
    "nm.",
    "km",
    "in",
    "inch",
    "mil",
    "mils",
    "ft",
    "rad",
    "deg",
    "°",
    "mrad",
    "degrees",
    "rad/s^2",
    "rad/s2",
    "deg/s",
    "°/s",
    "v",
    "mv",
    "µv",
    "uv",
    "volt",
    "volts",
    "a",
    "ma",
    "pa",
    "kpa",
    "mpa",
    "gpa",
    "bar",
    "mbar",
    "psi",
    "db",
    "°c",
    "degc",
    "c",
    "k",
    "°f",
    "strain",
    "ue",
    "µe",
    "ustrain",
    "microstrain",
    "um/m",
    "µm/m",
    "%",
    "-",
    "none",
    "eu",
    "w",
    "kw",
    "j",
    "kg",
    "-/-",
    "m/n",
    "mm/n",
    "m/s/n",
    "m/s^2/n",
    "(m/s^2)/n",
    "(m/s2)/n",
    "(m/s)/n",
    "g/n",
    "g/lbf",
    "n/m",
    "n/mm",
    "counts",
    "ohm",
    "hz^2",
    "g^2/hz",
    "(m/s^2)^2/hz",
];

/// Whether a word is a unit by itself; brackets around it do not matter.
pub fn is_unit(word: &str) -> bool {
    let plain = stripped(word.trim());
    let plain: String = plain.chars().filter(|c| !c.is_whitespace()).collect::<String>().to_lowercase();
    // Raised signs and dots as they are typed: `m·s⁻²` is `m*s-2`.
    let plain = plain.replace('⁻', "-").replace('²', "2").replace('·', "*");
    UNITS.contains(&plain.as_str()) || is_ratio(&plain) || reference_of_decibel(&plain).is_some()
}

/// Whether a text without blanks is one unit over another: `(m/s^2)/lbf`, `mm/kN`, `(1/N)*(m/s²)`, `1/kg`.
fn is_ratio(plain: &str) -> bool {
    let plain = stripped(plain);
    // Words that only look like one unit over another: serial number, not available, converters.
    if matches!(plain, "s/n" | "n/a" | "a/c" | "n/c") {
        return false;
    }
    let inverse = plain.strip_prefix("(1/").or_else(|| plain.strip_prefix("1/"));
    if let Some(rest) = inverse {
        let (under, over) = rest.split_once('*').unwrap_or((rest, "m"));
        return is_side(under.trim_end_matches(')')) && is_side(over);
    }
    plain.rsplit_once('/').is_some_and(|(over, under)| is_side(over) && is_side(under))
}

fn is_side(text: &str) -> bool {
    UNITS.contains(&stripped(text)) && !matches!(stripped(text), "-" | "none")
}

/// Unit and value of the magnitude at 0 dB of a unit such as `dB`, `dB re 1 m/s²/N`, `dB(g/N)`, `dB rel. 1e-6 m/N`; none
/// for other units.
pub fn reference_of_decibel(unit: &str) -> Option<(String, f64)> {
    let unit = unit.trim();
    let head = unit.get(..2).filter(|head| head.eq_ignore_ascii_case("db"))?;
    let rest = unit[head.len()..].trim();
    let rest = stripped(rest.trim_start_matches(['/', ',', ':']).trim());
    let lower = rest.to_lowercase();
    let word =
        ["reference", "relative", "ref.", "ref", "rel.", "rel", "re."].iter().find(|word| lower.starts_with(**word));
    let word = word.or_else(|| ["re"].iter().find(|word| lower.starts_with(**word)));
    let rest = rest[word.map_or(0, |word| word.len())..].trim_start_matches([':', '=']).trim();
    let number = rest.find(|c: char| !matches!(c, '0'..='9' | '.' | '-' | '+' | 'e' | 'E')).unwrap_or(rest.len());
    // `1/kg` and `1g`: digits may belong to the unit or stand right in front of it.
    let (number, unit) = if rest[number..].starts_with('/') { ("", rest) } else { rest.split_at(number) };
    let value = if number.is_empty() { 1.0 } else { number.parse().ok()? };
    let unit = stripped(unit.trim());
    let known = unit.is_empty() || word.is_some() || is_unit(unit);
    (known && value > 0.0 && f64::is_finite(value)).then(|| (unit.to_owned(), value))
}

/// The text without one pair of brackets around it.
pub(crate) fn stripped(text: &str) -> &str {
    for (open, close) in [('[', ']'), ('(', ')'), ('{', '}')] {
        if let Some(inner) = text.strip_prefix(open).and_then(|rest| rest.strip_suffix(close)) {
            // `(m/s)/(N)` begins and ends with brackets that are no pair.
            if !inner.contains([open, close]) {
                return inner.trim();
            }
        }
    }
    text
}

/// Splits `name [unit]`, `name (unit)` or `name / unit` into name and unit; round brackets and strokes count only around
/// words that are units.
pub fn split(text: &str) -> (String, String) {
    let text = text.trim();
    if let Some((name, unit)) = bracketed(text, '[', ']') {
        return (name, unit);
    }
    if let Some((name, unit)) = bracketed(text, '(', ')').filter(|(_, unit)| is_unit(unit)) {
        return (name, unit);
    }
    if let Some((name, unit)) = text.split_once(" / ").filter(|(_, unit)| is_unit(unit)) {
        return (name.trim().to_owned(), unit.trim().to_owned());
    }
    if let Some((name, unit)) = text.rsplit_once(" in ").filter(|(name, unit)| is_unit(unit) && !name.trim().is_empty())
    {
        return (name.trim().to_owned(), unit.trim().to_owned());
    }
    if let Some((name, unit)) = text.rsplit_once(',').filter(|(name, unit)| is_unit(unit) && !name.trim().is_empty()) {
        return (name.trim().to_owned(), unit.trim().to_owned());
    }
    (text.to_owned(), String::new())
}

/// Words that begin names of time, frequency, force and motion, whose last part may be a unit.
const MEASURED: &[&str] = &[
    "t",
    "time",
    "timestamp",
    "epoch",
    "elapsed",
    "zeit",
    "f",
    "freq",
    "force",
    "kraft",
    "load",
    "a",
    "acc",
    "accel",
    "acceleration",
    "beschl",
    "v",
    "vel",
    "velocity",
    "d",
    "x",
    "y",
    "z",
    "disp",
    "displacement",
    "weg",
    "pos",
    "position",
    "frequency",
    "hammer",
    "input",
    "output",
];

/// Units behind a name of time, force or motion in its last parts: `acc_mg`, `force_N`, `acceleration_m_s2`: the name without
/// the unit, and the unit.
pub fn suffix(name: &str) -> Option<(&str, &'static str)> {
    const ENDS: [(&str, &str); 26] = [
        ("_m_s2", "m/s^2"),
        ("_mm_s2", "mm/s^2"),
        ("_m_s_2", "m/s^2"),
        ("_ms2", "m/s^2"),
        ("_mps2", "m/s^2"),
        ("_m/s2", "m/s^2"),
        ("_m/s^2", "m/s^2"),
        ("_mm_s", "mm/s"),
        ("_m_s", "m/s"),
        ("_mg", "mg"),
        ("_g", "g"),
        ("_kN", "kN"),
        ("_mN", "mN"),
        ("_N", "N"),
        ("_lbf", "lbf"),
        ("_mm", "mm"),
        ("_um", "um"),
        ("_m", "m"),
        ("_in", "in"),
        ("_ms", "ms"),
        ("_us", "us"),
        ("_ns", "ns"),
        ("_s", "s"),
        ("_sec", "s"),
        ("_mV", "mV"),
        ("_V", "V"),
    ];
    let (end, unit) = ENDS.into_iter().find(|(end, _)| name.ends_with(end))?;
    let front = &name[..name.len() - end.len()];
    let word = front.split(|c: char| !c.is_alphabetic()).next().unwrap_or_default().to_lowercase();
    MEASURED.contains(&word.as_str()).then_some((front, unit))
}

/// A sensitivity such as `22.5 mV/N` or `100mV/(m/s²)` anywhere in a text: the number, the unit over the stroke, the unit
/// under it.
pub fn sensitivity(text: &str) -> Option<(f64, String, String)> {
    for (at, letter) in text.char_indices() {
        let before = text[..at].chars().next_back();
        if !letter.is_ascii_digit() || before.is_some_and(|c| c.is_alphanumeric() || matches!(c, '.' | ',')) {
            continue;
        }
        let rest = &text[at..];
        let end =
            rest.find(|c: char| !matches!(c, '0'..='9' | '.' | ',' | 'e' | 'E' | '-' | '+')).unwrap_or(rest.len());
        let Ok(value) = rest[..end].replace(',', ".").parse::<f64>() else { continue };
        let Some((over, under)) = rest[end..].trim_start().split_once('/') else { continue };
        let over = over.trim();
        if !matches!(over.to_lowercase().as_str(), "mv" | "v" | "pc" | "uv" | "µv") {
            continue;
        }
        // The unit goes as far as it is one.
        let under = under.trim_start();
        let cuts = under.char_indices().map(|(i, c)| i + c.len_utf8()).collect::<Vec<_>>();
        let unit = cuts.into_iter().rev().map(|cut| under[..cut].trim()).find(|unit| is_unit(unit));
        if let Some(unit) = unit.filter(|_| value > 0.0) {
            return Some((value, over.to_owned(), stripped(unit).to_owned()));
        }
    }
    None
}

fn bracketed(text: &str, open: char, close: char) -> Option<(String, String)> {
    let inner = text.strip_suffix(close)?;
    let at = opening(inner, open, close)?;
    // `a4/(m/s²)`: the stroke is no part of the name.
    let name = inner[..at].trim().trim_end_matches('/').trim();
    Some((name.to_owned(), inner[at + open.len_utf8()..].trim().to_owned()))
}

/// Place of the bracket that the one behind the text closes: `dB (m/s²)/N` within brackets has some of its own.
fn opening(inner: &str, open: char, close: char) -> Option<usize> {
    let mut depth = 1;
    for (i, c) in inner.char_indices().rev() {
        depth += i32::from(c == close) - i32::from(c == open);
        if depth == 0 {
            return Some(i);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_and_levels_are_units() {
        assert!(
            ["(m/s^2)/lbf", "mm/kN", "1/kg", "(1/N)*(m/s²)", "dB re 1 m/s²/N", "dB"].iter().all(|unit| is_unit(unit))
        );
        assert!(
            !["12:+Z/1:+Z", "H/T", "S/N", "N/A", "acc@7/force@19", "debug", "1/7"].iter().any(|unit| is_unit(unit))
        );
        let db = |unit| reference_of_decibel(unit);
        assert_eq!(db("dB"), Some((String::new(), 1.0)));
        assert_eq!(db("dB re 1 m/s²/N"), Some(("m/s²/N".to_owned(), 1.0)));
        assert_eq!(db("dB(g/N)"), Some(("g/N".to_owned(), 1.0)));
        assert_eq!(db("dB rel. 1e-6 m/N"), Some(("m/N".to_owned(), 1e-6)));
        assert_eq!((db("g"), db("dBm?")), (None, None));
        assert_eq!(split("Betrag in (m/s²)/N"), ("Betrag".to_owned(), "(m/s²)/N".to_owned()));
        assert_eq!(split("Mag (dB re 1 (m/s²)/N)"), ("Mag".to_owned(), "dB re 1 (m/s²)/N".to_owned()));
    }

    #[test]
    fn names_lose_their_units() {
        let pair = |text| split(text);
        assert_eq!(pair("acc@7 [m/s^2]"), ("acc@7".to_owned(), "m/s^2".to_owned()));
        assert_eq!(pair("Acc 7 (g)"), ("Acc 7".to_owned(), "g".to_owned()));
        assert_eq!(pair("Force (left)"), ("Force (left)".to_owned(), String::new()));
        assert_eq!(pair("a4/(m/s²)"), ("a4".to_owned(), "m/s²".to_owned()));
        assert_eq!(pair("Kraft / N"), ("Kraft".to_owned(), "N".to_owned()));
        assert_eq!(pair("time"), ("time".to_owned(), String::new()));
    }

    #[test]
    fn units_and_sensitivities_in_names() {
        assert_eq!(
            (suffix("acc_mg"), suffix("acceleration_m_s2")),
            (Some(("acc", "mg")), Some(("acceleration", "m/s^2")))
        );
        assert_eq!(
            (suffix("time_s"), suffix("Acc 1_g"), suffix("run_s"), suffix("H_m")),
            (Some(("time", "s")), Some(("Acc 1", "g")), None, None)
        );
        let said = |text| sensitivity(text).map(|(value, over, under)| format!("{value} {over} {under}"));
        assert_eq!(said("Force (22.5 mV/N)").as_deref(), Some("22.5 mV N"));
        assert_eq!(said("10,2mV/(m/s²)").as_deref(), Some("10.2 mV m/s²"));
        assert_eq!((said("Acc 7"), said("12:+Z/1:+Z"), said("3.5 V")), (None, None, None));
    }

    #[test]
    fn brackets_around_a_unit_do_not_matter() {
        assert!(is_unit("[m/s^2]") && is_unit(" g ") && is_unit("(N)") && !is_unit("Voltage"));
        assert!(is_unit("m·s⁻²") && is_unit("m/s²") && is_unit("(m/s²)/N"));
    }
}
