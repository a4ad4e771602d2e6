//! Tables `[[ruled_out]]`: effects at places that the user knows not to be what the model lacks.

use super::error::{Problem, ProjectError};
use super::file::{Label, Lines};
use super::parse::elements;
use super::reader::Table;
use super::sources::{At, at_place, blamed, channel};
use crate::effects::Kind;
use crate::effects::{Effect, Place, Source};
use crate::structure::Structure;
use serde::Serialize;

/// Table `[[ruled_out]]`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RuledOutTable {
    /// Law.
    pub law: Effect,
    /// DOFs; none for a law of the whole structure and for an error of a channel.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub dofs: Vec<Label>,
    /// First and last beam element, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elements: Option<[i64; 2]>,
    /// Channel, such as `acc@7`, of an error of the measuring chain.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub channel: Option<String>,
}

impl RuledOutTable {
    /// The effect at its place on a structure; its parameters are typical ones and mean nothing.
    ///
    /// # Errors
    /// [`Problem`] where there is no such place, or the law cannot act there.
    pub fn source(&self, structure: &Structure) -> Result<Source, Problem> {
        let needs = |key, example: &str| Problem::MissingKey {
            table: format!("[[ruled_out]] of `{}`", self.law),
            key,
            example: example.to_owned(),
        };
        let place = match (self.law.kind(), &self.channel) {
            (Kind::Channel(_), None) => return Err(needs("channel", "channel = \"acc@7\"")),
            (Kind::Channel(_), Some(name)) => Place::Channel(channel(name, structure)?),
            (_, Some(_)) => return Err(needs("dofs", "dofs = [7]")),
            (_, None) => at_place(self.law, &self.dofs, self.elements, structure)?,
        };
        let source = Source::candidate(self.law, place);
        source.check_on(structure).map_err(|error| Problem::Source(Box::new(error)))?;
        Ok(source)
    }
}

/// Reads the tables.
pub(super) fn parse(root: &Table<'_>, lines: &mut Lines) -> Result<Vec<RuledOutTable>, ProjectError> {
    let mut tables = Vec::new();
    for table in root.tables("ruled_out", "[[ruled_out]]")? {
        table.only(&["law", "dofs", "elements", "channel"])?;
        let law = table.word("law", &Effect::ALL.map(Effect::name), Effect::from_name)?;
        let law = table.need("law", "law = \"coulomb\"", law)?;
        let dofs = table.labels("dofs")?.unwrap_or_default().into_iter().map(Label).collect();
        tables.push(RuledOutTable { law, dofs, elements: elements(&table)?, channel: table.text("channel")? });
        lines.ruled_out.push(super::parse::key_lines(&table));
    }
    Ok(tables)
}

/// The effects on the structure, each checked.
pub(super) fn ruled_out(
    tables: &[RuledOutTable],
    structure: &Structure,
    at: At<'_>,
) -> Result<Vec<Source>, ProjectError> {
    let one = |(table, lines): (&RuledOutTable, _)| {
        table.source(structure).map_err(|problem| at.error(blamed(lines, &problem), problem))
    };
    tables.iter().zip(&at.lines.ruled_out).map(one).collect()
}
