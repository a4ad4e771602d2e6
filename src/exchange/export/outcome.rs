//! The outcome of an identification as what is exported.

use super::format::{ExportError, Format, Written};
use super::identified::{Identified, IdentifiedMode, IdentifiedSource};
use super::write::write;
use crate::effects::Effect;
use crate::exchange::Project;
use crate::identify::Outcome;
use faer::Mat;
use std::path::Path;

/// Writes the identified matrices and sources of `project` to `path`.
///
/// # Errors
/// [`ExportError`].
pub fn write_outcome(
    project: &Project,
    outcome: &Outcome,
    format: Format,
    path: &Path,
) -> Result<Written, ExportError> {
    let sources = sources(project, outcome);
    let others: Vec<(Effect, Mat<f64>)> =
        outcome.results.others.iter().map(|law| (law.effect, law.matrix.clone())).collect();
    let mode = |mode: &crate::identify::results::ModeResult| IdentifiedMode {
        frequency_hz: mode.frequency_hz,
        damping_ratio: mode.damping_ratio,
        deviation: mode.damping_ratio_deviation,
    };
    let modes: Vec<IdentifiedMode> = outcome.results.modes.iter().map(mode).collect();
    let identified = Identified {
        title: &project.title,
        structure: &project.structure,
        sources: &sources,
        viscous: &outcome.results.viscous,
        others: &others,
        equivalent: &outcome.results.equivalent_viscous,
        energy_percent: &outcome.results.energy_percent,
        modes: &modes,
    };
    write(&identified, format, path)
}

/// The accepted sources at their values, then the known ones.
fn sources(project: &Project, outcome: &Outcome) -> Vec<IdentifiedSource> {
    let identified = |estimate: &crate::identify::Estimate| {
        let source = project.sources[estimate.source].with_coefficient(estimate.coefficient);
        let mut deviation = vec![0.0; source.parameters.len()];
        if let Some(k) = source.effect.coefficient() {
            deviation[k] = estimate.deviation;
        }
        IdentifiedSource { source, deviation, energy_percent: estimate.energy_percent }
    };
    outcome.sources.iter().map(identified).collect()
}
