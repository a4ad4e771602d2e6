//! Energies of runs by their measured motion alone, which are those of the rows of identification ([`crate::balance`]). Of `points`
//! structures no response can be predicted: the model is judged by them.
//!
//! ```text
//! e_r = input energy of run r,     m_r = energy taken out by the sources,     error |e_r - m_r| / |e_r|
//! ```

use crate::balance::energy::input_energy;
use crate::balance::expansion::Acting;
use crate::balance::weights::residual_deviation;
use crate::balance::{Expanded, Expander, Expansion, Measured, action};
use crate::diagnosis::residual::data::{Data, DiagnosisError, Problem, RunData};
use crate::diagnosis::residual::energy_balance::measured_displacement;
use crate::effects::Source;
use crate::measurement::Run;
use crate::structure::Structure;
use faer::c64;

/// Energies of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PointsEnergy {
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
    pub(crate) fn error(&self) -> f64 {
        if self.input == 0.0 { 1.0 } else { ((self.input - self.taken) / self.input).abs() }
    }

    /// What the error would be were the model exact.
    pub(crate) fn noise(&self) -> f64 {
        if self.input == 0.0 { 1.0 } else { (self.deviation / self.input).abs() }
    }
}

/// Energies of all runs of a `points` problem with `effects` added to the known sources.
pub(crate) fn energies(problem: &Problem, effects: &[Source]) -> Result<Vec<PointsEnergy>, DiagnosisError> {
    Data::new(problem)?;
    let data = Data::every(problem)?;
    let sources: Vec<Source> = problem.known().into_iter().chain(effects.iter().cloned()).collect();
    let nothing = |index| PointsEnergy { index, input: 0.0, taken: 0.0, deviation: 0.0 };
    let of_run = |run: &RunData| {
        let motion = motion(problem.structure, &problem.runs[run.index]);
        motion.map_or(nothing(run.index), |(m, x)| at_motion(problem.structure, run.index, &m, &x, &sources))
    };
    Ok(data.runs.iter().map(of_run).collect())
}

/// The energies of run `index` by the measured motion alone, of any structure; none where a DOF has no sensor.
pub(crate) fn where_all_is_measured(problem: &Problem, index: usize, sources: &[Source]) -> Option<PointsEnergy> {
    let (measured, expanded) = motion(problem.structure, &problem.runs[index])?;
    let all = expanded.known.iter().all(|known| *known);
    all.then(|| at_motion(problem.structure, index, &measured, &expanded, sources))
}

/// The energies of run `index`; nothing is put in where no sensor sees the drive point.
fn at_motion(
    structure: &Structure,
    index: usize,
    measured: &Measured,
    expanded: &Expanded,
    sources: &[Source],
) -> PointsEnergy {
    let input = input_energy(structure, measured, expanded).unwrap_or(0.0);
    let taken = sources.iter().map(|source| action::energy(source, structure, expanded.field(measured))).sum();
    let noisy = measured.noisy.then(|| residual_deviation(structure, measured, expanded, sources));
    PointsEnergy { index, input, taken, deviation: noisy.unwrap_or(0.0) }
}

/// The motion where sensors are, sensors at one DOF averaged by their variances.
fn motion(structure: &Structure, run: &Run) -> Option<(Measured, Expanded)> {
    let measured = Measured::new(run).ok()?;
    let expander = Expander::new(structure, Expansion::None, std::slice::from_ref(&measured)).ok()?;
    let expanded = expander.expand(&measured, Acting::NOTHING).ok()?;
    Some((measured, expanded))
}

/// Measured displacement of a DOF; at rest where nothing measures it.
pub(crate) fn displacement(run: &RunData, dof: usize) -> Vec<c64> {
    measured_displacement(run, dof).unwrap_or_else(|| vec![c64::new(0.0, 0.0); run.harmonics])
}
