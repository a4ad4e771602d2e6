//! Sets of laws of which one contains the other as a limit of its parameters, and what may not come back by another name.

use crate::effects::{Effect, Source};

/// Whether an effect with these standard deviations of its parameters may be suggested where those of `excluded` may not: it
/// is none of them, nor a law that has one of them as a limit and a parameter that the data do not determine, which may be
/// the same by another name.
pub(crate) fn is_allowed(excluded: &[Source], source: &Source, deviations: &[f64]) -> bool {
    let out = |law: Effect| excluded.iter().any(|other| other.effect == law && other.place.is_same(&source.place));
    let disguise = is_undetermined(source, deviations) && source.effect.limits().any(out);
    !(disguise || out(source.effect))
}

/// Whether an effect has a parameter whose deviation is as large as itself.
pub(crate) fn is_undetermined(source: &Source, deviations: &[f64]) -> bool {
    source.parameters.iter().zip(deviations).any(|(p, d)| d.is_nan() || *d >= p.abs())
}

/// Whether the set `simple` differs from `set` in no more than laws that are limits of those in `set`, at the same places.
pub(crate) fn is_limit(simple: &[Source], set: &[Source]) -> bool {
    let stands =
        |a: &Source, b: &Source| a.place.is_same(&b.place) && (a.effect == b.effect || b.effect.contains(a.effect));
    simple.len() == set.len() && simple.iter().zip(set).all(|(a, b)| stands(a, b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::Place;

    #[test]
    fn what_is_excluded_does_not_come_back_by_another_name() {
        let known_source = |dof, effect, parameters: &[f64]| Source::known(effect, Place::Dofs(vec![dof]), parameters);
        let excluded = [known_source(6, Effect::Coulomb, &[1.0])];
        let falls = [0.2, 0.3, 0.05];
        assert!(!is_allowed(&excluded, &known_source(6, Effect::Coulomb, &[0.2]), &[0.01]));
        assert!(!is_allowed(&excluded, &known_source(6, Effect::Stribeck, &falls), &[0.01, 0.4, 0.01]));
        assert!(is_allowed(&excluded, &known_source(6, Effect::Stribeck, &falls), &[0.01, 0.02, 0.01]));
        assert!(is_allowed(&excluded, &known_source(4, Effect::Stribeck, &falls), &[0.01, 0.4, 0.01]));
        assert!(is_allowed(&excluded, &known_source(6, Effect::Viscous, &[0.2]), &[0.3]));
    }
}
