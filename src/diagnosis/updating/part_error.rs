//! Springs and masses that would be added, against those that are there: what a model has too much of, or of which hardly more is
//! wanted than models are wrong by, is a correction and no missing effect.

use super::parameters::{Updating, UpdatingParameter};
use crate::effects::{Constant, Place, Source};
use crate::structure::share::{Share, Triplets};
use crate::structure::{Part, Structure};

/// The part of a structure that an added spring or mass would change; none of other effects.
pub(crate) fn part_of(source: &Source) -> Option<Part> {
    let Place::Dofs(dofs) = &source.place else { return None };
    match (source.effect.constant()?, dofs.as_slice()) {
        (Constant::Mass, [dof]) => Some(Part::PointMass(*dof)),
        (Constant::Stiffness, [dof]) => Some(Part::GroundSpring(*dof)),
        (Constant::Stiffness, [first, second]) => Some(Part::Coupling([*first, *second])),
        _ => None,
    }
}

/// Whether a spring or mass takes away from the structure.
pub(crate) fn takes_away(source: &Source) -> bool {
    source.effect.is_mass_or_spring() && source.parameters[0] < 0.0
}

/// Whether a spring or mass, less its deviation, is less than `share` of `part`, which it would change.
pub(crate) fn is_within_part(structure: &Structure, source: &Source, deviation: f64, part: Part, share: f64) -> bool {
    source.parameters[0].abs() - deviation < share * size_of(structure, part)
}

/// Spring, N/m, or mass, kg, of a part of a structure; 0 where it has none.
pub(crate) fn size_of(structure: &Structure, part: Part) -> f64 {
    let Some(Share { stiffness, mass }) = structure.share(part) else { return 0.0 };
    stiffness.iter().chain(&mass).next().map_or(0.0, |entry| entry.2.abs())
}

/// Greatest change of the logarithm of a part that takes over an added spring or mass.
const ABSORBED: f64 = 0.3;

impl Updating {
    /// These parameters with the springs and masses `effects` taken over by the parts of `structure` that act at the same places;
    /// none where another effect is among them, or no part acts there.
    ///
    /// ```text
    /// f_p - 1 = a_p v / sum_q a_q^2,    a_p = e^T S_p e
    /// ```
    ///
    /// is the least change of the parts, of shares `S_p`, with the same stiffness or mass as the added `v` between its DOFs (`e`).
    pub(crate) fn absorbing(&self, structure: &Structure, effects: &[Source]) -> Option<Self> {
        let mut absorbed = self.clone();
        for source in effects {
            let along = self.shares_along(structure, source)?;
            let square: f64 = along.iter().map(|a| a * a).sum();
            if square <= 0.0 {
                return None;
            }
            for (value, a) in absorbed.values.iter_mut().zip(along) {
                let change = (a * source.parameters[0] / square).max(-0.5).ln_1p();
                *value += change.clamp(-ABSORBED, ABSORBED);
            }
        }
        (!effects.is_empty()).then_some(absorbed)
    }

    /// Stiffness or mass of each parameter's part along the place of a spring or mass; none of another effect.
    fn shares_along(&self, structure: &Structure, source: &Source) -> Option<Vec<f64>> {
        part_of(source)?;
        let Place::Dofs(dofs) = &source.place else { return None };
        let weight = |row: usize| match dofs.iter().position(|dof| *dof == row) {
            Some(0) => 1.0,
            Some(_) => -1.0,
            None => 0.0,
        };
        let along = |list: &Triplets| list.iter().map(|(i, j, v)| weight(*i) * weight(*j) * v).sum::<f64>();
        let share_of_parameter = |parameter: &UpdatingParameter| match parameter {
            UpdatingParameter::Structure(part) => structure.share(*part).map_or(0.0, |share| {
                along(if source.effect.adds_to(Constant::Mass) { &share.mass } else { &share.stiffness })
            }),
            _ => 0.0,
        };
        Some(self.parameters.iter().map(share_of_parameter).collect())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::effects::Effect;
    use crate::structure::chain::ChainParameters;

    #[test]
    fn springs_and_masses_are_judged_by_those_that_are_there() {
        let (masses, ground_stiffness) = (vec![1.0, 2.0], vec![500.0, 0.0]);
        let chain = ChainParameters { masses, ground_stiffness, coupling_stiffness: vec![1000.0] }.build(&[]).unwrap();
        let judged_within = |effect: Effect, dofs: &[usize], value: f64, deviation: f64| {
            let source = Source::known(effect, Place::Dofs(dofs.to_vec()), &[value]);
            (takes_away(&source), is_within_part(&chain, &source, deviation, part_of(&source).unwrap(), 0.05))
        };
        let judged = |effect: Effect, dofs: &[usize], value: f64| judged_within(effect, dofs, value, 0.0);
        assert_eq!(judged(Effect::Stiffness, &[0, 1], 40.0), (false, true));
        assert_eq!(judged(Effect::Stiffness, &[0, 1], 60.0), (false, false));
        assert_eq!(judged(Effect::Stiffness, &[0], -20.0), (true, true));
        assert_eq!(judged(Effect::Mass, &[1], 0.09), (false, true));
        // As large, but not known to be.
        assert_eq!(judged_within(Effect::Stiffness, &[0, 1], 60.0, 20.0), (false, true));
        assert_eq!(judged(Effect::Mass, &[1], -0.3), (true, false));
        assert!(part_of(&Source::known(Effect::Viscous, Place::Dofs(vec![0]), &[1.0])).is_none());
    }

    #[test]
    fn parts_take_over_what_is_added_at_their_places() {
        let (masses, ground_stiffness) = (vec![1.0, 2.0], vec![500.0, 0.0]);
        let chain = ChainParameters { masses, ground_stiffness, coupling_stiffness: vec![1000.0] }.build(&[]).unwrap();
        let parts = [Part::PointMass(1), Part::GroundSpring(0), Part::Coupling([0, 1])];
        let parameters = parts.map(UpdatingParameter::Structure).to_vec();
        let updating = Updating { parameters, values: vec![0.01, 0.0, 0.0], ..Updating::default() };
        let added = |effect: Effect, dofs: &[usize], value: f64| {
            updating.absorbing(&chain, &[Source::known(effect, Place::Dofs(dofs.to_vec()), &[value])])
        };
        let mass = added(Effect::Mass, &[1], 0.2).unwrap();
        assert!((mass.values[0] - 0.01 - 1.1_f64.ln()).abs() < 1e-12 && mass.values[1..] == [0.0, 0.0]);
        // What is added is there in the structure with the factors, where the parts act at that place alone.
        let spring = added(Effect::Stiffness, &[0], 30.0).unwrap().structure(&chain);
        let stiffness = &spring.matrices().unwrap().stiffness;
        assert!((stiffness[(0, 0)] - 1530.0).abs() < 1.0, "{}", stiffness[(0, 0)]);
        assert!(added(Effect::Viscous, &[0], 1.0).is_none() && added(Effect::Mass, &[0], 0.1).is_none());
    }
}
