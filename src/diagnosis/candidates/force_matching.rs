//! A law in place of the free force of a place, so that other laws are sized to do the same force: a fit of an Iwan joint that begins
//! where it does what Dahl friction does there begins nearer than one that is sized to a free force beside a model that is off.

use super::identified_force::{PlaceData, history};
use crate::effects::Source;

impl PlaceData {
    /// The same place with the force of a law that acts there in place of the free forces, of the same weights.
    pub(super) fn with_force_of(&self, source: &Source) -> Option<Self> {
        let of_law = self.forces_of(source)?;
        let mut forces = self.forces.clone();
        for (list, values) in forces.iter_mut().zip(of_law) {
            list.iter_mut().zip(values).for_each(|(force, value)| force.value = value);
        }
        let histories = forces.iter().map(|list| history(&self.sampling, list)).collect();
        Some(Self { forces, histories, freedom: None, ..self.clone() })
    }
}

#[cfg(test)]
pub(super) mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::diagnosis::localisation::cell::FreeForce;
    use crate::diagnosis::localisation::location::Spot;
    use crate::effects::{Effect, Leg, Place, Range, Sampling};
    use faer::c64;

    /// A place that moves in so many runs, in each at twice the amplitude of the one before, with no force yet.
    pub(in crate::diagnosis::candidates) fn place(runs: usize) -> PlaceData {
        let sampling = Sampling::with_harmonics(128, 3);
        let motion = |k: i32| sampling.motion(60.0, 0.0, &[c64::new(1e-4 * 2.0_f64.powi(k), 0.0)]);
        let motions: Vec<_> = (0..runs as i32).map(motion).collect();
        let none = FreeForce { value: c64::new(0.0, 0.0), weight: 1e4 };
        PlaceData {
            spot: Spot::Leg(Leg { first: 0, second: None }),
            forces: vec![vec![none; 3]; runs],
            histories: vec![vec![0.0; 128]; runs],
            impedances: vec![1.0; runs],
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
        let place = place(7).with_force_of(&dahl).unwrap();
        let size = place.rows(1.0, |_, order| vec![c64::new(0.0, 0.0); order]).iter().map(|x| x * x).sum::<f64>();
        let itself = place.fit_within(Effect::Dahl, f64::INFINITY, &place).unwrap();
        assert!(itself.misfit < 0.02 * size, "{} {size}", itself.misfit);
        let iwan = place.fit_within(Effect::Iwan, f64::INFINITY, &place).unwrap();
        assert!(iwan.misfit < 0.05 * size, "{iwan:?} {size}");
        let spring = place.fit_within(Effect::Stiffness, f64::INFINITY, &place).unwrap();
        assert!(spring.misfit > 0.1 * size, "{spring:?} {size}");
    }
}
