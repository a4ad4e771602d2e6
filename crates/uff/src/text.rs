//! Text of a file: UTF-8 where it is valid, else latin-1.

/// Decodes bytes; latin-1 where they are not UTF-8.
pub(crate) fn decode(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_string(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    }
}

/// A few characters of what stands in a file, for messages.
pub(crate) fn quote(bytes: &[u8]) -> String {
    const MOST: usize = 40;
    let text: String =
        decode(crate::number::trim(bytes)).chars().map(|c| if c.is_control() { '?' } else { c }).collect();
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text,
    }
}

/// Text without surrounding blanks; empty where the file says `NONE`.
pub(crate) fn named(text: &str) -> String {
    let text = text.trim();
    if text == "NONE" { String::new() } else { text.to_string() }
}

/// Characters of a line between two columns, counted from 0.
pub(crate) fn columns(text: &str, from: usize, to: usize) -> String {
    text.chars().skip(from).take(to.saturating_sub(from)).collect()
}
