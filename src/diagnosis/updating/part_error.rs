//! Springs and masses that would be added, against those that are there: what a model has too much of, or of which hardly more is
//! wanted than models are wrong by, is a correction and no missing effect.

use crate::effects::{Effect, Place, Source};
use crate::structure::factors::Share;
use crate::structure::{Part, Structure};

/// The part of a structure that an added spring or mass would change; none of other effects.
pub(crate) fn part_of(source: &Source) -> Option<Part> {
    let Place::Dofs(dofs) = &source.place else { return None };
    match (source.effect, dofs.as_slice()) {
        (Effect::Mass, [dof]) => Some(Part::PointMass(*dof)),
        (Effect::Stiffness, [dof]) => Some(Part::GroundSpring(*dof)),
        (Effect::Stiffness, [first, second]) => Some(Part::Coupling([*first, *second])),
        _ => None,
    }
}

/// Whether a spring or mass takes away from the structure.
pub(crate) fn takes_away(source: &Source) -> bool {
    source.effect.is_mass_or_spring() && source.parameters[0] < 0.0
}

/// Whether a spring or mass is less than `share` of `part`, which it would change.
pub(crate) fn is_within_part(structure: &Structure, source: &Source, part: Part, share: f64) -> bool {
    source.parameters[0].abs() < share * size_of(structure, part)
}

/// Spring, N/m, or mass, kg, of a part of a structure; 0 where it has none.
pub(crate) fn size_of(structure: &Structure, part: Part) -> f64 {
    let Some(Share { stiffness, mass }) = structure.share(part) else { return 0.0 };
    stiffness.iter().chain(&mass).next().map_or(0.0, |entry| entry.2.abs())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::structure::chain::ChainParameters;

    #[test]
    fn springs_and_masses_are_judged_by_those_that_are_there() {
        let (masses, ground_stiffness) = (vec![1.0, 2.0], vec![500.0, 0.0]);
        let chain = ChainParameters { masses, ground_stiffness, coupling_stiffness: vec![1000.0] }.build(&[]).unwrap();
        let judged = |effect: Effect, dofs: &[usize], value: f64| {
            let source = Source::known(effect, Place::Dofs(dofs.to_vec()), &[value]);
            (takes_away(&source), is_within_part(&chain, &source, part_of(&source).unwrap(), 0.05))
        };
        assert_eq!(judged(Effect::Stiffness, &[0, 1], 40.0), (false, true));
        assert_eq!(judged(Effect::Stiffness, &[0, 1], 60.0), (false, false));
        assert_eq!(judged(Effect::Stiffness, &[0], -20.0), (true, true));
        assert_eq!(judged(Effect::Mass, &[1], 0.09), (false, true));
        assert_eq!(judged(Effect::Mass, &[1], -0.3), (true, false));
        assert!(part_of(&Source::known(Effect::Viscous, Place::Dofs(vec![0]), &[1.0])).is_none());
    }
}
