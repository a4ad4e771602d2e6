//! Frequency responses as measured: on all lines of their files, or a line a run, harmonic 1 of every sensor over the
//! exciter's force.

use super::data::{LoadCase, ReceptanceData};
use crate::math::fill::filled_complex;
use crate::measurement::Run;
use faer::{Mat, c64};

/// Relative difference of frequencies that counts as one line.
pub(super) const SAME_LINE: f64 = 1e-9;

/// Receptances between some drives and some sensors on common lines.
#[derive(Debug, Clone, PartialEq)]
pub struct FrequencyResponses {
    /// Circular frequencies, rad/s, ascending.
    pub omega: Vec<f64>,
    /// DOF row of each sensor, ascending.
    pub sensors: Vec<usize>,
    /// DOF row of each drive, ascending.
    pub drives: Vec<usize>,
    /// Receptance at each line, sensors x drives, m/N.
    pub values: Vec<Mat<c64>>,
    /// Standard deviation of the real part, and of the imaginary part, of every value; empty where it is not known.
    pub deviations: Vec<Mat<f64>>,
}

/// One run that one exciter drove.
struct Line {
    omega: f64,
    drive: usize,
    /// Displacement over force by DOF row.
    motion: Vec<(usize, c64)>,
}

impl FrequencyResponses {
    /// From the enabled runs with one exciter. Sensors are those of every such run; lines those that every drive has; a
    /// drive whose lines are not shared with the one that has most is left out. `None` without a run of that kind.
    pub(super) fn from_steady(runs: &[Run]) -> Option<Self> {
        let lines: Vec<Line> = runs.iter().filter(|run| run.enabled).filter_map(line).collect();
        let first = lines.first()?;
        let everywhere = |dof: &usize| lines.iter().all(|line| line.motion.iter().any(|(d, _)| d == dof));
        let mut sensors: Vec<usize> = first.motion.iter().map(|(dof, _)| *dof).filter(everywhere).collect();
        sensors.sort_unstable();
        let mut drives: Vec<usize> = lines.iter().map(|line| line.drive).collect();
        drives.sort_unstable();
        drives.dedup();
        let lines_of = |drive: usize| lines.iter().filter(move |line| line.drive == drive);
        let main = drives.iter().copied().max_by_key(|&drive| lines_of(drive).count())?;
        let line_at = |drive: usize, omega: f64| lines_of(drive).find(|l| (l.omega - omega).abs() <= SAME_LINE * omega);
        let mut omega: Vec<f64> = lines_of(main).map(|line| line.omega).collect();
        omega.sort_by(f64::total_cmp);
        omega.dedup_by(|a, b| (*a - *b).abs() <= SAME_LINE * *b);
        drives.retain(|&drive| omega.iter().all(|&w| line_at(drive, w).is_some()));
        let value = |w: f64, sensor: usize, drive: usize| {
            line_at(drive, w).and_then(|l| l.motion.iter().find(|(d, _)| *d == sensor)).map_or(0.0.into(), |m| m.1)
        };
        let matrix = |&w: &f64| filled_complex(sensors.len(), drives.len(), |i, j| value(w, sensors[i], drives[j]));
        let values = omega.iter().map(matrix).collect();
        Some(Self { omega, sensors, drives, values, deviations: Vec::new() })
    }

    /// The full receptance matrix, where all `n` DOFs are driven and measured.
    pub fn full(&self, n: usize) -> Option<ReceptanceData> {
        (self.sensors.len() == n && self.drives.len() == n)
            .then(|| ReceptanceData { omega: self.omega.clone(), matrices: self.values.clone() })
    }

    /// Every line and drive as a load case of unit force, where all `n` DOFs are measured.
    pub fn loads(&self, n: usize) -> Option<Vec<LoadCase>> {
        let case = |k: usize, j: usize| LoadCase {
            omega: self.omega[k],
            force: (0..n).map(|i| c64::new(f64::from(u8::from(i == self.drives[j])), 0.0)).collect(),
            displacement: (0..n).map(|i| self.values[k][(i, j)]).collect(),
        };
        let lines = 0..self.omega.len();
        (self.sensors.len() == n)
            .then(|| lines.flat_map(|k| (0..self.drives.len()).map(move |j| (k, j))).map(|(k, j)| case(k, j)).collect())
    }

    /// Sum of squared magnitudes of the mobility at every line: where its peaks are, are modes.
    pub fn power(&self) -> Vec<f64> {
        let total = |(w, h): (&f64, &Mat<c64>)| w * w * h.squared_norm_l2();
        self.omega.iter().zip(&self.values).map(total).collect()
    }

    /// One pair of sensor and drive over all lines.
    pub fn series(&self, sensor: usize, drive: usize) -> Vec<c64> {
        self.values.iter().map(|h| h[(sensor, drive)]).collect()
    }
}

/// The fundamental of a run with exactly one force.
fn line(run: &Run) -> Option<Line> {
    let [force] = run.fit.force_channels()[..] else { return None };
    let drive = run.fit.channels[force].channel.dof;
    let load = *run.fit.force(drive)?.amplitudes.first()?;
    if load.norm() == 0.0 {
        return None;
    }
    let mut dofs: Vec<usize> =
        run.fit.response_channels().iter().map(|&channel| run.fit.channels[channel].channel.dof).collect();
    dofs.sort_unstable();
    dofs.dedup();
    let motion = dofs.into_iter().filter_map(|dof| Some((dof, run.fit.displacement(dof)?.amplitudes[0] / load)));
    Some(Line { omega: run.fit.omega, drive, motion: motion.collect() })
}
