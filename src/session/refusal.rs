//! Why a change of the document was refused.

use crate::effects::Effect;
use crate::effects::source::SourceError;
use crate::exchange::project::{ProjectError, TableProblem};
use crate::structure::StructureError;

/// Why a change was refused; the document is as it was.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum Refusal {
    #[error("not drawn: {source_name}; choose a source of the pattern")]
    NoSuchSource { source_name: String },
    #[error("the family `{family}` of `{law}` is already drawn")]
    FamilyTwice { law: Effect, family: &'static str },
    #[error("the family `{family}` of `{law}` is not drawn")]
    NoSuchFamily { law: Effect, family: &'static str },
    #[error("a {kind} has no number `{name}`; it has {known}")]
    NoSuchNumber { kind: &'static str, name: String, known: String },
    #[error("`{name}` must be a whole number of at least 1, not {value}")]
    NotWhole { name: String, value: f64 },
    #[error("only a beam has supports; this structure is a {kind}")]
    NoSupports { kind: &'static str },
    #[error("there is no lumped mass at DOF {dof}")]
    NoLumpedMass { dof: String },
    #[error("the run {file} is not in the project; choose one of its runs")]
    NoSuchRun { file: String },
    #[error("the run {file} is in the project already")]
    RunTwice { file: String },
    #[error("no file is named; choose at least one record")]
    NoFile,
    #[error("`{name}` must be {range}, not {value}")]
    OutOfRange { name: &'static str, range: &'static str, value: f64 },
    #[error("`{law}` is ruled out there already")]
    RuledOutTwice { law: Effect },
    #[error("`{law}` is not ruled out there")]
    NotRuledOut { law: Effect },
    #[error("`{law}` cannot be ruled out: {reason}")]
    NoSuchPlace { law: Effect, reason: String },
    #[error("{channel} cannot be mended: {reason}")]
    NotMended { channel: String, reason: String },
    #[error(
        "{law} is known at this place already, and two of it with other parameters are not one; change its values there"
    )]
    NotOne { law: &'static str },
    #[error("{law} has no coefficient to be taken over")]
    NoCoefficient { law: &'static str },
    #[error("an empty text cannot be the name of a file")]
    EmptyName,
    #[error(transparent)]
    Structure(#[from] StructureError),
    #[error(transparent)]
    Pattern(Box<TableProblem>),
    #[error(transparent)]
    Project(#[from] ProjectError),
}

impl From<SourceError> for Refusal {
    fn from(error: SourceError) -> Self {
        TableProblem::Source(Box::new(error)).into()
    }
}

impl From<TableProblem> for Refusal {
    fn from(problem: TableProblem) -> Self {
        Self::Pattern(Box::new(problem))
    }
}
