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
    "m/s^2",
    "m/s2",
    "m/s²",
    "m/s**2",
    "m/(s^2)",
    "m/s/s",
    "ms-2",
    "ms^-2",
    "mm/s^2",
    "mm/s2",
    "mm/s²",
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
    UNITS.contains(&plain.as_str())
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
    (text.to_owned(), String::new())
}

fn bracketed(text: &str, open: char, close: char) -> Option<(String, String)> {
    let inner = text.strip_suffix(close)?;
    let at = inner.rfind(open)?;
    Some((inner[..at].trim().to_owned(), inner[at + open.len_utf8()..].trim().to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lose_their_units() {
        let pair = |text| split(text);
        assert_eq!(pair("acc@7 [m/s^2]"), ("acc@7".to_owned(), "m/s^2".to_owned()));
        assert_eq!(pair("Acc 7 (g)"), ("Acc 7".to_owned(), "g".to_owned()));
        assert_eq!(pair("Force (left)"), ("Force (left)".to_owned(), String::new()));
        assert_eq!(pair("Kraft / N"), ("Kraft".to_owned(), "N".to_owned()));
        assert_eq!(pair("time"), ("time".to_owned(), String::new()));
    }

    #[test]
    fn brackets_around_a_unit_do_not_matter() {
        assert!(is_unit("[m/s^2]") && is_unit(" g ") && is_unit("(N)") && !is_unit("Voltage"));
    }
}
