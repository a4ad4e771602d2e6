//! Where every key of a project file stood, for messages about what is found wrong later.

use super::error::{ProjectError, TableProblem};
use super::reader::Table;
use std::collections::BTreeMap;

/// Lines, from 1, of the keys of every table, by the table's name in messages; the empty key is the table's head. A project that was
/// not read from a text has none.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Lines(BTreeMap<&'static str, Vec<BTreeMap<String, usize>>>);

impl Lines {
    /// Notes where the keys of the next table of its name stand.
    pub(super) fn note(&mut self, table: &Table<'_>) {
        let keys = table.keys().into_iter().map(|key| (key.to_owned(), table.line_of(key)));
        let keys = keys.chain([(String::new(), table.line())]).collect();
        self.0.entry(table.name).or_default().push(keys);
    }

    /// Line of a key of table number `k` of a name, or of the table's head without it.
    pub(super) fn of(&self, name: &str, k: usize, key: &str) -> Option<usize> {
        let keys = self.0.get(name)?.get(k)?;
        keys.get(key).or_else(|| keys.get("")).copied()
    }
}

/// Where problems of a project are said to be.
#[derive(Clone, Copy)]
pub(crate) struct At<'a> {
    /// Name of the file in messages.
    pub file: &'a str,
    /// Where its keys stand.
    pub lines: &'a Lines,
}

impl At<'static> {
    /// Of tables that were changed since they were read, or never were: messages name the problem alone.
    pub(crate) const NOWHERE: Self = At { file: "", lines: &Lines(BTreeMap::new()) };
}

impl At<'_> {
    /// The problem at a key of table number `k` of a name, or at the table's head.
    pub(super) fn error(self, name: &str, k: usize, key: &str, problem: TableProblem) -> ProjectError {
        ProjectError::new(self.file, self.lines.of(name, k, key), problem)
    }
}
