//! Records in fixed columns, as Fortran writes them; records whose columns have slipped are read by their blanks.

use crate::body::{Body, Line};
use crate::error::{Error, Problem};
use crate::number;
use crate::text::{columns, decode};
use crate::warning::Fault;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Integer,
    Real,
    Text,
}

/// A column: name for messages, width in characters, what it holds.
pub(crate) type Column = (&'static str, usize, Kind);

/// The layout of a record; the first `required` fields must not be empty.
pub(crate) struct Layout {
    pub record: &'static str,
    pub columns: &'static [Column],
    pub required: usize,
}

/// The fields of a record, each what its column says.
pub(crate) struct Fields(Vec<String>);

impl Fields {
    /// A whole number, 0 where the field is empty.
    pub(crate) fn integer(&self, i: usize) -> i64 {
        number::integer(self.0[i].as_bytes()).unwrap_or(0)
    }

    /// A real number, 0 where the field is empty.
    pub(crate) fn real(&self, i: usize) -> f64 {
        number::real(self.0[i].as_bytes()).unwrap_or(0.0)
    }

    /// Text without surrounding blanks.
    pub(crate) fn text(&self, i: usize) -> &str {
        &self.0[i]
    }
}

/// Reads a line as a record.
pub(crate) fn read(body: &mut Body<'_>, line: Line<'_>, layout: &Layout) -> Result<Fields, Error> {
    if !line.bytes.is_ascii() {
        body.warn(line, Fault::NotAscii);
    }
    let text = decode(line.bytes);
    let fixed = in_columns(&text, layout);
    let bad = first_bad(&fixed, layout);
    let free = || by_blanks(&text, layout).filter(|fields| first_bad(fields, layout).is_none());
    if bad.is_none() && !splits_a_number(&text, layout) {
        return Ok(Fields(fixed));
    }
    if let Some(fields) = free() {
        body.warn(line, Fault::Columns { record: layout.record });
        return Ok(Fields(fields));
    }
    match bad {
        None => Ok(Fields(fixed)),
        Some(i) => Err(body.error(line, field_problem(&fixed[i], i, layout))),
    }
}

fn in_columns(text: &str, layout: &Layout) -> Vec<String> {
    let mut from = 0;
    let field = |column: &Column| {
        let to = from + column.1;
        let field = columns(text, from, to).trim().to_string();
        from = to;
        field
    };
    layout.columns.iter().map(field).collect()
}

/// Number of the first field that is not what its column says.
fn first_bad(fields: &[String], layout: &Layout) -> Option<usize> {
    (0..fields.len()).find(|&i| match layout.columns[i].2 {
        _ if fields[i].is_empty() => i < layout.required,
        Kind::Integer => number::integer(fields[i].as_bytes()).is_none(),
        Kind::Real => number::real(fields[i].as_bytes()).is_none(),
        Kind::Text => false,
    })
}

/// Whether a border between columns of numbers runs through what looks like one number.
fn splits_a_number(text: &str, layout: &Layout) -> bool {
    let characters: Vec<char> = text.chars().collect();
    let mut border = 0;
    for pair in layout.columns.windows(2) {
        border += pair[0].1;
        let numbers = pair[0].2 != Kind::Text && pair[1].2 != Kind::Text;
        let through = border < characters.len() && !characters[border - 1].is_whitespace();
        let starts = characters.get(border).is_none_or(|c| c.is_whitespace() || matches!(c, '+' | '-'));
        if numbers && through && !starts {
            return true;
        }
    }
    false
}

/// Fields separated by blanks; texts at the end of the record by two or more.
fn by_blanks(text: &str, layout: &Layout) -> Option<Vec<String>> {
    let words: Vec<String> = text.split_whitespace().map(str::to_string).collect();
    let numbers = layout.columns.iter().take_while(|column| column.2 != Kind::Text).count();
    let count = layout.columns.len();
    if words.len() == count {
        return Some(words);
    }
    if words.len() < numbers.min(layout.required) {
        return None;
    }
    if numbers == count {
        let mut fields = words;
        fields.resize(count, String::new());
        return Some(fields);
    }
    if layout.columns[numbers..].iter().any(|column| column.2 != Kind::Text) || words.len() < numbers {
        return None;
    }
    let mut rest = text;
    for word in &words[..numbers] {
        rest = rest.trim_start().strip_prefix(word.as_str())?;
    }
    let mut fields = words[..numbers].to_vec();
    fields.extend(rest.split("  ").map(|part| part.trim().to_string()).filter(|part| !part.is_empty()));
    fields.resize(count, String::new());
    Some(fields)
}

fn field_problem(text: &str, i: usize, layout: &Layout) -> Problem {
    let (field, width, kind) = layout.columns[i];
    let first = layout.columns[..i].iter().map(|column| column.1).sum::<usize>() + 1;
    let expected = match kind {
        Kind::Integer => "a whole number",
        Kind::Real => "a number",
        Kind::Text => "text",
    };
    Problem::Field { field, text: crate::text::quote(text.as_bytes()), expected, first, last: first + width - 1 }
}
