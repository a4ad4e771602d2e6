//! A place seen in few of many runs, a systematic sample over their amplitudes: laws of many parameters are shaped on it, for those
//! runs that differ most in amplitude tell the shape, and every further one costs as much again.

use super::eliminator::Eliminator;
use super::identified_force::{LawFit, PlaceData};

/// Runs on which the parameters of such a law are found where there are many more.
const RUNS: usize = 10;

impl PlaceData {
    /// The same place seen in few of its runs, spread evenly over the amplitudes of its motion; `None` where there are not
    /// many more.
    pub(super) fn subsample(&self) -> Option<Self> {
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
        Some(Self { forces, freedom, ..self.clone() })
    }

    /// A fit with what it leaves of the forces of all runs.
    pub(super) fn on_all_runs(&self, fit: LawFit) -> LawFit {
        let misfit = self.forces_of(&fit.source).map_or(f64::INFINITY, |of_law| self.left_by(&of_law));
        LawFit { misfit, ..fit }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::super::force_matching::tests::place;
    use super::*;

    /// Of 28 runs, each at twice the amplitude of the one before, every third is taken; of 11 runs none is left out.
    #[test]
    fn few_runs_are_taken_evenly_over_the_amplitudes() {
        let mut all = place(28);
        // Runs come in no order of amplitude.
        all.motions.reverse();
        all.motions.swap(0, 14);
        let few = all.subsample().unwrap();
        let amplitudes = all.motions.iter().zip(&few.forces).filter(|(_, forces)| !forces.is_empty());
        let mut taken: Vec<f64> = amplitudes.map(|(motion, _)| (motion.harmonics[0].norm() / 1e-4).log2()).collect();
        taken.sort_by(f64::total_cmp);
        assert!(taken.iter().enumerate().all(|(k, n)| (n - 3.0 * k as f64).abs() < 1e-9), "{taken:?}");
        assert_eq!(taken.len(), RUNS);
        assert!(place(11).subsample().is_none());
    }
}
