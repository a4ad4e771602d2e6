//! Numbers as Fortran and its heirs write them.
//!
//! `1.5E+00`, `1.5D+00`, `1.5-100` (the letter gives way to a third digit of the exponent), neighbours without a blank
//! between them (`-1.1E+00-2.2E+00`), `NaN`, `1.#QNAN`, `Inf`, `*****`.

/// A token of a line of numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Token<'a> {
    /// A number, perhaps NaN or infinite as written.
    Number(f64),
    /// A number that overflowed its columns.
    Overflowed,
    /// No number.
    Bad(&'a [u8]),
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | b'\n' | 0x0b | 0x0c | 0x1a)
}

/// Trims blanks, line ends and the end-of-file mark of DOS.
pub(crate) fn trim(bytes: &[u8]) -> &[u8] {
    let Some(first) = bytes.iter().position(|&b| !is_blank(b)) else { return &[] };
    let last = bytes.iter().rposition(|&b| !is_blank(b)).unwrap_or(first);
    &bytes[first..=last]
}

/// Trims blanks and line ends at the end.
pub(crate) fn trim_end(bytes: &[u8]) -> &[u8] {
    let end = bytes.iter().rposition(|&b| !is_blank(b)).map_or(0, |last| last + 1);
    &bytes[..end]
}

/// The next token of a line from `at` on; `None` at its end.
pub(crate) fn next_token<'a>(line: &'a [u8], at: &mut usize) -> Option<Token<'a>> {
    while *at < line.len() && is_blank(line[*at]) {
        *at += 1;
    }
    let start = *at;
    if start == line.len() {
        return None;
    }
    let end = number_end(line, start);
    if let Some((end, value)) = end.and_then(|end| Some((end, value(&line[start..end])?))) {
        *at = end;
        return Some(Token::Number(value));
    }
    while *at < line.len() && !is_blank(line[*at]) {
        *at += 1;
    }
    Some(word(&line[start..*at]))
}

/// Where the number that begins at `start` ends; `None` if what begins there is none.
fn number_end(line: &[u8], start: usize) -> Option<usize> {
    let digits = |mut at: usize| {
        while line.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at
    };
    let sign = |at: usize| at + usize::from(matches!(line.get(at), Some(b'+' | b'-')));
    let whole = sign(start);
    let mut end = digits(whole);
    let mut count = end - whole;
    if line.get(end) == Some(&b'.') {
        let fraction = digits(end + 1);
        count += fraction - end - 1;
        end = fraction;
    }
    if count == 0 {
        return None;
    }
    let exponent = match line.get(end) {
        Some(b'e' | b'E' | b'd' | b'D' | b'q' | b'Q') => Some(sign(end + 1)),
        Some(b'+' | b'-') => Some(end + 1).filter(|&at| digits(at) == at + 3 && line.get(at + 3) != Some(&b'.')),
        _ => None,
    };
    if let Some(at) = exponent {
        let after = digits(at);
        if after == at {
            return None;
        }
        end = after;
    }
    match line.get(end) {
        None | Some(b'+' | b'-') => Some(end),
        Some(&byte) if is_blank(byte) => Some(end),
        Some(_) => None,
    }
}

/// Value of a number whose exponent may be written with any letter or none.
fn value(token: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(token).ok()?;
    if let Ok(value) = text.parse() {
        return Some(value);
    }
    let at = token.iter().skip(1).position(|b| matches!(b, b'd' | b'D' | b'q' | b'Q' | b'+' | b'-'))? + 1;
    let (mantissa, exponent) = text.split_at(at);
    let exponent = exponent.trim_start_matches(['d', 'D', 'q', 'Q']);
    format!("{mantissa}E{exponent}").parse().ok()
}

/// What a word stands for that does not read as a number.
fn word(token: &[u8]) -> Token<'_> {
    let plain = token.to_ascii_lowercase();
    let (negative, plain) = match plain.split_first() {
        Some((b'-', rest)) => (true, rest),
        Some((b'+', rest)) => (false, rest),
        _ => (false, plain.as_slice()),
    };
    let signed = |value: f64| Token::Number(if negative { -value } else { value });
    match plain {
        b"inf" | b"infinity" => signed(f64::INFINITY),
        _ if plain.starts_with(b"1.#inf") => signed(f64::INFINITY),
        _ if plain.starts_with(b"nan") || plain.starts_with(b"1.#") => Token::Number(f64::NAN),
        _ if !plain.is_empty() && plain.iter().all(|&b| b == b'*') => Token::Overflowed,
        _ => Token::Bad(token),
    }
}

/// A whole number that fills a field; a decimal point with zeros after it is let pass.
pub(crate) fn integer(field: &[u8]) -> Option<i64> {
    let text = std::str::from_utf8(field).ok()?;
    text.parse().ok().or_else(|| {
        let whole = text.trim_end_matches('0').strip_suffix('.')?;
        whole.parse().ok()
    })
}

/// A real number that fills a field.
pub(crate) fn real(field: &[u8]) -> Option<f64> {
    let mut at = 0;
    match next_token(field, &mut at)? {
        Token::Number(value) if at == field.len() => Some(value),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(line: &str) -> Vec<f64> {
        let (mut at, mut values) = (0, Vec::new());
        while let Some(token) = next_token(line.as_bytes(), &mut at) {
            match token {
                Token::Number(value) => values.push(value),
                Token::Overflowed => values.push(f64::MAX),
                Token::Bad(token) => panic!("{:?}", String::from_utf8_lossy(token)),
            }
        }
        values
    }

    #[test]
    fn fortran_numbers_are_read_in_all_their_dresses() {
        assert_eq!(all(" 1.5E+00-2.5D-01 3.25d2\t4"), [1.5, -0.25, 325.0, 4.0]);
        assert_eq!(
            all("-1.111111E-01 4.111111E+01 4.1E+03-3.1E+03-1.111110E+05"),
            [-0.111_111_1, 41.111_11, 4100.0, -3100.0, -111_111.0]
        );
        assert_eq!(all(" 1.234567-100 5.00000E-005 .5 5."), [1.234_567e-100, 5e-5, 0.5, 5.0]);
        assert_eq!(all("1.5-2.5 1-2"), [1.5, -2.5, 1.0, -2.0]);
    }

    #[test]
    fn words_for_what_is_no_number() {
        assert!(all("NaN")[0].is_nan() && all("1.#QNAN")[0].is_nan() && all("-1.#IND00E+000")[0].is_nan());
        assert_eq!(all("-Infinity 1.#INF0E+0 *************"), [f64::NEG_INFINITY, f64::INFINITY, f64::MAX]);
        let mut at = 0;
        assert_eq!(next_token(b"  1.2.3 ", &mut at), Some(Token::Bad(b"1.2.3")));
        assert_eq!(next_token(b"E+05", &mut 0), Some(Token::Bad(b"E+05")));
    }

    #[test]
    fn whole_numbers_may_carry_an_empty_fraction() {
        assert_eq!(
            [integer(b"12"), integer(b"-3"), integer(b"7.00"), integer(b"7.5"), integer(b"1 2")],
            [Some(12), Some(-3), Some(7), None, None]
        );
        assert_eq!(integer(b"700"), Some(700));
    }
}
