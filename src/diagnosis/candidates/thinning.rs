//! A place with other forces: of few of many runs, those that differ most in amplitude, which tell the shape of a law of many parameters; of
//! a law, which others are to do as well.

use super::eliminator::Eliminator;
use super::identified_force::{LawFit, PlaceData, history};
use crate::diagnosis::localisation::cell::FreeForce;
use crate::diagnosis::localisation::free_force::ForceFreedom;
use crate::effects::Source;

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
        Some(self.with_forces(forces, self.histories.clone(), freedom))
    }

    /// The same place with the force of a law that acts there in place of the free forces, of the same weights.
    pub(super) fn with_force_of(&self, source: &Source) -> Option<Self> {
        let of_law = self.forces_of(source)?;
        let mut forces = self.forces.clone();
        for (list, values) in forces.iter_mut().zip(of_law) {
            list.iter_mut().zip(values).for_each(|(force, value)| force.value = value);
        }
        let histories = forces.iter().map(|list| history(&self.sampling, list)).collect();
        Some(self.with_forces(forces, histories, None))
    }

    fn with_forces(
        &self,
        forces: Vec<Vec<FreeForce>>,
        histories: Vec<Vec<f64>>,
        freedom: Option<(ForceFreedom, Eliminator)>,
    ) -> Self {
        Self {
            spot: self.spot.clone(),
            forces,
            motions: self.motions.clone(),
            histories,
            impedances: self.impedances.clone(),
            static_compliance: self.static_compliance,
            sampling: self.sampling.clone(),
            freedom,
            range: self.range,
        }
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
    use super::*;
    use crate::diagnosis::localisation::location::Spot;
    use crate::effects::{Effect, Leg, Place, Range, Sampling};
    use faer::c64;

    /// A place that moves at seven amplitudes, with no force yet.
    fn place() -> PlaceData {
        let sampling = Sampling::with_harmonics(128, 3);
        let motion = |k: i32| sampling.motion(60.0, 0.0, &[c64::new(1e-4 * 2.0_f64.powi(k), 0.0)]);
        let motions: Vec<_> = (0..7).map(motion).collect();
        let none = FreeForce { value: c64::new(0.0, 0.0), weight: 1e4 };
        PlaceData {
            spot: Spot::Leg(Leg { first: 0, second: None }),
            forces: vec![vec![none; 3]; 7],
            histories: vec![vec![0.0; 128]; 7],
            impedances: vec![1.0; 7],
            static_compliance: 1e-6,
            range: Range::of(&motions),
            motions,
            sampling,
            freedom: None,
        }
    }

    /// Dahl friction and an Iwan joint do nearly the same force: a fit of the one begins where it does the force of the other.
    #[test]
    fn a_law_is_found_that_does_the_force_of_another() {
        let dahl = Source::known(Effect::Dahl, Place::Dofs(vec![0]), &[800.0, 3.8]);
        let place = place().with_force_of(&dahl).unwrap();
        let size = place.rows(1.0, |_, order| vec![c64::new(0.0, 0.0); order]).iter().map(|x| x * x).sum::<f64>();
        let itself = place.fit_within(Effect::Dahl, f64::INFINITY, &place).unwrap();
        assert!(itself.misfit < 0.02 * size, "{} {size}", itself.misfit);
        let iwan = place.fit_within(Effect::Iwan, f64::INFINITY, &place).unwrap();
        assert!(iwan.misfit < 0.05 * size, "{iwan:?} {size}");
        let spring = place.fit_within(Effect::Stiffness, f64::INFINITY, &place).unwrap();
        assert!(spring.misfit > 0.1 * size, "{spring:?} {size}");
    }
}
