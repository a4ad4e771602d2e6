//! Table `[report]`: what stands on the title page of a report.

use super::error::ProjectError;
use super::reader::Table;
use serde::{Deserialize, Serialize};

/// Table `[report]`. Every key may be left out.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ReportTable {
    /// Title; that of the project unless given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// What was tested: name, drawing number, serial number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub object: Option<String>,
    /// Who tested it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tester: Option<String>,
    /// For whom.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub organisation: Option<String>,
    /// PNG picture, relative to the project.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub logo: Option<String>,
}

/// Table `[report]`.
pub(super) fn parse(root: &Table<'_>) -> Result<ReportTable, ProjectError> {
    let Some(table) = root.table("report", "[report]")? else { return Ok(ReportTable::default()) };
    table.only_in::<ReportTable>(&[])?;
    Ok(ReportTable {
        title: table.text("title")?,
        object: table.text("object")?,
        tester: table.text("tester")?,
        organisation: table.text("organisation")?,
        logo: table.text("logo")?,
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use crate::exchange::project::ProjectFile;

    const CHAIN: &str = "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [1.0]\n\
        ground_stiffness = [1.0]\ncoupling_stiffness = []\n";

    #[test]
    fn what_is_read_is_written_again() {
        let text = format!("{CHAIN}[report]\nobject = \"beam 7\"\ntester = \"A. B.\"\nlogo = \"logo.png\"\n");
        let (file, _) = ProjectFile::parse(&text, "p.toml").unwrap();
        assert_eq!(file.report.object.as_deref(), Some("beam 7"));
        assert_eq!(file.report.title, None);
        let again = ProjectFile::parse(&file.to_toml().unwrap(), "p.toml").unwrap().0;
        assert_eq!(again, file);
    }

    #[test]
    fn an_unknown_key_is_refused_with_its_line() {
        let wrong = ProjectFile::parse(&format!("{CHAIN}[report]\ntestr = \"A\"\n"), "p.toml").unwrap_err();
        let said = wrong.to_string();
        assert!(said.contains("p.toml:9") && said.contains("testr") && said.contains("tester"), "{said}");
    }
}
