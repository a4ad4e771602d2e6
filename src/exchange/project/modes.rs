//! Tables `[[modes]]`: modes and operating shapes of other programs, for reference.

use super::error::ProjectError;
use super::frf::dofs;
use super::label::Label;
use super::lines::Lines;
use super::reader::Table;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Table `[[modes]]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModesTable {
    /// Universal File with data sets 55 or 2414, relative to the project.
    pub file: String,
    /// DOFs of the file, such as `12:+Z`, and their labels in the structure; those of `[frf.dofs]` hold too.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub dofs: BTreeMap<String, Label>,
}

/// Reads every `[[modes]]`.
pub(super) fn parse(root: &Table<'_>, lines: &mut Lines) -> Result<Vec<ModesTable>, ProjectError> {
    let mut tables = Vec::new();
    for table in root.tables("modes", "[[modes]]")? {
        table.only_in::<ModesTable>(&[])?;
        let file = table.need("file", "file = \"modes.uff\"", table.text("file")?)?;
        tables.push(ModesTable { file, dofs: dofs(&table, "dofs", "[modes.dofs]")? });
        lines.note(&table);
    }
    Ok(tables)
}
