//! Reads values from parsed TOML by key, with the line of everything that is wrong.

use super::error::{ProjectError, TableProblem};
use super::keys_of::keys_of;
use crate::math::GREATEST;
use serde::de::DeserializeOwned;
use serde::de::value::{Error as ValueError, StrDeserializer};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// What is wrong with a path as Windows writes it.
const BACKSLASH: &str = "a backslash between quotation marks begins a special letter; write paths with /, or in single quotes \
                         ('C:\\data\\a.csv')";

/// The text that is read, for line numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Origin<'a> {
    pub file: &'a str,
    pub text: &'a str,
}

impl<'a> Origin<'a> {
    /// The document that the text is.
    pub(super) fn document(self) -> Result<Spanned<DeTable<'a>>, ProjectError> {
        DeTable::parse(self.text).map_err(|error| {
            let start = error.span().map_or(0, |span| span.start);
            let at_backslash = self.is_at_backslash(start);
            let message = if at_backslash { BACKSLASH.to_owned() } else { one_line(error.message()) };
            self.error(start, TableProblem::Syntax { message })
        })
    }

    /// Whether a backslash stands at a byte of the text or before it.
    fn is_at_backslash(self, offset: usize) -> bool {
        let bytes = self.text.as_bytes();
        [offset.checked_sub(1), Some(offset)].into_iter().flatten().any(|at| bytes.get(at) == Some(&b'\\'))
    }

    /// Line, from 1, of a byte of the text.
    pub(super) fn line(self, offset: usize) -> usize {
        let end = offset.min(self.text.len());
        self.text.as_bytes()[..end].split(|&byte| byte == b'\n').count()
    }

    /// The problem at a byte of the text.
    pub(super) fn error(self, offset: usize, problem: TableProblem) -> ProjectError {
        ProjectError::new(self.file, Some(self.line(offset)), problem)
    }
}

type Value<'a> = Spanned<DeValue<'a>>;

/// A table of the project and its name in messages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Table<'a> {
    pub origin: Origin<'a>,
    pub name: &'static str,
    start: usize,
    entries: &'a DeTable<'a>,
}

impl<'a> Table<'a> {
    /// The whole document.
    pub(super) fn root(origin: Origin<'a>, document: &'a DeTable<'a>) -> Self {
        Self { origin, name: "the project", start: 0, entries: document }
    }

    /// Line of the table's head.
    pub(super) fn line(&self) -> usize {
        self.origin.line(self.start)
    }

    /// Line of a key, or of the table's head without it.
    pub(super) fn line_of(&self, key: &str) -> usize {
        self.origin.line(self.offset(key))
    }

    fn offset(&self, key: &str) -> usize {
        let found = self.entries.iter().find(|(name, _)| name.get_ref() == key);
        found.map_or(self.start, |(name, _)| name.span().start)
    }

    /// The problem at a key.
    pub(super) fn error(&self, key: &str, problem: TableProblem) -> ProjectError {
        self.origin.error(self.offset(key), problem)
    }

    /// Keys in the order of the text.
    pub(super) fn keys(&self) -> Vec<&'a str> {
        let mut keys: Vec<_> = self.entries.keys().map(|key| (key.span().start, key.get_ref().as_ref())).collect();
        keys.sort_unstable();
        keys.into_iter().map(|(_, key)| key).collect()
    }

    /// Fails on the first key that is not among `known`, and names the nearest that is.
    pub(super) fn only(&self, known: &[&str]) -> Result<(), ProjectError> {
        match self.keys().into_iter().find(|key| !known.contains(key)) {
            None => Ok(()),
            Some(key) => {
                let hint = hint(key, known);
                Err(self.error(key, TableProblem::UnknownKey { table: self.name.into(), key: key.into(), hint }))
            }
        }
    }

    /// [`Self::only`] of `more` and the keys that a table of type `T` has.
    pub(super) fn only_in<T: DeserializeOwned>(&self, more: &[&'static str]) -> Result<(), ProjectError> {
        self.only(&[more, keys_of::<T>()].concat())
    }

    fn get(&self, key: &str) -> Option<&'a Value<'a>> {
        self.entries.get(key)
    }

    /// A value that must be there.
    pub(super) fn need<T>(&self, key: &'static str, example: &str, value: Option<T>) -> Result<T, ProjectError> {
        let missing = || TableProblem::MissingKey { table: self.name.into(), key, example: example.into() };
        value.ok_or_else(|| self.origin.error(self.start, missing()))
    }

    fn wrong(&self, key: &str, value: &Value<'_>, expected: &'static str) -> ProjectError {
        let problem = TableProblem::WrongType { key: key.into(), expected, found: kind(value.get_ref()) };
        self.origin.error(value.span().start, problem)
    }

    /// A number that may be a physical quantity, written as integer or float.
    pub(super) fn number(&self, key: &str) -> Result<Option<f64>, ProjectError> {
        self.get(key).map(|value| self.as_number(key, value)).transpose()
    }

    fn as_number(&self, key: &str, value: &Value<'_>) -> Result<f64, ProjectError> {
        let (number, text) = match value.get_ref() {
            DeValue::Integer(n) => (integer(n.as_str(), n.radix()).map(|n| n as f64), n.as_str().to_owned()),
            DeValue::Float(x) => (x.as_str().parse().ok(), x.as_str().to_owned()),
            _ => return Err(self.wrong(key, value, "a number")),
        };
        let range = TableProblem::OutOfRange { key: key.into(), value: text, range: "finite, from -1e30 to 1e30" };
        number.filter(|x: &f64| x.abs() <= GREATEST).ok_or_else(|| self.origin.error(value.span().start, range))
    }

    /// A whole number.
    pub(super) fn whole(&self, key: &str) -> Result<Option<i64>, ProjectError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        let DeValue::Integer(n) = value.get_ref() else { return Err(self.wrong(key, value, "a whole number")) };
        let number = integer(n.as_str(), n.radix()).and_then(|n| i64::try_from(n).ok());
        let range = TableProblem::OutOfRange { key: key.into(), value: n.as_str().into(), range: "less than 2^63" };
        number.map(Some).ok_or_else(|| self.origin.error(value.span().start, range))
    }

    /// A whole number from `least` to `most`; `range` says so in words.
    pub(super) fn count(
        &self,
        key: &str,
        least: usize,
        most: usize,
        range: &'static str,
    ) -> Result<Option<usize>, ProjectError> {
        let Some(number) = self.whole(key)? else { return Ok(None) };
        match usize::try_from(number).ok().filter(|n| (least..=most).contains(n)) {
            Some(count) => Ok(Some(count)),
            None => {
                Err(self.error(key, TableProblem::OutOfRange { key: key.into(), value: number.to_string(), range }))
            }
        }
    }

    /// Text.
    pub(super) fn text(&self, key: &str) -> Result<Option<String>, ProjectError> {
        match self.get(key) {
            None => Ok(None),
            Some(value) => match value.get_ref() {
                DeValue::String(text) => Ok(Some(text.to_string())),
                _ => Err(self.wrong(key, value, "a text in quotes")),
            },
        }
    }

    /// True or false.
    pub(super) fn flag(&self, key: &str) -> Result<Option<bool>, ProjectError> {
        match self.get(key) {
            None => Ok(None),
            Some(value) => match value.get_ref() {
                DeValue::Boolean(flag) => Ok(Some(*flag)),
                _ => Err(self.wrong(key, value, "true or false")),
            },
        }
    }

    /// A word that `read` understands; `allowed` lists those that it does.
    pub(super) fn word<T>(
        &self,
        key: &str,
        allowed: &[&str],
        read: impl Fn(&str) -> Option<T>,
    ) -> Result<Option<T>, ProjectError> {
        let Some(value) = self.text(key)? else { return Ok(None) };
        let list = allowed.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", ");
        let problem = TableProblem::NotAllowed { key: key.into(), value: one_line(&value), allowed: list };
        read(&value).map(Some).ok_or_else(|| self.error(key, problem))
    }

    /// A word that is a variant of `T`.
    pub(super) fn variant<T: DeserializeOwned>(&self, key: &str) -> Result<Option<T>, ProjectError> {
        self.word(key, keys_of::<T>(), |word| T::deserialize(StrDeserializer::<ValueError>::new(word)).ok())
    }

    fn list(&self, key: &str, expected: &'static str) -> Result<Option<Vec<&'a Value<'a>>>, ProjectError> {
        match self.get(key) {
            None => Ok(None),
            Some(value) => match value.get_ref() {
                DeValue::Array(array) => Ok(Some(array.iter().collect())),
                _ => Err(self.wrong(key, value, expected)),
            },
        }
    }

    /// A list of finite numbers.
    pub(super) fn numbers(&self, key: &str) -> Result<Option<Vec<f64>>, ProjectError> {
        let Some(list) = self.list(key, "a list of numbers")? else { return Ok(None) };
        list.into_iter().map(|value| self.as_number(key, value)).collect::<Result<_, _>>().map(Some)
    }

    /// A list of lists of three numbers.
    pub(super) fn positions(&self, key: &str) -> Result<Option<Vec<[f64; 3]>>, ProjectError> {
        const EXPECTED: &str = "a list of [x, y, z]";
        let Some(list) = self.list(key, EXPECTED)? else { return Ok(None) };
        let position = |value: &Value<'_>| {
            let DeValue::Array(array) = value.get_ref() else { return Err(self.wrong(key, value, EXPECTED)) };
            let numbers = array.iter().map(|x| self.as_number(key, x)).collect::<Result<Vec<f64>, _>>()?;
            numbers.try_into().map_err(|_| self.wrong(key, value, EXPECTED))
        };
        list.into_iter().map(position).collect::<Result<_, _>>().map(Some)
    }

    /// A label, written as text or as a whole number.
    pub(super) fn label(&self, key: &str) -> Result<Option<String>, ProjectError> {
        self.get(key).map(|value| self.as_label(key, value)).transpose()
    }

    fn as_label(&self, key: &str, value: &Value<'_>) -> Result<String, ProjectError> {
        match value.get_ref() {
            DeValue::String(text) => Ok(text.to_string()),
            DeValue::Integer(n) if n.radix() == 10 => Ok(n.as_str().trim_start_matches('+').to_owned()),
            _ => Err(self.wrong(key, value, "a DOF label (text or whole number)")),
        }
    }

    /// A list of labels.
    pub(super) fn labels(&self, key: &str) -> Result<Option<Vec<String>>, ProjectError> {
        let Some(list) = self.list(key, "a list of DOF labels, such as [3]")? else { return Ok(None) };
        list.into_iter().map(|value| self.as_label(key, value)).collect::<Result<_, _>>().map(Some)
    }

    /// A list of texts.
    pub(super) fn texts(&self, key: &str) -> Result<Option<Vec<String>>, ProjectError> {
        const EXPECTED: &str = "a list of texts in quotes";
        let Some(list) = self.list(key, EXPECTED)? else { return Ok(None) };
        let text = |value: &Value<'_>| match value.get_ref() {
            DeValue::String(text) => Ok(text.to_string()),
            _ => Err(self.wrong(key, value, EXPECTED)),
        };
        list.into_iter().map(text).collect::<Result<_, _>>().map(Some)
    }

    /// The table `[key]`, called `name` in messages.
    pub(super) fn table(&self, key: &str, name: &'static str) -> Result<Option<Table<'a>>, ProjectError> {
        match self.get(key) {
            None => Ok(None),
            Some(value) => self.as_table(key, value, name).map(Some),
        }
    }

    fn as_table(&self, key: &str, value: &'a Value<'a>, name: &'static str) -> Result<Table<'a>, ProjectError> {
        match value.get_ref() {
            DeValue::Table(entries) => Ok(Table { origin: self.origin, name, start: value.span().start, entries }),
            _ => Err(self.wrong(key, value, "a table")),
        }
    }

    /// The tables `[[key]]`, called `name` in messages; none is fine.
    pub(super) fn tables(&self, key: &str, name: &'static str) -> Result<Vec<Table<'a>>, ProjectError> {
        let expected = "written as a list of tables, each under its name in double brackets";
        let list = self.list(key, expected)?.unwrap_or_default();
        list.into_iter().map(|value| self.as_table(key, value, name)).collect()
    }
}

/// A text on one line for a message.
pub(super) fn one_line(text: &str) -> String {
    const MOST: usize = 120;
    let plain: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).take(MOST).collect();
    plain.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn integer(text: &str, radix: u32) -> Option<i128> {
    i128::from_str_radix(text, radix).ok()
}

fn kind(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a text",
        DeValue::Integer(_) => "a whole number",
        DeValue::Float(_) => "a number with a decimal point",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}

/// What to write in place of an unknown key: the nearest known one, or the list of them.
fn hint(key: &str, known: &[&str]) -> String {
    let nearest = known.iter().max_by_key(|other| common(key, other) * 100 / key.len().max(other.len()));
    match nearest.filter(|near| 3 * common(key, near) >= 2 * key.len().max(near.len())) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("it takes {}", known.iter().map(|k| format!("`{k}`")).collect::<Vec<_>>().join(", ")),
    }
}

/// Letters that two words have in common in their order (longest common subsequence).
fn common(a: &str, b: &str) -> usize {
    let (a, b) = (a.to_lowercase().into_bytes(), b.as_bytes());
    let mut best = vec![0; b.len() + 1];
    for &x in &a {
        let mut diagonal = 0;
        for j in 0..b.len() {
            let above = best[j + 1];
            best[j + 1] = if x == b[j] { diagonal + 1 } else { above.max(best[j]) };
            diagonal = above;
        }
    }
    best[b.len()]
}
