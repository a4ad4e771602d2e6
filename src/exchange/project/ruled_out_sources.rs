//! Effects that are ruled out, at their places on the structure.

use super::error::{ProjectError, TableProblem};
use super::label::Label;
use super::lines::At;
use super::ruled_out::RuledOutTable;
use super::sources::{at_place, channel, key_at_fault};
use crate::effects::{Kind, Place, Source, WrittenPlace};
use crate::structure::Structure;

impl RuledOutTable {
    /// The effect of a source where it acts.
    pub fn of(source: &Source, structure: &Structure) -> Self {
        let WrittenPlace { dofs, elements, channel } = source.place.written(structure);
        Self { law: source.effect, dofs: dofs.into_iter().map(Label).collect(), elements, channel }
    }

    /// The effect at its place on a structure; its parameters are typical ones and mean nothing.
    ///
    /// # Errors
    /// [`TableProblem`] where there is no such place, or the law cannot act there.
    pub fn source(&self, structure: &Structure) -> Result<Source, TableProblem> {
        let needs = |key, example: &str| TableProblem::MissingKey {
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
        source.check_on(structure).map_err(|error| TableProblem::Source(Box::new(error)))?;
        Ok(source)
    }
}

/// The effects on the structure, each checked.
pub(super) fn ruled_out(
    tables: &[RuledOutTable],
    structure: &Structure,
    at: At<'_>,
) -> Result<Vec<Source>, ProjectError> {
    let source_of = |(k, table): (usize, &RuledOutTable)| {
        table.source(structure).map_err(|problem| at.error("[[ruled_out]]", k, key_at_fault(&problem), problem))
    };
    tables.iter().enumerate().map(source_of).collect()
}
