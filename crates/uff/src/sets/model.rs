//! Data set 151: what the file is about and what wrote it.

use crate::body::Body;
use crate::error::Error;
use crate::text::{columns, decode, named};
use crate::warning::Fault;

/// The header of a file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Model {
    /// Name of the model.
    pub name: String,
    /// Description.
    pub description: String,
    /// Program that made the data base.
    pub application: String,
    /// Date and time when the data base was made, ten columns each.
    pub created: [String; 2],
    /// Versions of the data base and kind of file, as they stand.
    pub versions: [String; 3],
    /// Date and time when the data base was saved.
    pub saved: [String; 2],
    /// Program that wrote the file.
    pub program: String,
    /// Date and time when the file was written.
    pub written: [String; 2],
}

impl Model {
    /// Missing lines stay empty: none of them is needed to understand the rest of the file.
    pub(crate) fn read(body: &mut Body<'_>) -> Result<Self, Error> {
        let mut next = || -> String {
            let Some(line) = body.any_line() else { return String::new() };
            if !line.bytes.is_ascii() {
                body.warn(line, Fault::NotAscii);
            }
            decode(line.bytes)
        };
        let [name, description, application] = [next(), next(), next()].map(|text| named(&text));
        let creation = next();
        let part = |text: &str, i: usize| columns(text, 10 * i, 10 * i + 10).trim().to_string();
        let date = |text: &str| -> [String; 2] {
            if columns(text, 20, 80).trim().is_empty() || text.split_whitespace().count() != 2 {
                return [part(text, 0), part(text, 1)];
            }
            let mut words = text.split_whitespace().map(str::to_string);
            [words.next().unwrap_or_default(), words.next().unwrap_or_default()]
        };
        let saved = next();
        let program = named(&next());
        let written = next();
        Ok(Self {
            name,
            description,
            application,
            created: [part(&creation, 0), part(&creation, 1)],
            versions: [2, 3, 4].map(|i| part(&creation, i)),
            saved: date(&saved),
            program,
            written: date(&written),
        })
    }
}
