//! Real numbers in the ways in which programs and people write them.

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

/// A number with signs between its thousands and a decimal sign: `1.234,5`, `1,234.5`, `1'234.5`, `1 234,5` with blanks of any width.
fn grouped(text: &str, comma: bool) -> Option<f64> {
    let (other, decimal) = if comma { ('.', ',') } else { (',', '.') };
    let groups = [other, '\'', ' ', '\u{a0}', '\u{202f}', '\u{2009}'];
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
