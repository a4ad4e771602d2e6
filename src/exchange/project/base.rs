//! Table `[base]`, and the base of a run.

use super::error::{ProjectError, TableProblem};
use super::file::{BaseTable, RunTable};
use super::reader::Table;

/// A direction and an amplitude belong together.
pub(super) fn half_a_base(table: &Table<'_>, run: Option<&RunTable>) -> Result<(), ProjectError> {
    let (key, other) = match run.map(|run| (run.base.is_some(), run.base_m_s2.is_some())) {
        Some((true, false)) => ("base", "base_m_s2"),
        Some((false, true)) => ("base_m_s2", "base"),
        _ => return Ok(()),
    };
    Err(table.error(key, TableProblem::HalfAForce { key, other }))
}

/// Table `[base]`.
pub(super) fn parse(root: &Table<'_>) -> Result<BaseTable, ProjectError> {
    let Some(table) = root.table("base", "[base]")? else { return Ok(BaseTable::default()) };
    table.only_in::<BaseTable>(&[])?;
    Ok(BaseTable { response: table.variant("response")?.unwrap_or_default() })
}
