//! Why a change of the document was refused.

use crate::effects::Effect;
use crate::effects::source::SourceError;
use crate::exchange::project::{Problem, ProjectError};
use crate::structure::StructureError;

/// Why a change was refused; the document is as it was.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum Refusal {
    #[error("already drawn: {source_name}; change that one instead")]
    DrawnTwice { source_name: String },
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
    #[error("a structure of points has no mass matrix to add a lumped mass to")]
    MassOnPoints,
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
    #[error("`{channel}` is not a channel of this structure; write force@DOF, acc@DOF, vel@DOF or disp@DOF")]
    NoSuchChannel { channel: String },
    #[error("`{law}` is ruled out there already")]
    RuledOutTwice { law: Effect },
    #[error("`{law}` is not ruled out there")]
    NotRuledOut { law: Effect },
    #[error("`{law}` cannot be ruled out: {reason}")]
    NoSuchPlace { law: Effect, reason: String },
    #[error("{channel} cannot be mended: {reason}")]
    NotMended { channel: String, reason: String },
    #[error("an empty text cannot be the name of a file")]
    EmptyName,
    #[error("the project cannot be written as TOML: {reason}")]
    NotWritable { reason: String },
    #[error(transparent)]
    Structure(#[from] StructureError),
    #[error(transparent)]
    Source(#[from] SourceError),
    #[error(transparent)]
    Pattern(Box<Problem>),
    #[error(transparent)]
    Project(#[from] ProjectError),
}

impl From<Problem> for Refusal {
    fn from(problem: Problem) -> Self {
        Self::Pattern(Box::new(problem))
    }
}
