//! Files in and out: projects, records, matrices, exports.

pub mod atomic;
pub mod export;
pub(crate) mod frf;
pub mod importing;
pub mod mapping;
pub mod matrices;
pub mod project;
pub(crate) mod ratios;
pub mod records;

use crate::classical::reference_shapes::ReferenceShape;
use crate::control::Control;
use crate::effects::Source;
use crate::identify::{IdentifyError, Measurements, Outcome, Settings, identify_measured};
use crate::measurement::{MeasuredRatio, Run, TransientRun};
use crate::structure::Structure;

/// A project as read from its file, with all records loaded and fitted.
#[derive(Debug, Clone)]
pub struct Project {
    /// Title.
    pub title: String,
    /// Free text.
    pub notes: String,
    /// Structure with its lumped masses.
    pub structure: Structure,
    /// Sources with the families of candidates expanded.
    pub sources: Vec<Source>,
    /// Effects at places that are known not to be what the model lacks; their parameters mean nothing.
    pub ruled_out: Vec<Source>,
    /// Runs in the order of the file; channels corrected for their known errors.
    pub runs: Vec<Run>,
    /// Decays and transients in the order of the file; channels corrected for their known errors.
    pub transient_runs: Vec<TransientRun>,
    /// Modes and operating shapes of other programs.
    pub reference_shapes: Vec<ReferenceShape>,
    /// Settings of the analysis.
    pub settings: Settings,
    /// What the user should know of the measurements: lines chosen, faults that were read over.
    pub remarks: Vec<String>,
}

impl Project {
    /// Identifies its sources from all its measurements and damping `ratios` that were measured by themselves.
    ///
    /// # Errors
    /// As [`identify_measured`].
    pub fn identify(&self, ratios: &[MeasuredRatio], control: &Control) -> Result<Outcome, IdentifyError> {
        let measured = Measurements { runs: &self.runs, transient_runs: &self.transient_runs, ratios };
        identify_measured(&self.structure, &self.sources, measured, &self.settings, control)
    }
}
