//! The runs of a `points` problem with their measured motion, and the energies that sources take out of it.

use super::energies::displacement;
use crate::balance::action::{self, Field};
use crate::diagnosis::residual::data::RunData;
use crate::diagnosis::residual::energy_balance::input;
use crate::effects::{Leg, Motion, Source};
use crate::math::fill::filled_complex;
use crate::structure::Structure;
use faer::{Mat, c64};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// DOFs of a leg and samples a period.
type Key = (usize, Option<usize>, usize);

/// Runs with the displacements of all DOFs, at rest where no sensor is.
pub(super) struct MeasuredRuns<'a> {
    structure: &'a Structure,
    pub list: Vec<RunData>,
    /// Numbers of the harmonics and displacement, n x harmonics, m; one pair a run.
    motion: Vec<(Vec<usize>, Mat<c64>)>,
    /// Sampled motions that were asked for, one list of runs a leg and number of samples: those of the records, whatever law is there.
    sampled: Mutex<BTreeMap<Key, Arc<Vec<Motion>>>>,
}

impl<'a> MeasuredRuns<'a> {
    pub(super) fn new(structure: &'a Structure, list: Vec<RunData>) -> Self {
        let motion_of_run = |run: &RunData| {
            let all: Vec<Vec<c64>> = (0..structure.len()).map(|dof| displacement(run, dof)).collect();
            ((1..=run.harmonics).collect(), filled_complex(all.len(), run.harmonics, |dof, k| all[dof][k]))
        };
        let motion = list.iter().map(motion_of_run).collect();
        Self { structure, list, motion, sampled: Mutex::default() }
    }

    fn field(&self, r: usize) -> Field<'_> {
        let (numbers, x) = &self.motion[r];
        Field { omega: self.list[r].omega, numbers, x }
    }

    /// Energy that is put in in each run, J.
    pub(super) fn input(&self) -> Vec<f64> {
        self.list.iter().map(|run| input(run, &|dof| displacement(run, dof))).collect()
    }

    /// Energy that a source takes out in each run, J; nonlinear laws by so many `samples` a period.
    pub(super) fn energies(&self, source: &Source, samples: usize) -> Vec<f64> {
        let nonlinear = source.effect.law().filter(|law| source.effect.dissipates() && !law.is_linear());
        if let Some(law) = nonlinear {
            let legs: Vec<_> = source.place.legs().into_iter().map(|leg| self.sampled(leg, samples)).collect();
            let energy = |r: usize| legs.iter().map(|motions| law.energy(&source.parameters, &motions[r])).sum();
            return (0..self.list.len()).map(energy).collect();
        }
        (0..self.list.len()).map(|r| action::energy(source, self.structure, self.field(r))).collect()
    }

    /// The relative motion of `leg` in each run, of so many `samples` a period.
    pub(super) fn sampled(&self, leg: Leg, samples: usize) -> Arc<Vec<Motion>> {
        let key = (leg.first, leg.second, samples);
        if let Some(motions) = self.sampled.lock().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return motions.clone();
        }
        let motion = |r: usize| Motion::new(self.list[r].omega, 0.0, &self.field(r).relative(leg), samples);
        let motions = Arc::new((0..self.list.len()).map(motion).collect::<Vec<_>>());
        self.sampled.lock().unwrap_or_else(PoisonError::into_inner).insert(key, motions.clone());
        motions
    }
}
