//! The energy equation `G c = e` (4.22): over one period, what the sources take out is what the exciters put in (4.5):
//! `e_r = (T/2) sum_h Re(V_h^H F_h) = pi sum_h h Im(conj(X_h) F_h)` at the driven DOFs.
//!
//! The drive point's own sensor gives `X` there where it exists: off resonance the energy hangs on a small phase, which an
//! expansion does not know.

use super::action;
use super::error::BalanceError;
use super::expansion::Expanded;
use super::measured::Measured;
use super::settings::Expansion;
use crate::control::Control;
use crate::effects::{Place, Source};
use crate::math::fill::filled;
use crate::structure::Structure;
use faer::{Mat, c64};
use std::f64::consts::PI;

/// Rows are runs, columns are sources of unit coefficient.
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyEquation {
    /// Energy of each source at unit coefficient, J; runs x sources.
    pub g: Mat<f64>,
    /// Input energy per period less that of the known sources, J.
    pub e: Vec<f64>,
    /// Input energy per period, J.
    pub input: Vec<f64>,
}

/// A source of unit linear coefficient.
pub(crate) fn unit(source: &Source) -> Source {
    source.with_coefficient(1.0)
}

impl EnergyEquation {
    /// Writes the equation for `columns` (taken at unit coefficient) with `known` sources subtracted at their values; runs are
    /// shared among the workers of `control`.
    ///
    /// # Errors
    /// [`BalanceError::DriveUnmeasured`] where neither a sensor nor an expansion gives the drive point's motion.
    pub fn new(
        structure: &Structure,
        runs: &[(Measured, Expanded)],
        columns: &[Source],
        known: &[Source],
        control: &Control,
    ) -> Result<Self, BalanceError> {
        let units: Vec<Source> = columns.iter().map(unit).collect();
        let rows = control.map(runs.len(), |r| {
            let (measured, expanded) = &runs[r];
            let energy = |source: &Source| action::energy(source, structure, expanded.field(measured));
            let put_in = input_energy(structure, measured, expanded)?;
            let taken: f64 = known.iter().map(energy).sum();
            Ok((units.iter().map(energy).collect::<Vec<f64>>(), put_in, put_in - taken))
        });
        let rows = rows.into_iter().collect::<Result<Vec<_>, BalanceError>>()?;
        Ok(Self {
            g: filled(runs.len(), columns.len(), |r, j| rows[r].0[j]),
            input: rows.iter().map(|row| row.1).collect(),
            e: rows.iter().map(|row| row.2).collect(),
        })
    }

    /// `G_S c` for some of the columns, J, one value a run.
    pub fn identified(&self, columns: &[usize], coefficients: &[f64]) -> Vec<f64> {
        let row = |r: usize| columns.iter().zip(coefficients).map(|(&j, c)| self.g[(r, j)] * c).sum();
        (0..self.e.len()).map(row).collect()
    }
}

/// Displacement of force channel `j` at kept harmonic `k`: sensors at the drive point with their weights, if any.
fn drive_sensors(measured: &Measured, j: usize, k: usize) -> Vec<(usize, f64)> {
    measured.average_at(measured.forces.dofs[j], k)
}

/// Energy put in by all exciters over one period, J.
///
/// # Errors
/// [`BalanceError::DriveUnmeasured`].
pub(crate) fn input_energy(
    structure: &Structure,
    measured: &Measured,
    expanded: &Expanded,
) -> Result<f64, BalanceError> {
    let mut sum = 0.0;
    for j in 0..measured.forces.len() {
        let dof = measured.forces.dofs[j];
        for k in 0..measured.harmonics() {
            let sensors = drive_sensors(measured, j, k);
            let x: c64 = if !sensors.is_empty() {
                sensors.iter().map(|&(s, w)| measured.sensors.values[(s, k)] * w).sum()
            } else if expanded.known[dof] {
                expanded.x[(dof, k)]
            } else {
                let dof = structure.label(dof).to_string();
                return Err(BalanceError::DriveUnmeasured { file: measured.file.clone(), dof });
            };
            sum += action::work([(measured.numbers[k], x, measured.forces.values[(j, k)])]);
        }
    }
    Ok(sum)
}

/// Gradient of the input energy: adds to `by_motion` (n x harmonics, where an expansion gives the drive), `by_sensors`
/// (sensors x harmonics) and `by_forces` (force channels x harmonics); a change `d` of a coefficient changes the energy by
/// `Re(conj(gradient) d)`.
pub(crate) fn add_input_gradient(
    measured: &Measured,
    expanded: &Expanded,
    by_motion: &mut Mat<c64>,
    by_sensors: &mut Mat<c64>,
    by_forces: &mut Mat<c64>,
) {
    let i = c64::new(0.0, 1.0);
    for j in 0..measured.forces.len() {
        for k in 0..measured.harmonics() {
            let scale = PI * measured.numbers[k] as f64;
            let f = measured.forces.values[(j, k)];
            // Im(conj(X) F) = Re(conj(X) (-i F)) = Re(conj(F) (i X)).
            let by_x = -i * f * scale;
            let sensors = drive_sensors(measured, j, k);
            let mut x = c64::new(0.0, 0.0);
            for &(s, w) in &sensors {
                by_sensors[(s, k)] += by_x * w;
                x += measured.sensors.values[(s, k)] * w;
            }
            if sensors.is_empty() {
                by_motion[(measured.forces.dofs[j], k)] += by_x;
                x = expanded.x[(measured.forces.dofs[j], k)];
            }
            by_forces[(j, k)] += i * x * scale;
        }
    }
}

/// Whether the motion at every DOF that a source acts on is known in every run.
pub(crate) fn is_observable(source: &Source, runs: &[(Measured, Expanded)], method: Expansion) -> bool {
    match &source.place {
        Place::Dofs(dofs) => runs.iter().all(|(_, expanded)| dofs.iter().all(|&dof| expanded.known[dof])),
        Place::Whole(_) => method != Expansion::None || runs.iter().all(|(_, e)| e.known.iter().all(|k| *k)),
        Place::Channel(_) => false,
    }
}
