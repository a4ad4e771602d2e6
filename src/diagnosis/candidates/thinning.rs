//! Regression of laws of many parameters on few of many runs: those that differ most in amplitude tell their shape.

use super::eliminator::Eliminator;
use super::identified_force::{LawFit, PlaceData};

/// Runs on which the parameters of such a law are found where there are many more.
const RUNS: usize = 10;

impl PlaceData {
    /// The same place seen in few of its runs, spread evenly over the amplitudes of its motion; `None` where there are not
    /// many more.
    pub(super) fn thinned(&self) -> Option<Self> {
        let mut seen: Vec<usize> = (0..self.forces.len()).filter(|&r| !self.forces[r].is_empty()).collect();
        if seen.len() < RUNS + RUNS / 4 {
            return None;
        }
        let amplitude = |r: usize| self.motions[r].harmonics.first().map_or(0.0, |d| d.norm());
        seen.sort_by(|&a, &b| amplitude(a).total_cmp(&amplitude(b)));
        let mut forces = vec![Vec::new(); self.forces.len()];
        for k in 0..RUNS {
            let r = seen[k * (seen.len() - 1) / (RUNS - 1)];
            forces[r].clone_from(&self.forces[r]);
        }
        let freedom = self.freedom.as_ref().map(|(freedom, _)| (freedom.clone(), Eliminator::new(&forces, freedom)));
        Some(Self {
            spot: self.spot.clone(),
            forces,
            motions: self.motions.clone(),
            histories: self.histories.clone(),
            impedances: self.impedances.clone(),
            static_compliance: self.static_compliance,
            sampling: self.sampling.clone(),
            freedom,
            range: self.range,
        })
    }

    /// A fit with what it leaves of the forces of all runs.
    pub(super) fn on_all_runs(&self, fit: LawFit) -> LawFit {
        let misfit = self.forces_of(&fit.source).map_or(f64::INFINITY, |of_law| self.left_by(&of_law));
        LawFit { misfit, ..fit }
    }
}
