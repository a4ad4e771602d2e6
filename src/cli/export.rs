//! `dashpot export`: identified matrices and sources in the format of another program.

use super::arguments::Export;
use super::identify::identified;
use crate::effects::Effect;
use crate::exchange::export::{Identified, IdentifiedMode, IdentifiedSource, write};
use faer::Mat;

pub(super) fn run(arguments: &Export) -> anyhow::Result<String> {
    let (project, outcome) = identified(&arguments.file)?;
    let sources: Vec<IdentifiedSource> = outcome
        .sources
        .iter()
        .map(|estimate| {
            let source = project.sources[estimate.source].with_coefficient(estimate.coefficient);
            let mut deviation = vec![0.0; source.parameters.len()];
            if let Some(k) = source.effect.coefficient() {
                deviation[k] = estimate.deviation;
            }
            IdentifiedSource { source, deviation, energy_percent: estimate.energy_percent }
        })
        .collect();
    let others: Vec<(Effect, Mat<f64>)> =
        outcome.results.others.iter().map(|law| (law.effect, law.matrix.clone())).collect();
    let modes: Vec<IdentifiedMode> = outcome
        .results
        .modes
        .iter()
        .map(|mode| IdentifiedMode {
            frequency_hz: mode.frequency_hz,
            damping_ratio: mode.damping_ratio,
            deviation: mode.damping_ratio_deviation,
        })
        .collect();
    let result = Identified {
        title: &project.title,
        structure: &project.structure,
        sources: &sources,
        viscous: &outcome.results.viscous,
        others: &others,
        equivalent: &outcome.results.equivalent_viscous,
        energy_percent: &outcome.results.energy_percent,
        modes: &modes,
    };
    let written = write(&result, arguments.to, &arguments.out)?;
    for warning in &written.warnings {
        eprintln!("warning: {warning}");
    }
    Ok(written.paths.iter().map(|path| format!("{}\n", path.display())).collect())
}
