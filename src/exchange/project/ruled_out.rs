//! Tables `[[ruled_out]]`: effects at places that the user knows not to be what the model lacks.

use super::error::ProjectError;
use super::keys::elements;
use super::label::Label;
use super::lines::Lines;
use super::reader::Table;
use crate::effects::Effect;
use serde::{Deserialize, Serialize};

/// Table `[[ruled_out]]`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RuledOutTable {
    /// Law.
    pub law: Effect,
    /// DOFs; none for a law of the whole structure and for an error of a channel.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub dofs: Vec<Label>,
    /// First and last beam element, from 1.
    pub elements: Option<[i64; 2]>,
    /// Channel, such as `acc@7`, of an error of the measuring chain.
    pub channel: Option<String>,
}

/// Reads the tables.
pub(super) fn parse(root: &Table<'_>, lines: &mut Lines) -> Result<Vec<RuledOutTable>, ProjectError> {
    let mut tables = Vec::new();
    for table in root.tables("ruled_out", "[[ruled_out]]")? {
        table.only_in::<RuledOutTable>(&[])?;
        let law = table.word("law", &Effect::ALL.map(Effect::name), Effect::from_name)?;
        let law = table.need("law", "law = \"coulomb\"", law)?;
        let dofs = table.labels("dofs")?.unwrap_or_default().into_iter().map(Label).collect();
        tables.push(RuledOutTable { law, dofs, elements: elements(&table)?, channel: table.text("channel")? });
        lines.note(&table);
    }
    Ok(tables)
}
