//! `points` structures: no response can be predicted, so the model is judged by the energy of each run.
//!
//! ```text
//! e_r = input energy of run r,     m_r = energy taken out by the sources,     error |e_r - m_r| / |e_r|
//! ```
//!
//! The variance of `e_r - m_r` is propagated from the deviations of every measured amplitude by finite differences.

use crate::diagnosis::residual::data::{Data, DiagnosisError, Problem, RunData};
use crate::diagnosis::residual::energy_balance::{input, measured_displacement, taken};
use crate::effects::Source;
use faer::c64;

/// Energies of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointsEnergy {
    /// Index in the project's runs.
    pub index: usize,
    /// Energy put in over one period, J.
    pub input: f64,
    /// Energy that the sources take out, J.
    pub taken: f64,
    /// Standard deviation of their difference, J.
    pub deviation: f64,
}

impl PointsEnergy {
    /// Relative error.
    pub fn error(&self) -> f64 {
        if self.input == 0.0 { 1.0 } else { ((self.input - self.taken) / self.input).abs() }
    }

    /// What the error would be were the model exact.
    pub fn noise(&self) -> f64 {
        if self.input == 0.0 { 1.0 } else { (self.deviation / self.input).abs() }
    }
}

/// Energies of all runs of a `points` problem with `effects` added to the known sources.
pub fn energies(problem: &Problem, effects: &[Source]) -> Result<Vec<PointsEnergy>, DiagnosisError> {
    Data::new(problem)?;
    let data = Data::every(problem)?;
    let sources: Vec<Source> = problem.known().into_iter().chain(effects.iter().cloned()).collect();
    Ok(data.runs.iter().map(|run| of_run(problem, run, &sources)).collect())
}

fn of_run(problem: &Problem, run: &RunData, sources: &[Source]) -> PointsEnergy {
    let both = |run: &RunData| -> [f64; 2] {
        let field = |dof: usize| displacement(run, dof);
        let lost = sources.iter().map(|s| taken(problem.structure, s, run.omega, &field)).sum();
        [input(run, &field), lost]
    };
    let [given, lost] = both(run);
    let mut variance = 0.0;
    let mut moved = run.clone();
    // Only the fundamental carries energy worth its noise.
    for part in [c64::new(1.0, 0.0), c64::new(0.0, 1.0)] {
        for force in [true, false] {
            let count = if force { run.forces.len() } else { run.responses.len() };
            for c in 0..count {
                let deviation = if force { run.forces[c].deviation[0] } else { run.responses[c].deviation[0] };
                let list = if force { &mut moved.forces } else { &mut moved.responses };
                let before = list[c].measured[0];
                list[c].measured[0] = before + part * deviation;
                let [g, l] = both(&moved);
                variance += ((g - l) - (given - lost)).powi(2);
                let list = if force { &mut moved.forces } else { &mut moved.responses };
                list[c].measured[0] = before;
            }
        }
    }
    PointsEnergy { index: run.index, input: given, taken: lost, deviation: variance.sqrt() }
}

/// Measured displacement of a DOF; at rest where nothing measures it.
pub(crate) fn displacement(run: &RunData, dof: usize) -> Vec<c64> {
    measured_displacement(run, dof).unwrap_or_else(|| vec![c64::new(0.0, 0.0); run.harmonics])
}
