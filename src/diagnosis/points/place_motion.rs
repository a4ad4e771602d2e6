//! The sampled motion at the places of a `points` problem: that of the records, whatever law is there.

use super::energies::displacement;
use crate::diagnosis::residual::data::RunData;
use crate::effects::{Leg, Motion};
use faer::c64;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// DOFs of a leg and samples a period.
type Key = (usize, Option<usize>, usize);

/// Motions that were asked for, one list of runs a leg and number of samples.
#[derive(Default)]
pub(super) struct PlaceMotions {
    known: Mutex<BTreeMap<Key, Arc<Vec<Motion>>>>,
}

impl PlaceMotions {
    /// The relative motion of `leg` in each of `runs`, which are those of one record, of so many `samples` a period.
    pub(super) fn of(&self, leg: Leg, samples: usize, runs: &[RunData]) -> Arc<Vec<Motion>> {
        let key = (leg.first, leg.second, samples);
        let known = |this: &Self| this.known.lock().unwrap_or_else(PoisonError::into_inner).get(&key).cloned();
        if let Some(motions) = known(self) {
            return motions;
        }
        let motion = |run: &RunData| {
            let (first, second) = (displacement(run, leg.first), leg.second.map(|dof| displacement(run, dof)));
            let relative = |h: usize| first[h] - second.as_ref().map_or(c64::new(0.0, 0.0), |second| second[h]);
            Motion::new(run.omega, 0.0, &(0..run.harmonics).map(relative).collect::<Vec<_>>(), samples)
        };
        let motions = Arc::new(runs.iter().map(motion).collect::<Vec<_>>());
        self.known.lock().unwrap_or_else(PoisonError::into_inner).insert(key, motions.clone());
        motions
    }
}
