//! The search for `points` structures, on the energies alone.
use super::data::{ExplainError, Problem};
use super::diagnose::Diagnosis;
use crate::control::Control;

pub(crate) fn diagnose(_problem: &Problem, _control: &Control) -> Result<Diagnosis, ExplainError> {
    Err(ExplainError::NoRuns)
}
