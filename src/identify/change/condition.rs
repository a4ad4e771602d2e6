//! The two states that are held against each other.

use crate::effects::Source;
use crate::identify::error::IdentifyError;
use crate::identify::measurements::Measurements;
use crate::identify::settings::Settings;
use crate::structure::Structure;

/// One state of the structure: its model, sources and measurements.
#[derive(Debug, Clone, Copy)]
pub struct Condition<'a> {
    /// Mass, stiffness and geometry; DOFs of both states have the same labels where sources act.
    pub structure: &'a Structure,
    /// Known sources and candidates.
    pub sources: &'a [Source],
    /// Runs in use.
    pub measured: Measurements<'a>,
    /// How it is identified.
    pub settings: &'a Settings,
}

/// Why two states cannot be held against each other.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum ChangeError {
    #[error("the {state} state: {reason}")]
    State { state: &'static str, reason: IdentifyError },
    #[error(
        "the {state} state has no DOF \"{label}\", where the other has a source; give both structures the same DOFs and labels"
    )]
    NoDof { state: &'static str, label: String },
}

/// What the states are called.
pub(super) const NAMES: [&str; 2] = ["first", "second"];
